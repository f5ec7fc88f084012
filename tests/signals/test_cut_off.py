"""Crests that are cut off below the full scale that is stated, told from noise, holds and slow quantised swings."""

import numpy as np
import pytest

from shaftprint.signals.conditioning import CutOff, FaultLimits, flagged

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
