"""Periodic excitations at levels of their own."""

import numpy as np
import pytest
from pydantic import ValidationError

from shaftprint.campaign import Campaign, Multisine, setpoint
from shaftprint.campaign._binary_sequence import BinarySequence

MULTISINE = {
    "name": "M1",
    "level_v": -6.0,
    "period_s": 8.0,
    "harmonics": (1, 3),
    "amplitudes_v": (0.5, 0.2),
    "phases_rad": (0.0, np.pi / 2.0),
    "start_s": 100.0,
    "settled_s": 108.0,
    "stop_s": 125.0,
}


def test_a_multisine_is_the_sum_of_its_sines_about_its_level():
    campaign = Campaign(name="test", duration_s=200.0, offset_v=-5.0, ramp_s=4.0, multisines=(Multisine(**MULTISINE),))
    # sin(2 pi t / 8) and cos(6 pi t / 8) at 0, 2, 4, 6 s: 0, 1, 0, -1 and 1, 0, -1, 0
    expected = [-6.0 + 0.2, -6.0 + 0.5, -6.0 - 0.2, -6.0 - 0.5]
    for period in range(3):
        times = 100.0 + 8.0 * period + np.array([0.0, 2.0, 4.0, 6.0])
        assert setpoint(campaign, times) == pytest.approx(expected)


def test_the_window_of_a_leg_holds_whole_periods():
    leg = Multisine(**MULTISINE)
    assert (leg.periods, leg.window_s, leg.window_stop_s) == (2, 16.0, 124.0)
    assert leg.lines == {1: 0.5, 3: 0.2}


def test_the_extremes_of_a_leg_are_those_of_its_sum():
    # sin x + sin(3 x + pi) / 2: d/dx = cos x - 1.5 cos 3x = 0 at cos(x)^2 = 11/12 or cos x = 0; sin x + 0.5 at x = pi/2
    leg = Multisine(**MULTISINE | {"amplitudes_v": (0.6, 0.3), "phases_rad": (0.0, np.pi)})
    assert leg.extremes_v == pytest.approx((-6.0 - 0.9, -6.0 + 0.9), abs=0.009)


@pytest.mark.parametrize(
    ("changed", "expected"),
    [
        ({"settled_s": 90.0}, "start_s <= settled_s < stop_s, found 100, 90, 125"),
        ({"stop_s": 120.0}, "at least 2 periods of 8 s between settled_s and stop_s.*found 12 s"),
        ({"harmonics": (3, 1)}, "harmonics to ascend, found 1 after 3"),
        ({"amplitudes_v": (0.5,)}, "as many amplitudes_v and phases_rad as harmonics, found 1 and 2 for 2"),
        ({"amplitudes_v": (0.5, 0.0)}, "greater than 0"),
    ],
)
def test_an_impossible_multisine_is_refused(changed, expected):
    with pytest.raises(ValidationError, match=expected):
        Multisine(**(MULTISINE | changed))


def _two_legs(**changed):
    second = MULTISINE | {"name": "M2", "level_v": -3.0, "start_s": 145.0, "settled_s": 153.0, "stop_s": 169.0}
    legs = (Multisine(**MULTISINE | {"stop_s": 124.0}), Multisine(**second))
    settings = {"name": "test", "duration_s": 200.0, "offset_v": -5.0, "multisines": legs, "ramp_v_per_s": 0.5}
    return Campaign(**(settings | changed))


def test_the_set_point_goes_straight_from_leg_to_leg_and_back():
    # the legs begin and end 0.2 V above their levels: -5.8 and -2.8 V; 0.5 V/s need 1.6, 6.0 and 4.4 s
    times = [98.4, 99.2, 124.0, 138.9, 142.0, 144.0, 169.0, 171.0, 174.0]
    expected = [-5.0, -5.4, -5.8, -5.8, -4.3, -3.3, -2.8, -3.8, -5.0]
    assert setpoint(_two_legs(), times) == pytest.approx(expected)


