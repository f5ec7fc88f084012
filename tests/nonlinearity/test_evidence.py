"""Harmonics, levels, steps and clipped stretches against laws and closed forms."""

import math
import re
from types import SimpleNamespace

import numpy as np
import pytest

from shaftprint.nonlinearity import NUMBERS
from shaftprint.nonlinearity._noise_model import ORDER, whiten
from shaftprint.nonlinearity._replay import actuation_step
from shaftprint.nonlinearity._tails import chi_square_tail, f_tail_two
from shaftprint.nonlinearity._words import finding_of
from shaftprint.tug import Noise

FREE = {"motoring_torque_nm": 9000.0}
CALM = Noise().without(process=True, measurement=True, faults=True)


@pytest.fixture(scope="module")
def linear(found, strong):
    return found(strong, seed=4, **FREE)


@pytest.fixture(scope="module")
def limited(found, vessel):
    return found(vessel, seed=4, **FREE)


def test_the_propeller_alone_has_a_second_harmonic_and_it_is_expected(found, strong):
    """A speed that is a pure sine of 12.72 % would give 0.81 % of M_s0; here the speed gives way under the governor."""
    told = found(strong, seed=None, noise=CALM, **FREE)
    slow = told.harmonics.lines.index("S2")
    assert 0.003 < told.harmonics.amplitude[slow, 1, 0] < 0.0081
    assert told.harmonics.expected[slow, :, 0] == pytest.approx(told.harmonics.amplitude[slow, :, 0], rel=0.06)
    assert told.linear


def test_a_linear_line_has_the_same_gain_at_all_levels(linear):
    levels = linear.levels
    assert set(levels.tests) <= {"S1", "S2", "S3", "S4", "S5", "S6", "S7", "St1", "St2"}
    assert abs(levels.large_minus_small) < 4.0 * levels.large_minus_small_std
    assert np.all(np.abs(levels.gain) < 5.0 * levels.gain_std)
    assert levels.p_value > 1e-4


def test_a_torque_limit_takes_gain_from_the_large_tests(limited):
    assert limited.levels.large_minus_small < 0.0
    assert limited.levels.p_value < 1e-4


def test_steps_of_a_linear_line_are_the_expected_ones(linear):
    steps = linear.steps
    assert steps.names == tuple(f"St{stairs}/{step}" for stairs in (1, 2) for step in range(1, 5))
    assert steps.rising.tolist() == [True, True, False, False] * 2
    # 1 V and 2 V are 251 and 502 rpm of 1183.8
    assert np.abs(steps.size) == pytest.approx([250.97 / 1183.8] * 4 + [501.94 / 1183.8] * 4, rel=1e-3)
    rise = NUMBERS.index("rise")
    assert np.all(np.abs(steps.measured - steps.expected)[:, rise] < 5.0 * np.maximum(steps.std[:, rise], 0.1))
    assert steps.p_value.min() > 1e-4


def test_up_is_slower_than_down_behind_a_smoke_limiter(found, vessel):
    steps = found(vessel, seed=4, **FREE, unboosted_torque_share=0.45).steps
    rise = NUMBERS.index("rise")
    assert steps.up_minus_down[rise] > 0.3
    assert steps.p_value[rise] < 1e-3


def test_clipped_stretches_lie_on_the_full_load_curve(limited, vessel):
    limits = limited.limits
    assert limits.start_s.size >= 1
    rpm = 1183.8 * (1.0 + limits.speed)
    curve = np.interp(rpm, vessel.engine.full_load_speed_rpm, vessel.engine.full_load_torque_nm) / 465.54
    assert np.all(np.abs(limits.torque - curve) < 4.0 * limits.torque_std)
    assert limits.limit == pytest.approx(curve, rel=0.03)
    assert np.all(np.isnan(limits.rack))
    assert np.all(limits.curve_std > 0.0)


def test_a_linear_line_has_no_clipped_stretch(linear):
    assert linear.limits.start_s.size == 0
    assert linear.limits.curve_speed.size == 0


def test_the_words_carry_numbers(linear, limited):
    (finding,) = limited.findings
    assert "of the full-load curve" in finding.evidence
    assert "m_max = " in limited.sentence
    assert linear.findings[0].kind == "quadratic propeller only"
    assert linear.start_values == {}
    assert {suspicion.kind for suspicion in linear.suspicions} >= {"torque limit", "deadband", "turbocharger lag"}


@pytest.mark.parametrize(
    ("durations", "expected"),
    [
        ([], r"What the governor asks for is cut off at 0\.962 ± 0\.016 of the full-load curve, too shortly"),
        ([0.4], r"In one stretch of 0\.40 s between 1184 and 1184 rpm the torque of the engine stays on a level"),
        (
            [0.4, 0.25],
            r"In 2 stretches of together 0\.65 s between 1184 and 1184 rpm .*: 0\.962 ± 0\.016 of the full-load",
        ),
    ],
)
def test_a_limit_that_only_the_command_meets_is_not_said_to_hold_the_torque(durations, expected):
    record = SimpleNamespace(
        curve_speed=np.array([-1.0, 1.0]),
        curve_torque=np.array([2.8, 2.8]),
        brake_torque_nm=465.0,
        rated_torque_nm=1300.0,
        engine_speed_rev_s=1183.8 / 60.0,
    )
    fit = SimpleNamespace(values={"limit": 0.962}, std={"limit": 0.016}.get)
    one = SimpleNamespace(kind="torque limit", statistic=1015.0, p_value=0.0)
    size = len(durations)
    limits = SimpleNamespace(duration_s=np.array(durations), torque=np.full(size, 2.7), speed=np.zeros(size))
    assert re.match(expected, finding_of(one, SimpleNamespace(record=record, fit=fit), limits).evidence)


@pytest.mark.parametrize(
    ("statistic", "freedom", "tail"),
    [(3.841458821, 1, 0.05), (5.991464547, 2, 0.05), (7.814727903, 3, 0.05), (9.487729037, 4, 0.05), (0.0, 3, 1.0)],
)
def test_chi_square_against_its_table(statistic, freedom, tail):
    assert chi_square_tail(statistic, freedom) == pytest.approx(tail, rel=1e-8)


def test_tail_of_f_against_its_table():
    """The 5 % point of F with 2 and 20 degrees of freedom is 3.4928."""
    assert f_tail_two(3.492828, 10.0) == pytest.approx(0.05, rel=1e-5)


@pytest.mark.parametrize("zeta", [0.3, 1.0, 1.7])
def test_the_step_of_the_actuation_is_exact(zeta):
    """A constant input for a second in one step and in a hundred, and the closed form of the undamped sine."""
    whole, part = actuation_step(8.0, zeta, 1.0), actuation_step(8.0, zeta, 0.01)
    state = np.zeros(2)
    for _ in range(100):
        state = part[:, :2] @ state + part[:, 2]
    assert whole[:, 2] == pytest.approx(state, rel=1e-6, abs=1e-9)
    assert actuation_step(3.0, 1e-9, 0.4)[0, 2] == pytest.approx(1.0 - math.cos(1.2), rel=1e-6)


def test_whitening_takes_a_known_colour_away():
    rng = np.random.default_rng(3)
    white = rng.standard_normal(20_000)
    coloured = white.copy()
    for k in range(2, coloured.size):
        coloured[k] += 1.5 * coloured[k - 1] - 0.8 * coloured[k - 2]
    found = whiten(coloured)
    assert found.taps[:3] == pytest.approx([1.0, -1.5, 0.8], abs=0.03)
    assert found.squares / found.residual.size == pytest.approx(1.0, rel=0.03)
    assert found.residual.size == white.size - ORDER
