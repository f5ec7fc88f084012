"""A logged pitch that shifts against what asks for it while a leg is tested."""

from types import SimpleNamespace

import numpy as np
import pytest

from shaftprint.signals import LegState
from shaftprint.spectra.legs._leg_window import LegWindow
from shaftprint.spectra.legs._pitch_shifts import pitch_shift_reasons, shift_of_periods

PERIOD_S, PERIODS, RATE_HZ = 48.0, 11, 20.0
HARMONICS, PHASES = (3, 9, 15, 21), (5.0, 3.2, 4.6, 0.3)
LAG_S, DELAY_S = 0.7, 0.3
TIME_S = np.arange(round(PERIODS * PERIOD_S * RATE_HZ)) / RATE_HZ


def measured(late_s, *, symbol="theta_set"):
    """A leg whose pitch follows through a lag and a delay, and is logged late by so much at each instant besides."""
    rng = np.random.default_rng(5)
    omega = 2.0 * np.pi * np.array(HARMONICS)[:, np.newaxis] / PERIOD_S
    turn = omega * TIME_S + np.array(PHASES)[:, np.newaxis]
    asked = np.cos(turn).sum(axis=0)
    response = np.exp(-1j * omega * (DELAY_S + late_s)) / (1.0 + 1j * omega * LAG_S)
    pitch = (np.exp(1j * turn) * response).real.sum(axis=0) + 0.05 * rng.standard_normal(TIME_S.size)
    values = np.stack([asked, pitch]).reshape(2, PERIODS, -1)
    state = LegState(name="P1", start_s=78.0, period_s=PERIOD_S, periods=PERIODS, working_point=None)
    window = LegWindow(state=state, clock_ratio=0.0, channels=(symbol, "theta"), values=values)
    return SimpleNamespace(window=window, harmonics=HARMONICS, lines=[SimpleNamespace(excitation=symbol)])


def told(late_s, **leg):
    return pitch_shift_reasons(measured(late_s, **leg), moved="U_pitch", shown="P_feedback")


@pytest.mark.parametrize("size_s", [0.06, 0.015, -0.03])
@pytest.mark.parametrize("at_s", [4.0 * PERIOD_S, 4.4 * PERIOD_S])
def test_samples_that_were_lost_are_told_with_their_time_and_the_period(size_s, at_s):
    (reason,) = told(np.where(at_s < TIME_S, size_s, 0.0))
    assert reason.kind == "late pitch feedback"
    assert (
        f"comes {'later' if size_s > 0.0 else 'earlier'} behind U_pitch by {1e3 * abs(size_s):.0f} ms"
        in reason.sentence
    )
    assert f"from about {78.0 + 4.0 * PERIOD_S:.0f} s on" in reason.sentence


def test_clocks_that_run_apart_are_told_in_parts_per_million():
    (reason,) = told(80e-6 * TIME_S)
    assert "by 38 ms from the first period of P1 to the last, as with clocks that are 80 ppm apart" in reason.sentence


def test_behind_the_set_point_of_the_speed_it_may_be_that_one():
    (reason,) = told(np.where(TIME_S > 200.0, 0.06, 0.0), symbol="n_set")
    assert reason.kind == "late set point"


def test_a_pitch_that_follows_alike_however_late_is_no_shift():
    assert told(0.0 * TIME_S) == ()
    assert told(0.0 * TIME_S + 0.2) == ()


@pytest.mark.parametrize(("periods", "std_s"), [(6, 0.003), (11, 0.0015)])
def test_periods_that_differ_by_chance_shift_once_in_a_hundred_legs_at_most(periods, std_s):
    rng = np.random.default_rng(3)
    drawn = std_s * rng.standard_normal((400, periods))
    assert sum(shift_of_periods(one - one.mean()) is not None for one in drawn) <= 4
