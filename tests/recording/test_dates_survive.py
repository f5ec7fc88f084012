"""The date of second 0 and the jumps of a clock go with a recording from file to file."""

from datetime import UTC, datetime, timedelta, timezone

import numpy as np
import pytest

from shaftprint.errors import RecordingError
from shaftprint.recording import (
    RecordingWriter,
    Samples,
    cut,
    read_recording,
    recording_from_arrays,
    write_by_ending,
    write_recording,
)
from shaftprint.recording.writers._by_ending import held_date

SUMMER = datetime(2026, 7, 5, 9, 0, 0, 250_000, tzinfo=timezone(timedelta(hours=2)))
BARE = SUMMER.replace(tzinfo=None)


@pytest.mark.parametrize(
    ("ending", "began"), [(".nc", SUMMER), (".nc", BARE), (".mf4", SUMMER), (".mf4", BARE), (".tdms", SUMMER)]
)
def test_the_date_survives(tmp_path, ending, began):
    path = tmp_path / "log.dat"
    path.write_bytes(b"x")
    torque = Samples(name="M_s", values=np.sin(np.arange(200.0)), unit="V", rate_hz=100.0, start_s=3.0)
    with recording_from_arrays(path, [torque], format="test", began=began) as recording:
        write_by_ending(tmp_path / f"out{ending}", recording.channels.values(), began=recording.began)
    with read_recording(tmp_path / f"out{ending}") as recording:
        assert recording.began == began
        assert recording.began.tzinfo is None if began.tzinfo is None else recording.began.tzinfo is not None
        assert recording.channel("M_s").start_s == pytest.approx(3.0)
        assert recording.attributes == {}


def test_what_is_held_of_a_date(tmp_path):
    dated = [held_date(tmp_path / f"x{end}", BARE) for end in (".nc", ".mf4", ".blf", ".tdms", ".csv", ".mat")]
    assert dated == [BARE, BARE, BARE, None, None, None]
    assert held_date(tmp_path / "x.tdms", SUMMER) == datetime(2026, 7, 5, 7, 0, 0, 250_000, tzinfo=UTC)
    # logs of a bus, LabVIEW's text and universal files know the clock of the place alone
    assert {held_date(tmp_path / f"x{end}", SUMMER) for end in (".asc", ".lvm", ".uff")} == {BARE}


def test_a_date_that_is_none_is_refused(tmp_path):
    with RecordingWriter(tmp_path / "log.nc", attributes={"began": "yesterday"}) as writer:
        writer.declare("M_s", unit="V", rate_hz=100.0)
        writer.append("M_s", np.zeros(10, dtype=np.int16))
    with pytest.raises(RecordingError, match="expected a date in the attribute began, found 'yesterday'"):
        read_recording(tmp_path / "log.nc")


def test_the_jumps_of_a_clock_survive_and_move_with_a_cut(tmp_path):
    path = tmp_path / "log.csv"
    # 100 rows of 10 ms, then set back by half a second
    times = [0.01 * row - (0.5 if row >= 100 else 0.0) for row in range(200)]
    path.write_text("time [s],M_s [V]\n" + "".join(f"{time:.2f},1\n" for time in times))
    with read_recording(path) as recording:
        (jump,) = recording.channel("M_s").clock_jumps
        assert (jump.sample, jump.jump_s) == (100, pytest.approx(-0.5))
        write_recording(tmp_path / "log.nc", recording.channels.values())
    with read_recording(tmp_path / "log.nc") as recording:
        assert recording.channel("M_s").clock_jumps == (jump,)
        (moved,) = cut(recording, from_s=0.4).channel("M_s").clock_jumps
        assert (moved.sample, moved.jump_s) == (60, jump.jump_s)
        assert cut(recording, to_s=0.9).channel("M_s").clock_jumps == ()
