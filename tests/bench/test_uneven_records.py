"""Records of a serial log, whose samples come about when a loop gets round to them."""

import numpy as np
import pytest
from tests.bench.drawn_lags import LAG_TOML

from shaftprint.bench import equipped, read_records
from shaftprint.drive import load_drive
from shaftprint.errors import RecordingError


@pytest.fixture
def read(tmp_path):
    (tmp_path / "drive.toml").write_text(LAG_TOML)

    def records(time, u, y):
        rows = np.column_stack([time, u, y])
        np.savetxt(
            tmp_path / "log.csv", rows, fmt="%.6f", delimiter=",", header="time [s],u [V],y [rad/s]", comments=""
        )
        return read_records([tmp_path / "log.csv"], equipped(load_drive(tmp_path / "drive.toml")))[0]

    return records


def uneven(rng):
    """Fifty samples a second that tremble by a tenth of a period, one in two hundred lost."""
    time = 0.02 * np.arange(1500) + 0.002 * rng.uniform(-1.0, 1.0, 1500) + 0.01
    return time[rng.random(1500) > 0.005]


def test_waves_are_splined_and_steps_go_straight(read):
    time = uneven(np.random.default_rng(3))
    steps = np.where(np.floor(time) % 2 == 0.0, 1.0, -0.5)
    record = read(time, steps, np.sin(2.0 * np.pi * 1.7 * time))
    grid = record.time_s
    assert record.rate_hz == pytest.approx(50.0, rel=5e-3)
    # through 29 values a period a spline is right to 1e-4
    used = record.used
    assert record.outputs["y"][used] == pytest.approx(np.sin(2.0 * np.pi * 1.7 * grid[used]), abs=3e-3)
    # nothing beyond what was put out, and where it stands still that
    assert (record.inputs["u"].min(), record.inputs["u"].max()) == pytest.approx((-0.5, 1.0))
    assert any("u have times of their own" in one and "u by straight lines" in one for one in record.remarks)


def test_a_pause_of_an_input_is_told(read):
    time = uneven(np.random.default_rng(4))
    time = time[(time < 12.0) | (time > 12.06)]
    with pytest.raises(RecordingError, match=r"expected numbers of an input throughout, found none at (11\.9|12\.0)"):
        read(time, np.cos(time), np.sin(time))
