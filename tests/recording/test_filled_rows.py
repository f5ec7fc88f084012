"""Columns of text with a value in some of the rows only: each has the clock of its own rows."""

import numpy as np
import pytest

from shaftprint.errors import RecordingError
from shaftprint.recording import read_recording

COUNT = 1000


def _written(path, rows, *, titles=("n [rpm]", "M [Nm]", "T [°C]")):
    lines = [f"{time:.5f}," + ",".join("" if one is None else repr(one) for one in values) for time, values in rows]
    path.write_text("\n".join([",".join(["time [s]", *titles]), *lines, ""]), encoding="utf-8")
    return path


def _merged(senders, seed=None):
    """Return rows of several senders in order of time: period, delay and values of each."""
    rng = np.random.default_rng(seed)
    rows = []
    for place, (period_s, delay_s, values) in enumerate(senders):
        late_s = np.zeros(len(values)) if seed is None else rng.uniform(0.0, 0.1 * period_s, len(values))
        for k, value in enumerate(values):
            fields = [None] * len(senders)
            fields[place] = value
            rows.append((period_s * k + delay_s + late_s[k], fields))
    return sorted(rows, key=lambda row: row[0])


def test_slow_columns_of_a_table_have_their_own_rate(tmp_path):
    rows = [(0.01 * k, (k + 0.5, 2.0 * k if k % 10 == 0 else None, k if k % 50 == 3 else None)) for k in range(COUNT)]
    with read_recording(_written(tmp_path / "log.csv", rows)) as recording:
        found = {name: (one.rate_hz, one.start_s, one.count) for name, one in recording.channels.items()}
        assert found == {"n": (100.0, 0.0, COUNT), "M": (10.0, 0.0, COUNT // 10), "T": (2.0, 0.03, COUNT // 50)}
        assert np.array_equal(recording.channel("M").values(3, 7), 20.0 * np.arange(3, 7))
        assert recording.remarks == ("M, T: values in some of the rows only, whose times are theirs.",)


@pytest.mark.parametrize("seed", [None, 3])
def test_messages_of_several_senders_in_turn_are_told_apart(tmp_path, seed):
    """As an outer join writes them: the rows together lie on no clock, those of each sender do."""
    senders = [
        (0.01, 0.0, [k + 0.5 for k in range(COUNT)]),
        (0.02, 0.003, [2.0 * k for k in range(COUNT // 2)]),
        (0.05, 0.007, [float(k % 7) for k in range(COUNT // 5)]),
    ]
    with read_recording(_written(tmp_path / "log.csv", _merged(senders, seed))) as recording:
        for (period_s, _, values), channel in zip(senders, recording.channels.values(), strict=True):
            assert channel.rate_hz == pytest.approx(1.0 / period_s, rel=2e-3)
            assert np.array_equal(channel.values(0, channel.count), values)
            assert (channel.stamps is None) == (seed is None)


def test_values_that_are_lost_here_and_there_stay_places_without_one(tmp_path):
    kept = np.random.default_rng(1).random(COUNT) < 0.4
    rows = [(0.01 * k, (k + 0.5, float(k) if kept[k] else None, 1.0)) for k in range(COUNT)]
    with read_recording(_written(tmp_path / "log.csv", rows)) as recording:
        torque = recording.channel("M")
        assert (torque.rate_hz, torque.count) == (100.0, COUNT)
        assert np.array_equal(np.isfinite(torque.values(0, COUNT)), kept)


def test_rows_without_a_clock_that_are_those_of_nobody_are_refused(tmp_path):
    rng = np.random.default_rng(2)
    rows = [(time, (1.0, 2.0, None if k % 20 else 3.0)) for k, time in enumerate(np.cumsum(rng.exponential(0.01, 400)))]
    with pytest.raises(RecordingError, match="column time: expected"):
        read_recording(_written(tmp_path / "log.csv", rows))
