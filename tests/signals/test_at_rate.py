"""All channels of a recording on one clock."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from shaftprint.errors import SignalError
from shaftprint.recording import Recording
from shaftprint.signals._at_rate import at_rate


def wave(time_s):
    return 3.0 + np.sin(2.0 * np.pi * 1.5 * time_s + 0.3)


@pytest.fixture
def opened(make_channel):
    """A fast channel, a slow one and messages, which start at other times; all show one wave."""
    rng = np.random.default_rng(4)
    time = np.arange(0.5, 40.0, 0.05) + 0.02 * rng.random(790)
    time = time[(time < 20.0) | (time > 20.6)]
    sent = make_channel(wave(time), name="sent", unit="rpm", rate_hz=20.0, start_s=float(time[0]))
    sent = replace(sent, stamps=lambda first, stop: time[first:stop], is_uneven=True)
    fast = make_channel(wave(np.arange(80_000) / 2000.0) + 2.0, name="fast", scale=2.0, offset=-4.0)
    slow = make_channel(wave(0.25 + np.arange(800) / 20.0), name="slow", rate_hz=20.0, start_s=0.25)
    channels = {one.name: one for one in (fast, slow, sent)}
    return Recording(path=Path("x.nc"), sha256="0" * 64, format="memory", channels=channels)


def test_all_show_the_same_at_one_rate(opened):
    moved = at_rate(opened, 50.0)
    clocks = {(one.rate_hz, one.start_s, one.count, one.is_uneven) for one in moved.channels.values()}
    assert len(clocks) == 1
    one = moved.channel("fast")
    time = one.time_s(0, one.count)
    assert (one.rate_hz, one.start_s) == (50.0, opened.channel("sent").start_s)
    inside = (time > 1.0) & (time < 38.0) & ((time < 19.0) | (time > 21.5))
    for name, scale in (("fast", 2.0), ("slow", 1.0), ("sent", 1.0)):
        values = moved.channel(name).values(0, one.count)
        # a spline through 13 values a period is right to 1e-3 of a wave, the filter to 1e-4
        assert values[inside] == pytest.approx(scale * wave(time[inside]), abs=2e-3 * scale)
    holes = np.isnan(moved.channel("sent").values(0, one.count))
    # nothing is known between the messages beside the hole
    assert time[holes].min() == pytest.approx(20.0, abs=0.07)
    assert time[holes].max() == pytest.approx(20.6, abs=0.07)
    assert np.isfinite(moved.channel("slow").values(0, one.count)).all()


@pytest.mark.parametrize("rate_hz", [0.0, -1.0, float("nan"), float("inf")])
def test_a_rate_is_a_positive_number(opened, rate_hz):
    with pytest.raises(SignalError, match="expected a positive rate in Hz"):
        at_rate(opened, rate_hz)
