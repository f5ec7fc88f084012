"""Crests that are cut off below the full scale that is stated, told from noise, holds and slow quantised swings."""

import numpy as np
import pytest

from shaftprint.recording import Channel
from shaftprint.signals.conditioning._cut_off import CutOff
from shaftprint.signals.conditioning._outliers import FaultLimits, flagged
from shaftprint.signals.pulses._flat_top import expect_whole_crests

LIMITS = FaultLimits(floor=5_000.0, hold_samples=10, lowest=-np.inf, highest=24_000.0)


def swings(rng, noise=500.0, count=200_000, dtype=np.int16):
    return (8000.0 + 3000.0 * np.sin(np.arange(count) / 3000.0) + noise * rng.standard_normal(count)).astype(dtype)


def level(values, *, side=1, limits=LIMITS, block=7_001):
    end = CutOff(side)
    blocks = (values[first : first + block] for first in range(0, values.size, block))
    for counts, codes in flagged(blocks, limits):
        end.add(counts, codes)
    return end.level(limits.hold_samples)


@pytest.mark.parametrize("dtype", [np.int16, np.float32, np.float64])
@pytest.mark.parametrize("block", [50, 7_001, 1_000_000])
def test_the_level_is_the_one_at_which_it_was_cut_off(dtype, block):
    values = swings(np.random.default_rng(1), count=20_000 if block == 50 else 200_000, dtype=dtype)
    assert level(np.minimum(values, dtype(11_500)), block=block) == 11_500.0
    assert level(np.maximum(values, dtype(4_500)), side=-1, block=block) == 4_500.0
    assert level(np.minimum(values, dtype(11_500)), side=-1, block=block) is None


def test_noise_and_quantised_swings_without_noise_are_whole():
    for seed in range(20):
        assert level(swings(np.random.default_rng(seed))) is None
    still = FaultLimits(floor=5_000.0, hold_samples=0)
    assert level(swings(np.random.default_rng(1), noise=0.0), limits=still) is None


def test_spikes_and_rails_do_not_count_and_a_hold_counts_once():
    values = swings(np.random.default_rng(2))
    values[1000:100_000:1000] = 20_000
    values[500:100_000:1000] = 25_000
    for first in (5_100, 105_000):
        values[first : first + 400] = 14_000
    assert level(values) is None
    # three times the same highest value is no chance
    values[150_000:150_400] = 14_000
    assert level(values) == 14_000.0


def channel_of(counts):
    return Channel(
        name="M_s", unit="V", rate_hz=2000.0, start_s=0.0, count=counts.size, scale=1e-3, offset=0.0,
        source=lambda first, stop: counts[first:stop],
    )  # fmt: skip


def two_levels(rng, noise=500.0, count=1_000_000):
    """Swings about 16000 in the first half of the time, and about 8000 in the second, in counts."""
    time = np.arange(count)
    values = np.where(time < count // 2, 16_000.0, 8_000.0) + 3000.0 * np.sin(time / 3000.0)
    return (values + noise * rng.standard_normal(count)).astype(np.int16)


@pytest.mark.parametrize(("half", "level"), [(0, 16_500), (1, 9_000)])
def test_a_range_that_is_too_small_in_a_part_of_a_test_is_named(half, level):
    counts = two_levels(np.random.default_rng(3))
    part = slice(half * counts.size // 2, (half + 1) * counts.size // 2)
    counts[part] = np.minimum(counts[part], level)
    (reason,) = expect_whole_crests(channel_of(counts))
    assert reason.kind == "clipping"
    where = "highest value," if half == 0 else "highest value in a part of the recording,"
    assert f"sticks at its {where} {level / 1000:.4g} V" in reason.sentence


def test_swings_held_values_and_a_quiet_channel_that_stands_at_levels_are_whole():
    rng = np.random.default_rng(4)
    assert expect_whole_crests(channel_of(two_levels(rng))) == ()
    held = two_levels(rng)
    held[600_000:660_000] = held[600_000]
    assert expect_whole_crests(channel_of(held)) == ()
    # a staircase without noise behind a slow swing, with a way between its levels that is shown step by step
    stairs = np.repeat(np.tile([8_000.0, 11_000.0, 8_000.0, 5_000.0], 25), 10_000)
    smooth = np.convolve(stairs, np.full(2_000, 1.0 / 2_000), mode="same").astype(np.int16)
    swing = (8_000.0 + 5_000.0 * np.sin(np.arange(60_000) * 2.0 * np.pi / 60_000)).astype(np.int16)
    assert expect_whole_crests(channel_of(np.concatenate([swing, smooth[2_000:-2_000]]))) == ()