def test_no_set_point_jumps_by_more_than_its_own_motion():
    times = np.arange(90.0, 190.0, 0.001)
    steps = np.abs(np.diff(setpoint(_two_legs(ramp_v_per_s=None, ramp_s=6.0), times)))
    # the fastest change is that of the lines, (0.5 + 3 0.2) 2 pi / 8 V/s, since all ramps are slower than 0.6 V/s
    assert steps.max() < 0.001 * 1.1 * 2.0 * np.pi / 8.0


@pytest.mark.parametrize(
    ("changed", "expected"),
    [
        ({"ramp_v_per_s": None}, "ramp_s or ramp_v_per_s, how the set point goes from -5 to -5.8 V before M1"),
        ({"ramp_s": 2.0}, "one of ramp_s and ramp_v_per_s, found both"),
        ({"ramp_v_per_s": 0.1}, "at least 30 s between M1 and M2 for the ramp from -5.8 to -2.8 V, found 21 s"),
        ({"duration_s": 170.0}, "at least 4.4 s after M2 for the ramp from -2.8 to -5 V, found 1 s"),
    ],
)
def test_ramps_without_time_or_rate_are_refused(changed, expected):
    with pytest.raises(ValidationError, match=expected):
        _two_legs(**changed)


def _sequence(order, **changed):
    settings = {"name": "B1", "level_v": -4.0, "amplitude_v": 0.3, "clock_s": 0.5, "order": order, "start_s": 7.0}
    return BinarySequence(**(settings | {"settled_s": 7.0, "stop_s": 7.0 + 3 * (2**order)} | changed))


@pytest.mark.parametrize("order", range(3, 13))
def test_a_binary_sequence_has_the_autocorrelation_of_one_of_maximal_length(order):
    leg = _sequence(order)
    length = 2**order - 1
    values = (leg.value_at(7.0 + 0.5 * np.arange(2 * length) + 0.25) + 4.0) / 0.3
    # every second value is turned over: turned back it is a sequence whose shifted products sum to -1
    turned = values * np.where(np.arange(2 * length) % 2, -1.0, 1.0)
    sequence = turned[:length]
    correlation = np.fft.ifft(np.abs(np.fft.fft(sequence)) ** 2).real
    assert correlation[0] == pytest.approx(length)
    assert correlation[1:] == pytest.approx(-np.ones(length - 1))
    # and the second half is the first one turned over, which leaves no even harmonic
    assert values[length:] == pytest.approx(-values[:length])
    assert all(harmonic % 2 for harmonic in leg.lines)


def test_the_lines_of_a_binary_sequence_are_those_of_its_held_values():
    leg = _sequence(5)
    times = 7.0 + leg.length_of_period_s * (np.arange(200 * 62) + 0.5) / (200 * 62)
    spectrum = np.abs(np.fft.rfft(leg.value_at(times))) * 2.0 / times.size
    assert leg.lines.keys() == set(range(1, 28, 2))
    for harmonic, amplitude_v in leg.lines.items():
        assert spectrum[harmonic] == pytest.approx(amplitude_v, rel=1e-3)


def test_a_binary_sequence_begins_at_any_clock_and_is_upside_down_half_a_period_on():
    first = BinarySequence(
        name="B", level_v=-4.0, amplitude_v=0.3, clock_s=0.5, order=4, start_s=10.0, settled_s=20.0, stop_s=60.0
    )
    time = 10.0 + 0.25 + 0.5 * np.arange(60)
    later = first.model_copy(update={"first_clock": 7})
    assert later.value_at(time).tolist() == np.roll(first.value_at(time)[:30], -7).tolist() * 2
    inverted = first.model_copy(update={"first_clock": 15})
    assert inverted.value_at(time) + first.value_at(time) == pytest.approx(np.full(60, -8.0))
    with pytest.raises(ValueError, match="expected first_clock below the 30 clocks of a period, found 30"):
        BinarySequence.model_validate(first.model_dump() | {"first_clock": 30})
