"""Levels counted while something else reads the channels."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.recording import Channel, Recording
from shaftprint.recording._level_watch import watch_levels


@pytest.fixture(autouse=True)
def _blocks_of_two(monkeypatch):
    monkeypatch.setattr("shaftprint.recording._levels.BLOCK_SAMPLES", 2)


def recording_of(scale=2.0, offset=1.0):
    counts = {"read": np.array([3, -2, 7, 7, 0], dtype=np.int16), "left": np.array([4, 4, 1], dtype=np.int16)}
    channels = {
        name: Channel(
            name=name,
            unit="V",
            rate_hz=10.0,
            start_s=0.0,
            count=held.size,
            source=lambda start, stop, held=held: held[start:stop],
            scale=scale,
            offset=offset,
        )
        for name, held in counts.items()
    }
    return Recording(path="x.nc", sha256="", format="", channels=channels)


@pytest.mark.parametrize("scale", [2.0, -2.0])
def test_levels_are_of_what_was_read_and_of_the_rest(scale):
    watch = watch_levels(recording_of(scale))
    channel = watch.recording.channel("read")
    # a look at a few samples, the same block twice, and one out of order count once
    for start, stop in ((0, 1), (0, 2), (0, 2), (3, 4), (2, 4)):
        channel.read(start, stop)
    levels = watch.levels()
    values = scale * np.array([3, -2, 7, 7, 0]) + 1.0
    assert (levels["read"].lowest, levels["read"].highest) == (values.min(), values.max())
    assert levels["read"].mean == pytest.approx(values.mean())
    assert levels["read"].at_highest == pytest.approx(np.mean(values == values.max()))
    assert levels["read"].at_lowest == pytest.approx(np.mean(values == values.min()))
    assert levels["left"].mean == pytest.approx(scale * 3.0 + 1.0)


def test_nothing_is_read_twice():
    raw = recording_of()
    spans = []

    def source(start, stop):
        spans.append((start, stop))
        return raw.channel("read").source(start, stop)

    watch = watch_levels(replace(raw, channels={"read": replace(raw.channel("read"), source=source)}))
    watch.recording.channel("read").read(0, 2)
    watch.levels()
    watch.levels()
    assert spans == [(0, 2), (2, 4), (4, 5)]
