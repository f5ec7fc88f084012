"""Several recordings as one."""

from pathlib import Path

import numpy as np
import pytest

from shaftprint.clocks import Alignment, ClockMap, joined, merged
from shaftprint.errors import ClockError
from shaftprint.recording import Channel, Recording, read_recording, write_recording


def part(name, values, *, start_s=0.0, rate_hz=100.0, unit="V", channel="x", scale=0.5):
    counts = np.asarray(values, dtype=np.int16)
    one = Channel(
        name=channel,
        unit=unit,
        rate_hz=rate_hz,
        start_s=start_s,
        count=counts.size,
        source=lambda a, b: counts[a:b],
        scale=scale,
    )
    return Recording(path=Path(name), sha256=name, format="test", channels={channel: one})


def test_parts_follow_one_another(tmp_path):
    parts = [part("a", range(100)), part("b", range(100, 150), start_s=1.0), part("c", range(150, 155), start_s=1.5)]
    whole = joined(parts)
    channel = whole.channel("x")
    assert channel.count == 155
    np.testing.assert_array_equal(channel.read(0, 155), np.arange(155))
    np.testing.assert_array_equal(channel.read(98, 152), np.arange(98, 152))
    assert channel.read(100, 100).size == 0
    write_recording(tmp_path / "whole.nc", whole.channels.values())
    with read_recording(tmp_path / "whole.nc") as back:
        np.testing.assert_array_equal(back.channel("x").values(0, 155), 0.5 * np.arange(155))


def test_a_gap_is_refused_unless_said_to_follow_on():
    parts = [part("a", range(100)), part("b", range(100), start_s=2.5)]
    with pytest.raises(ClockError, match=r"b, channel x: expected it to begin at 1.0000 s.*found 2.5000 s"):
        joined(parts)
    assert joined(parts, follow_on=True).channel("x").count == 200


@pytest.mark.parametrize(
    ("other", "words"),
    [
        (part("b", [1], start_s=1.0, channel="y"), "difference in x, y"),
        (part("b", [1], start_s=1.0, rate_hz=50.0), "found 50 Hz"),
        (part("b", [1], start_s=1.0, unit="A"), "not logged alike"),
        (part("b", [1], start_s=1.0, scale=1.0), "not logged alike"),
    ],
)
def test_parts_that_were_logged_otherwise_are_refused(other, words):
    with pytest.raises(ClockError, match=words):
        joined([part("a", range(100)), other])


def test_two_loggers_share_one_clock():
    line = ClockMap(offset_s=0.25, drift=1e-4, middle_s=0.0, covariance=np.zeros((2, 2)))
    clock = Alignment(map=line, span_s=(0.0, 0.5))
    both = merged(part("main.nc", range(100)), [(part("engine.nc", range(50)), clock)])
    assert list(both.channels) == ["x", "x (engine)"]
    moved = both.channel("x (engine)")
    assert moved.start_s == pytest.approx(0.25)
    # a hundred samples of its own clock take 1.0001 s of the reference
    assert moved.rate_hz == pytest.approx(100.0 / 1.0001)
    with pytest.raises(ClockError, match=r'"x \(engine\)" taken'):
        merged(part("main.nc", range(9)), [(part("engine.nc", range(9)), clock), (part("engine.csv", range(9)), clock)])


def test_closing_closes_all():
    closed = []
    parts = [
        Recording(
            path=Path(n), sha256=n, format="t", channels=part(n, [1]).channels, release=lambda n=n: closed.append(n)
        )
        for n in "ab"
    ]
    with joined(parts, follow_on=True):
        assert closed == []
    assert closed == ["a", "b"]
