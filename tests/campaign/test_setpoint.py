"""The set point over time."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from shaftprint.campaign import Campaign, Sine, Staircase, load_campaign, setpoint
from shaftprint.campaign._excitations import Chirp


def _campaign(**excitations):
    return Campaign(name="test", duration_s=1000.0, offset_v=-5.0, **excitations)


SINE = Sine(name="S1", frequency_hz=0.25, amplitude_v=0.6, start_s=10.0, settled_s=20.0, stop_s=50.0)
UP = Chirp(name="C1", start_frequency_hz=0.01, stop_frequency_hz=1.0, amplitude_v=0.5, start_s=100.0, stop_s=300.0)
DOWN = Chirp(name="C2", start_frequency_hz=1.0, stop_frequency_hz=0.01, amplitude_v=0.5, start_s=400.0, stop_s=600.0)
STAIRS = Staircase(name="St1", levels_v=(-3.0, -4.0, -6.0), dwell_s=60.0, start_s=700.0)
ALL = _campaign(sines=(SINE,), chirps=(UP, DOWN), staircases=(STAIRS,))


def test_a_sine_starts_at_phase_zero_and_ends_at_its_stop():
    times = [9.999, 10.0, 11.0, 12.0, 13.0, 14.0, 49.0, 50.0]
    assert setpoint(ALL, times) == pytest.approx([-5.0, -5.0, -4.4, -5.0, -5.6, -5.0, -5.6, -5.0])


def test_a_sine_starts_at_any_phase_and_sign():
    falling = SINE.model_copy(update={"phase_rad": np.pi})
    cosine = SINE.model_copy(update={"phase_rad": np.pi / 2.0})
    times = [10.0, 11.0, 12.0, 13.0]
    assert setpoint(_campaign(sines=(falling,)), times) == pytest.approx([-5.0, -5.6, -5.0, -4.4])
    assert setpoint(_campaign(sines=(cosine,)), times) == pytest.approx([-4.4, -5.0, -5.6, -5.0])


@pytest.mark.parametrize("sweep", ["logarithmic", "linear"])
def test_a_chirp_upside_down_is_one_with_half_a_turn(sweep):
    up = UP.model_copy(update={"sweep": sweep})
    down = up.model_copy(update={"phase_rad": np.pi})
    time = np.linspace(90.0, 310.0, 5001)
    both = setpoint(_campaign(chirps=(up,)), time) + setpoint(_campaign(chirps=(down,)), time)
    assert both == pytest.approx(np.full(time.size, -10.0), abs=1e-9)


def test_outside_of_excitations_the_offset_is_held():
    assert setpoint(ALL, [-1.0, 0.0, 60.0, 350.0, 650.0, 900.0, 5000.0]).tolist() == [-5.0] * 7


def test_a_staircase_jumps():
    times = [699.999, 700.0, 759.999, 760.0, 819.999, 820.0, 879.999, 880.0]
    assert setpoint(ALL, times).tolist() == [-5.0, -3.0, -3.0, -4.0, -4.0, -6.0, -6.0, -5.0]


def test_the_last_level_holds_to_the_last_moment():
    # 0.1 is not a binary number: three times 0.1 is a little more than 0.3
    stairs = Staircase(name="St", levels_v=(1.0, 2.0, 3.0), dwell_s=0.1, start_s=0.0)
    last = np.nextafter(stairs.stop_s, 0.0)
    assert setpoint(_campaign(staircases=(stairs,)), [last]).tolist() == [3.0]


@pytest.mark.parametrize("chirp", [UP, DOWN])
def test_the_frequency_of_a_chirp_runs_exponentially(chirp):
    duration = 200.0
    time = np.linspace(chirp.start_s, chirp.stop_s, 2_000_001)[:-1]
    value = (setpoint(_campaign(chirps=(chirp,)), time) + 5.0) / 0.5
    assert value[0] == 0.0
    # rising zero crossings are one period apart: their rate is the frequency midway, to second order
    rising = time[1:][(value[:-1] < 0.0) & (value[1:] >= 0.0)] - chirp.start_s
    ratio = chirp.stop_frequency_hz / chirp.start_frequency_hz
    cycles = np.arange(1, rising.size + 1)
    # f(t) = f0 k^(t/T): number of cycles until t, from the integral
    expected = chirp.start_frequency_hz * duration / np.log(ratio) * (ratio ** (rising / duration) - 1.0)
    assert expected == pytest.approx(cycles, abs=2e-4)
    total = (chirp.stop_frequency_hz - chirp.start_frequency_hz) * duration / np.log(ratio)
    assert rising.size == int(total)


@given(st.lists(st.floats(0.0, 1000.0), min_size=1, max_size=50), st.randoms(use_true_random=False))
def test_order_and_chunks_do_not_matter(times, random):
    together = dict(zip(times, setpoint(ALL, times), strict=True))
    random.shuffle(times)
    assert [setpoint(ALL, time).item() for time in times] == [together[time] for time in times]


def test_chunks_of_the_thesis_are_bit_identical():
    thesis = load_campaign("thesis")
    time = np.arange(460.0, 500.0, 1.0 / 2000.0)
    chunks = [setpoint(thesis, chunk) for chunk in np.array_split(time, 17)]
    assert np.array_equal(np.concatenate(chunks), setpoint(thesis, time))


def test_shapes_are_kept():
    assert setpoint(ALL, 5.0).shape == ()
    assert setpoint(ALL, []).shape == (0,)
    assert setpoint(ALL, np.zeros((2, 3))).shape == (2, 3)


def test_the_frequency_of_a_linear_chirp_runs_straight():
    chirp = UP.model_copy(update={"sweep": "linear"})
    time = np.linspace(100.0, 300.0, 2_000_001)[:-1]
    value = (setpoint(_campaign(chirps=(chirp,)), time) + 5.0) / 0.5
    rising = time[1:][(value[:-1] < 0.0) & (value[1:] >= 0.0)] - 100.0
    # f(t) = 0.01 + 0.99 t / 200: its integral is the number of cycles
    assert 0.01 * rising + 0.5 * 0.99 / 200.0 * rising**2 == pytest.approx(np.arange(1, rising.size + 1), abs=2e-4)
    # 101 cycles, of which the last one ends with the chirp
    assert rising.size == 100


@pytest.mark.parametrize(("sweep", "halfway_hz"), [("linear", 0.505), ("logarithmic", 0.1)])
def test_a_chirp_passes_the_mean_of_its_ends_half_way(sweep, halfway_hz):
    chirp = DOWN.model_copy(update={"sweep": sweep})
    assert chirp.passes_s(halfway_hz) == pytest.approx(500.0)
    assert [chirp.passes_s(hertz) for hertz in (2.0, 0.005)] == [400.0, 600.0]
