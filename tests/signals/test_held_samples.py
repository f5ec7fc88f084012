"""Channels that keep their last value are told from those whose steps and noise make equal neighbours."""

import numpy as np
import pytest

from shaftprint.signals._held_samples import HeldSamples, held_samples
from shaftprint.signals.conditioning._runs import RunTally

RATE_HZ, SECONDS = 2000.0, 100.0
COUNT = int(RATE_HZ * SECONDS)
TIME_S = np.arange(COUNT) / RATE_HZ


@pytest.fixture
def rng():
    return np.random.default_rng(5)


def torque(rng, noise=100.0):
    """Counts of a gauge: a slow sine, an order of the shaft, and noise."""
    slow = 2000.0 * np.sin(2.0 * np.pi * 0.3 * TIME_S) + 500.0 * np.sin(2.0 * np.pi * 17.0 * TIME_S)
    return np.rint(slow + noise * rng.standard_normal(COUNT)).astype(np.int16)


def in_bursts(values, share, burst_s, rng):
    """Keep the last value in bursts at times of chance."""
    held, length = values.copy(), round(burst_s * RATE_HZ)
    k = 1
    while k + length < values.size:
        held[k : k + length] = held[k - 1]
        k += length + 1 + int(rng.exponential(length * (1.0 - share) / share))
    return held


def looked_at(values, make_channel, *, stated_s=0.0, cut=COUNT, rate_hz=RATE_HZ):
    tally = RunTally(make_channel(values, name="M_s", unit="V", rate_hz=rate_hz))
    for first in range(0, values.size, cut):
        tally.watched.read(first, min(first + cut, values.size))
    return held_samples(tally.runs(), stated_s=stated_s)


@pytest.mark.parametrize(("share", "burst_s"), [(0.3, 0.1), (0.5, 0.05), (0.1, 0.05)])
def test_bursts_are_told_with_share_length_and_lateness(share, burst_s, make_channel, rng):
    found = looked_at(in_bursts(torque(rng), share, burst_s, rng), make_channel)
    assert isinstance(found, HeldSamples)
    assert not found.is_steady
    assert found.share == pytest.approx(share, rel=0.1)
    assert found.hold_s == pytest.approx(burst_s, rel=0.02)
    # each of so many samples repeats the one before: late by half a burst on average
    assert found.late_s == pytest.approx(0.5 * share * burst_s, rel=0.12)
    assert "stands still for" in found.sentence


@pytest.mark.parametrize("hold_hz", [3.0, 10.0, 25.0, 100.0, 250.0])
def test_a_steady_hold_is_named_with_its_length(hold_hz, make_channel, rng):
    first = np.floor(np.floor(TIME_S * hold_hz + 1e-9) / hold_hz * RATE_HZ + 0.5).astype(int)
    found = looked_at(torque(rng)[first], make_channel)
    assert found.is_steady
    assert found.samples == pytest.approx(RATE_HZ / hold_hz, abs=1.0)
    assert found.late_s == pytest.approx(0.5 * (1.0 / hold_hz - 1.0 / RATE_HZ), rel=0.02)
    assert "holds each value" in found.sentence


def test_a_hold_that_the_vessel_file_states_is_none(make_channel, rng):
    held = np.repeat(torque(rng)[:: int(0.02 * RATE_HZ)], int(0.02 * RATE_HZ))
    assert looked_at(held, make_channel, stated_s=0.02) is None
    assert looked_at(held, make_channel).is_steady


def healthy(name, rng):
    noise = rng.standard_normal(COUNT)
    slow = np.sin(2.0 * np.pi * 0.3 * TIME_S)
    steps = np.where(TIME_S < 50.0, np.floor(TIME_S / 2.5), 0.0)
    return {
        "16 bits": torque(rng),
        "steps half as wide as the noise": np.rint(torque(rng) / 200.0) * 200.0,
        "8 bits": np.rint(torque(rng) / 64.0) * 64.0,
        "5 bits": np.rint(torque(rng) / 512.0) * 512.0,
        "a slow instrument, quiet": np.rint(30.0 * slow + 0.1 * noise),
        "a slow instrument, noise as wide as a step": np.rint(30.0 * slow + noise),
        "a slow instrument that smooths": np.rint(30.0 * slow + np.convolve(3.0 * noise, np.ones(40) / 40.0, "same")),
        "rpm to a tenth": np.rint(10.0 * (1200.0 + 30.0 * slow + 0.05 * noise)) / 10.0,
        "a staircase": np.rint(1000.0 * steps),
        "a staircase with noise": np.rint(1000.0 * steps + 2.5 * noise),
        "crests cut off": np.clip(torque(rng), -2100, 2100),
        "nothing": np.zeros(COUNT),
        "no steps at all": 1e-3 * noise,
    }[name]


@pytest.mark.parametrize("name", [
    "16 bits", "steps half as wide as the noise", "8 bits", "5 bits", "a slow instrument, quiet",
    "a slow instrument, noise as wide as a step", "a slow instrument that smooths", "rpm to a tenth", "a staircase",
    "a staircase with noise", "crests cut off", "nothing", "no steps at all",
])  # fmt: skip
def test_equal_neighbours_of_steps_noise_and_levels_are_no_hold(name, make_channel, rng):
    assert looked_at(healthy(name, rng), make_channel) is None


def test_a_few_dropouts_are_no_reason(make_channel, rng):
    values = torque(rng)
    for first in range(20_000, 180_000, 20_000):
        values[first : first + 100] = values[first]
    assert looked_at(values, make_channel) is None


def test_the_cut_into_blocks_does_not_matter(make_channel, rng):
    values = in_bursts(torque(rng), 0.2, 0.03, rng)
    found = [looked_at(values, make_channel, cut=cut) for cut in (COUNT, 7_777, 64)]
    assert len({(one.runs, one.share, one.late_s, one.hold_s) for one in found}) == 1


def test_a_glance_at_the_middle_counts_nothing_twice(make_channel, rng):
    values = in_bursts(torque(rng), 0.2, 0.03, rng)
    channel = make_channel(values, name="M_s", unit="V", rate_hz=RATE_HZ)
    tally = RunTally(channel)
    for first, stop in ((0, 500), (100_000, 100_500), (0, COUNT), (0, COUNT)):
        tally.watched.read(first, stop)
    runs = tally.runs()
    assert runs.samples == COUNT
    # every change of the channel ends a run
    assert runs.count == np.count_nonzero(np.diff(values))
