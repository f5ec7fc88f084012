import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shaftprint.signals import pulse_period_speed
from shaftprint.signals.conditioning._decimate import SampleGrid
from shaftprint.signals.conditioning._thesis import previous_neighbours
from shaftprint.signals.pulses._pulses import number_pulses


@settings(deadline=None, max_examples=40)
@given(size=st.integers(1, 700), first=st.sampled_from([0.0, 3.0, 4.99, -12.5]), step=st.sampled_from([10.0, 9.7, 1.0]))
def test_previous_neighbours(cut, size, first, step):
    samples = np.random.default_rng(1).standard_normal(1000)
    grid = SampleGrid(first=first, step=step, count=120)
    place = np.clip(np.floor(first + step * np.arange(120) + 1e-9).astype(int), 0, 999)
    assert np.array_equal(previous_neighbours(cut(samples, size), grid), samples[place])


def test_after_the_last_sample_the_last_one_is_held():
    found = previous_neighbours([np.arange(10.0)], SampleGrid(first=5.0, step=2.0, count=6))
    assert found.tolist() == [5.0, 7.0, 9.0, 9.0, 9.0, 9.0]


def speed_of(pulses, make_channel, *, strips=1, count=400, start_s=0.0):
    train = number_pulses(np.asarray(pulses, dtype=float), channel="P")
    channel = make_channel(np.zeros(4000), start_s=start_s)
    return pulse_period_speed(train, strips, channel, start_s=start_s, step_s=0.005, count=count)


def test_periods_are_whole_samples_and_stamped_at_their_end(make_channel):
    # a period of 100.4 samples: edges come 100 or 101 samples apart
    pulses = 7.3 + 100.4 * np.arange(30)
    speed = speed_of(pulses, make_channel)
    assert set(np.round(2000.0 / speed, 9)) == {100.0, 101.0}
    # first samples of the pulses: 8, 108, 209, 309, ...: 101 samples end at 209, on the grid at 210
    period = 2000.0 / speed
    assert period[:21] == pytest.approx(np.full(21, 100.0))
    assert period[21:31] == pytest.approx(np.full(10, 101.0))


def test_edge_that_lies_on_a_sample_counts_there(make_channel):
    speed = speed_of(100.0 * np.arange(1, 30) + 1e-9, make_channel)
    assert speed == pytest.approx(np.full(400, 20.0), rel=1e-12)


def test_strips_are_taken_as_even_and_missing_periods_as_their_neighbours(make_channel):
    places = np.array([0.0, 0.3, 0.5, 0.75])
    pulses = 40.0 + 400.0 * (np.arange(12)[:, np.newaxis] + places).ravel()
    speed = speed_of(pulses, make_channel, strips=4)
    # intervals of 120, 80, 100, 100 samples seem to be different speeds
    assert set(np.round(speed, 9)) == {round(2000.0 / 480.0, 9), 6.25, 5.0}
    holed = speed_of(np.delete(40.0 + 100.0 * np.arange(40), 20), make_channel)
    assert holed == pytest.approx(np.full(400, 20.0))


def test_clock_of_the_channel(make_channel):
    pulses = np.concatenate([100.0 * np.arange(1, 20), 1900.0 + 50.0 * np.arange(1, 20)])
    at_zero = speed_of(pulses, make_channel)
    later = speed_of(pulses, make_channel, start_s=3.0)
    assert np.array_equal(at_zero, later)
