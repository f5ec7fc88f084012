import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shaftprint.errors import SignalError
from shaftprint.signals.pulses._edges import PulseLevels, find_edges, pulse_levels

LEVELS = PulseLevels(low=0.0, high=1000.0, noise=1.0, duty=0.1)


def trapezoids(starts: np.ndarray, *, rise: float = 2.5, top: float = 8.0, count: int = 2000) -> np.ndarray:
    """Pulses of height 1000 that are half way up at the given places."""
    place = np.arange(count)
    height = np.zeros(count)
    for start in starts:
        up = np.clip((place - start) / rise + 0.5, 0.0, 1.0)
        down = np.clip((start + top - place) / rise + 0.5, 0.0, 1.0)
        height = np.maximum(height, np.minimum(up, down))
    return 1000.0 * height


def test_edges_between_samples_are_exact_on_a_straight_flank():
    starts = np.array([40.0, 100.37, 171.912, 250.5, 400.001])
    assert find_edges([trapezoids(starts)], LEVELS) == pytest.approx(starts, abs=1e-9)


def test_edges_of_int16_counts_are_as_good_as_their_resolution():
    starts = 50.0 + 61.803 * np.arange(30)
    counts = np.rint(trapezoids(starts)).astype(np.int16)
    # half a count on a slope of 400 counts a sample
    assert find_edges([counts], LEVELS) == pytest.approx(starts, abs=0.5 / 400.0 + 1e-9)


@settings(deadline=None, max_examples=40)
@given(size=st.integers(1, 700), seed=st.integers(0, 5))
def test_cut_into_blocks_does_not_matter(cut, size, seed):
    rng = np.random.default_rng(seed)
    starts = 30.0 + np.cumsum(rng.uniform(25.0, 60.0, 30))
    counts = np.rint(trapezoids(starts) + 20.0 * rng.standard_normal(2000)).astype(np.int16)
    whole = find_edges([counts], LEVELS)
    assert np.array_equal(find_edges(cut(counts, size), LEVELS), whole)
    assert whole.size == 30


def test_a_pulse_that_begins_in_one_block_and_ends_in_another_has_its_edge():
    counts = trapezoids(np.array([40.2, 100.7]), count=150)
    for size in (1, 40, 41, 150):
        blocks = [counts[first : first + size] for first in range(0, 150, size)]
        assert find_edges(blocks, LEVELS) == pytest.approx([40.2, 100.7], abs=1e-9)


def test_ripple_around_the_middle_makes_one_edge():
    counts = np.array([0.0, 400.0, 600.0, 450.0, 650.0, 900.0, 1000.0, 0.0])
    # the last crossing before the pulse is up: between 450 and 650
    assert find_edges([counts], LEVELS) == pytest.approx([3.25])


def test_pulse_that_is_already_up_at_the_start_is_no_edge():
    assert find_edges([trapezoids(np.array([-1.0, 60.5]))], LEVELS) == pytest.approx([60.5])


def test_no_blocks_no_edges():
    assert find_edges([], LEVELS).size == 0


def turning(seconds: float = 40.0, speed_rev_s: float = 19.7) -> np.ndarray:
    return speed_rev_s * np.arange(round(seconds * 2000.0)) / 2000.0


def test_levels_are_found_in_noise(make_channel, pulse_train):
    rng = np.random.default_rng(3)
    volts = 0.35 + 4.15 * pulse_train(turning(), np.array([0.4])) + 0.02 * rng.standard_normal(80_000)
    levels = pulse_levels(make_channel(volts))
    assert levels.low == pytest.approx(0.35, abs=0.01)
    # the median of a short pulse leans a little towards its flanks
    assert levels.high == pytest.approx(4.5, abs=0.08)
    assert levels.noise == pytest.approx(0.02, rel=0.1)
    assert levels.duty == pytest.approx(0.06, abs=0.005)


@pytest.mark.parametrize(("edge", "scale"), [("falling", 1.0), ("rising", -1.0)])
def test_pulses_that_point_down_are_timed_at_their_beginning(make_channel, edge, scale):
    starts = 50.25 + 61.5 * np.arange(30)
    counts = 2000.0 - trapezoids(starts)
    levels = pulse_levels(make_channel(counts, scale=scale), edge=edge)
    assert (levels.low, levels.high) == (2000.0, 1000.0)
    assert find_edges([counts], levels) == pytest.approx(starts, abs=1e-9)


def test_both_edge_and_scale_turned_over_is_upright_again(make_channel):
    counts = trapezoids(50.25 + 61.5 * np.arange(30))
    levels = pulse_levels(make_channel(counts, scale=-1.0), edge="falling")
    assert levels.high > levels.low


@pytest.mark.parametrize("values", [np.full(5000, 2.0), np.random.default_rng(1).normal(2.0, 0.1, 5000)])
def test_channel_without_pulses_is_dead(make_channel, values):
    with pytest.raises(
        SignalError, match=r"channel PTM_e: expected pulses .* dead or saturated near (1.9|2).* V from 12\.5 s on"
    ):
        pulse_levels(make_channel(values, name="PTM_e", start_s=12.5))


def magnetic(seconds: float = 20.0, teeth: int = 60, rate_hz: float = 2000.0, noise: float = 0.01):
    """Voltage of a magnetic pick-up, a sine as high as the teeth are fast, and when the teeth pass [samples]."""
    fine = np.arange(0.0, seconds, 1e-5)
    speed = 2.5 * (1.0 + 0.1 * np.sin(2.0 * np.pi * 0.3 * fine))
    turns = np.cumsum(speed) * 1e-5 - speed[0] * 1e-5
    time = np.arange(round(seconds * rate_hz)) / rate_hz
    volts = np.interp(time, fine, speed * np.sin(2.0 * np.pi * teeth * turns))
    volts += noise * 2.5 * np.random.default_rng(7).standard_normal(time.size)
    passed = np.interp(np.arange(1.0, np.floor(teeth * turns[-1])) / teeth, turns, fine)
    return volts, passed * rate_hz


def test_sines_of_a_magnetic_pick_up_are_timed_at_their_zeros(make_channel):
    volts, teeth = magnetic()
    levels = pulse_levels(make_channel(volts))
    edges = find_edges([volts], levels)
    error = edges[np.abs(edges[:, np.newaxis] - teeth).argmin(axis=0)] - teeth
    assert abs(edges.size - teeth.size) <= 1
    # a hundredth of the height as noise, on a slope of 0.47 of it a sample
    assert np.std(error) == pytest.approx(0.01 / 0.47, rel=0.2)
    assert abs(np.mean(error)) < 0.005


@pytest.mark.parametrize(
    "values",
    [
        np.cumsum(np.random.default_rng(4).standard_normal(80_000)),
        np.linspace(0.0, 1.0, 80_000),
        np.convolve(np.random.default_rng(5).standard_normal(80_000), np.hanning(200), "same"),
    ],
)
def test_what_wanders_is_no_pulse(make_channel, values):
    with pytest.raises(SignalError, match=r"expected pulses between two levels"):
        pulse_levels(make_channel(values))
