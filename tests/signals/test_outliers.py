import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shaftprint.signals.conditioning._outliers import (
    GOOD,
    HOLD,
    RAIL,
    SPIKE,
    FaultLimits,
    fault_limits,
    flagged,
    mark_holds,
    sample_codes,
)


def hampel(values: np.ndarray, half: int, sigmas: float, floor: float) -> np.ndarray:
    """Plain identifier with two medians a window."""
    windows = np.lib.stride_tricks.sliding_window_view(values.astype(float), 2 * half + 1)
    median = np.median(windows, axis=1)
    mad = np.median(np.abs(windows - median[:, np.newaxis]), axis=1)
    distance = np.abs(values[half : values.size - half] - median)
    return (distance > floor) & (distance > sigmas * 1.4826 * mad)


@pytest.mark.parametrize("dtype", [np.int16, np.float64])
@pytest.mark.parametrize(("half", "sigmas", "floor"), [(10, 3.0, 0.0), (5, 3.0, 300.0), (3, 2.0, 57.3), (1, 5.0, 10.0)])
def test_marks_are_those_of_the_plain_identifier(dtype, half, sigmas, floor):
    rng = np.random.default_rng(half)
    values = (100.0 * rng.standard_t(3, 6000) + 500.0 * np.sin(np.arange(6000) / 20.0)).astype(dtype)
    limits = FaultLimits(floor=floor, sigmas=sigmas, half_window=half)
    codes = sample_codes(values, limits)
    expected = hampel(values, half, sigmas, floor)
    assert expected.sum() > 5
    assert np.array_equal(codes == SPIKE, expected)


def test_runs_of_equal_samples_are_held_from_the_shortest_on():
    rng = np.random.default_rng(4)
    repeated = np.repeat(rng.standard_normal(40), rng.integers(1, 8, 40))
    holds = np.zeros(repeated.size - 10, dtype=np.uint8)
    mark_holds(repeated, 5, 4, holds)
    lengths = np.array([np.sum(repeated == value) for value in repeated])
    assert np.array_equal(holds == HOLD, (lengths >= 4)[5:-5])


def test_spikes_at_both_ends_of_16_bits_are_found():
    values = np.full(60, -32768, dtype=np.int16)
    values[30] = 32767
    codes = sample_codes(values, FaultLimits(floor=60_000.0))
    assert np.flatnonzero(codes == SPIKE).tolist() == [25]


LIMITS = FaultLimits(floor=400.0, hold_samples=12, lowest=-3000.0, highest=3000.0)


def faulty(count: int = 3000) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(11)
    values = (60.0 * rng.standard_normal(count) + 500.0 * np.sin(2 * np.pi * 60.0 * np.arange(count) / 2000.0)).astype(
        np.int16
    )
    codes = np.zeros(count, dtype=np.uint8)
    for sample in (3, 500, 501, 1800, 2997):
        values[sample] += 1700 if values[sample] < 0 else -1700
        codes[sample] = SPIKE
    values[900:960] = values[900]
    codes[900:960] = HOLD
    values[1200:1230] = -3100
    codes[1200:1230] = RAIL
    return values, codes


def test_each_fault_gets_its_code_and_the_ripple_none():
    values, expected = faulty()
    (shown, codes), *rest = list(flagged([values], LIMITS))
    shown = np.concatenate([shown, *(part for part, _ in rest)])
    codes = np.concatenate([codes, *(part for _, part in rest)])
    assert np.array_equal(shown, values)
    assert np.array_equal(codes, expected)


@settings(deadline=None, max_examples=30)
@given(size=st.integers(1, 1200))
def test_cut_into_blocks_does_not_matter(cut, size):
    values, expected = faulty()
    parts = list(flagged(cut(values, size), LIMITS))
    assert np.array_equal(np.concatenate([shown for shown, _ in parts]), values)
    assert np.array_equal(np.concatenate([codes for _, codes in parts]), expected)


def test_fewer_samples_than_a_margin():
    ((shown, codes),) = list(flagged([np.array([1.0, 2.0]), np.array([3.0])], LIMITS))
    assert shown.tolist() == [1.0, 2.0, 3.0]
    assert codes.tolist() == [GOOD, GOOD, GOOD]


def test_no_blocks_nothing_flagged():
    assert list(flagged([], LIMITS)) == []


def test_a_clean_step_and_a_staircase_are_good():
    values = np.repeat([0.0, 1000.0, 1700.0, 1000.0, 0.0], 40)
    (_, codes), *_ = list(flagged([values], FaultLimits(floor=10.0)))
    assert np.all(codes == GOOD)


def test_limits_follow_the_noise_of_the_channel(make_channel):
    rng = np.random.default_rng(5)
    channel = make_channel((200.0 * rng.standard_normal(100_000)).astype(np.int16))
    limits = fault_limits(channel, holds=True)
    # 5 times the 99 % point of the distance from the median, about 2.6 standard deviations
    assert limits.floor == pytest.approx(5.0 * 2.55 * 200.0, rel=0.05)
    assert limits.hold_samples == 10
    assert fault_limits(channel, holds=False).hold_samples == 0


def test_quiet_channel_is_judged_by_its_steps(make_channel):
    values = np.where(np.arange(50_000) % 5000 < 2500, 100, 103).astype(np.int16)
    limits = fault_limits(make_channel(values), holds=True)
    assert limits.floor == 12.0
    # it stands still by itself: holds cannot be told
    assert limits.hold_samples == 0


@pytest.mark.parametrize("count", [5, 40])
def test_constant_or_short_channel_has_no_floor(make_channel, count):
    limits = fault_limits(make_channel(np.full(count, 7.0)), holds=True)
    assert limits.floor == 0.0
    assert limits.hold_samples == 0


def test_channel_that_dies_half_way_still_shows_its_noise(make_channel):
    rng = np.random.default_rng(6)
    values = (200.0 * rng.standard_normal(400_000)).astype(np.int16)
    values[200_000:] = 0
    assert fault_limits(make_channel(values), holds=True).hold_samples == 10
