"""Levels and clocks of raw channels, of signals written down by hand."""

import numpy as np
import pytest

from shaftprint.recording import Channel, Recording
from shaftprint.tables._recording import clock_table, level_table


def channel(name, values, rate_hz=10.0, start_s=0.0):
    held = np.asarray(values, dtype=np.float64)
    return Channel(
        name=name, unit="V", rate_hz=rate_hz, start_s=start_s, count=held.size, source=lambda a, b: held[a:b]
    )


@pytest.mark.parametrize("chunk", [1, 3, 1 << 20])
def test_levels_do_not_hang_on_the_pieces(monkeypatch, chunk):
    monkeypatch.setattr("shaftprint.recording._levels.BLOCK_SAMPLES", chunk)
    values = [1.0, 5.0, np.nan, 5.0, -1.0, 5.0, 0.0]
    found = Recording(path="x.nc", sha256="", format="", channels={"a": channel("a", values)}).levels()["a"]
    assert (found.lowest, found.highest, found.missing) == (-1.0, 5.0, 1)
    assert found.mean == pytest.approx(15.0 / 6.0)
    assert (found.at_highest, found.at_lowest) == (pytest.approx(3.0 / 6.0), pytest.approx(1.0 / 6.0))


def test_what_a_reader_must_know_is_said():
    rng = np.random.default_rng(2)
    noise = rng.standard_normal(1000)
    channels = {
        "good": noise,
        "dead": np.full(1000, 2.5),
        "cut": np.minimum(noise, 0.5),
        "pulses": (noise > 0.0) * 5.0,
        "none": np.full(1000, np.nan),
    }
    recording = Recording(
        path="x.nc", sha256="ab" * 32, format="native", channels={n: channel(n, v) for n, v in channels.items()}
    )
    remarks = {row[0]: row[-1] for row in level_table(recording, recording.levels()).rows}
    assert remarks["good"] == ""
    assert remarks["dead"].startswith("never changes")
    assert remarks["cut"] == "stays at its highest value: cut off?"
    assert remarks["pulses"] == "pulses"
    assert remarks["none"] == "some samples are no number"


def test_channels_of_one_clock_share_a_row():
    channels = (channel("a", np.zeros(20)), channel("b", np.zeros(20)), channel("c", np.zeros(50), 25.0, 0.5))
    recording = Recording(path="x.nc", sha256="ab" * 32, format="native", channels={c.name: c for c in channels})
    rows = clock_table(recording).rows
    assert [row[0] for row in rows] == ["a, b", "c"]
    assert rows[0][1:4] == ("10.00000", "0.000", "2.000")
    assert rows[1][1:4] == ("25.00000", "0.500", "2.500")
