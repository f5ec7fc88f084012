"""The controllable pitch of a simulated ship: its torque by the series, its actuator by hand, its small signals."""

from dataclasses import replace

import numpy as np
import pytest
from tests.tug.ideal_signals import simulate_signals
from tests.tug.linearised import linearised_response

from shaftprint.errors import SettingsError
from shaftprint.propeller import ka4_70_in_19a, wageningen_b
from shaftprint.tug import like_stan_tug_1205, normalised_truth
from shaftprint.tug._pitch_actuation import PitchActuation
from shaftprint.tug._pitch_series import steepened, torque_over_pitch
from shaftprint.tug.plant._pitch import PitchActuator
from shaftprint.vessel import load_vessel

REST_V = 4.0
RATIO_PER_V, PITCH_RATIO = 0.14, 0.80
SPEED_REV_S, TORQUE_NM = 600.0 / 60.0 / 3.91, 32990.0
UPSTREAM, DOWNSTREAM = 130.0 * 3.91**2 + 75.0, 1077.0


@pytest.fixture(scope="module")
def ship():
    return load_vessel("nifs-research-vessel")


@pytest.fixture
def tug(ship, quiet):
    return replace(like_stan_tug_1205(ship), noise=quiet)


@pytest.fixture
def moved(ask):
    """Return a campaign in which the pitch alone moves, about the working point."""

    def campaign(frequency_hz, amplitude_v, *, periods=4):
        settled_s = 30.0
        sine = {
            "name": "P",
            "input": "pitch_set_point",
            "frequency_hz": frequency_hz,
            "amplitude_v": amplitude_v,
            "start_s": 0.0,
            "settled_s": settled_s,
            "stop_s": settled_s + periods / frequency_hz + 0.01,
        }
        return ask(
            settled_s + periods / frequency_hz + 1.0, sines=[sine], further_offsets_v={"pitch_set_point": REST_V}
        )

    return campaign


def polynomial_at(powers, pitch_ratio):
    return sum(c * pitch_ratio**k for k, c in enumerate(powers))


@pytest.mark.parametrize(("blades", "area_ratio"), [(3, 0.5), (4, 0.6), (4, 0.7), (5, 0.75)])
def test_torque_over_pitch_is_that_of_the_series(ship, blades, area_ratio):
    propeller = ship.propeller.model_copy(update={"blades": blades, "area_ratio": area_ratio})
    powers = torque_over_pitch(ship.model_copy(update={"propeller": propeller}))
    curve = wageningen_b(blades=blades, area_ratio=area_ratio)
    for pitch_ratio in (0.5, 0.8, 1.1, 1.4):
        assert polynomial_at(powers, pitch_ratio) == pytest.approx(curve.at(0.0, pitch_ratio).torque, rel=1e-12)


def test_torque_over_pitch_in_a_nozzle_is_that_of_the_series():
    powers = torque_over_pitch(load_vessel("stan-tug-1205"))
    for pitch_ratio in (0.6, 0.8, 1.11, 1.4):
        assert polynomial_at(powers, pitch_ratio) == pytest.approx(
            ka4_70_in_19a().at(0.0, pitch_ratio).torque, rel=1e-12
        )


def test_a_steeper_curve_stays_at_the_working_point(ship):
    powers = torque_over_pitch(ship)
    steeper = steepened(powers, 0.8, 1.2)
    assert polynomial_at(steeper, 0.8) == pytest.approx(polynomial_at(powers, 0.8), rel=1e-12)
    rise = polynomial_at(powers, 0.9) - polynomial_at(powers, 0.8)
    assert polynomial_at(steeper, 0.9) - polynomial_at(steeper, 0.8) == pytest.approx(1.2 * rise, rel=1e-9)


def closed_form(tug, frequency_hz, slope):
    """Speed, torque and pitch from the set point of the pitch, with the two inertias on either side of the gauge.

    ``(tau_up + tau_dn) s n = M_b - M_p``, ``M_b = -C F e^(-s t_d) n``, ``M_p = 2 n + q theta`` and ``M_s = M_p + tau_dn
    s n``.
    """
    s = 2j * np.pi * frequency_hz
    up, down = (2.0 * np.pi * inertia * SPEED_REV_S / TORQUE_NM for inertia in (UPSTREAM, DOWNSTREAM))
    lag = tug.natural_frequency_rad_s**2 / (
        s**2 + 2.0 * tug.damping_ratio * tug.natural_frequency_rad_s * s + tug.natural_frequency_rad_s**2
    )
    governor = tug.proportional_gain + tug.integral_gain_per_s / s
    theta = tug.pitch.set_point_scale * np.exp(-s * tug.pitch.delay_s) / (tug.pitch.lag_s * s + 1.0)
    speed = -slope * theta / ((up + down) * s + 2.0 + governor * lag * np.exp(-s * tug.governor_delay_s))
    return np.array([speed, (down * s + 2.0) * speed + slope * theta, tug.pitch.sensor_scale * theta])


@pytest.mark.parametrize(
    "change", [{}, {"lag_s": 1.7, "delay_s": 0.0}, {"lag_s": 0.31, "set_point_scale": 1.06, "sensor_scale": 0.97}]
)
def test_small_signals_are_those_worked_out_by_hand(ship, tug, change):
    slow = replace(tug, pitch=replace(tug.pitch, **change))
    frequency = np.geomspace(0.1, 10.0, 40) / (2.0 * np.pi)
    # d ln K_Q / d ln (P/D) of B4-60 at 0.8, by differences of the series' own curve
    curve, step = wageningen_b(blades=4, area_ratio=0.6), 1e-4
    ends = [curve.at(0.0, PITCH_RATIO + side * step).torque for side in (-1.0, 1.0)]
    slope = PITCH_RATIO * (ends[1] - ends[0]) / (2.0 * step * curve.at(0.0, PITCH_RATIO).torque)
    found = linearised_response(slow, ship, frequency, outputs=("n", "M_s", "theta"), input="theta_set")[:, 0]
    ratio = found / np.array([closed_form(slow, f, slope) for f in frequency]).T
    assert np.abs(ratio) == pytest.approx(np.ones(ratio.shape), abs=1e-6)
    assert np.degrees(np.angle(ratio)) == pytest.approx(np.zeros(ratio.shape), abs=1e-5)
    told = normalised_truth(slow, ship)
    assert told["q"] == pytest.approx(slope, rel=1e-6)
    assert (told["tau_th"], told["t_th"]) == (slow.pitch.lag_s, slow.pitch.delay_s)


def test_stepped_ship_follows_a_small_sine_of_the_pitch_as_worked_out(ship, tug, moved):
    frequency, amplitude_v = 0.4, 0.05
    campaign = moved(frequency, amplitude_v)
    signals = simulate_signals(ship, campaign, tug=tug)
    inside = (signals.time_s >= 30.0) & (signals.time_s < 30.0 + 4.0 / frequency - 1e-9)
    turn = np.exp(-2j * np.pi * frequency * signals.time_s[inside])
    asked = -1j * amplitude_v * RATIO_PER_V / PITCH_RATIO
    values = (signals.engine_speed_rev_s / 10.0, signals.shaft_torque_nm / TORQUE_NM)
    found = np.array([2.0 * np.mean(value[inside] * turn) for value in values]) / asked
    slope = normalised_truth(tug, ship)["q"]
    assert found == pytest.approx(closed_form(tug, frequency, slope)[:2], rel=3e-3)


def motion_of(ship, tug, campaign, *, seconds):
    step_s = 0.001
    return PitchActuator(tug, ship, campaign, start_s=0.0, step_s=step_s).next(round(seconds / step_s)), 0.5 * step_s


def test_pumps_and_play_limit_the_blades(ship, tug, moved):
    """A large fast sine: the piston moves with the highest rate and no faster, the blades half the play behind it."""
    actuation = PitchActuation(lag_s=0.2, delay_s=0.0, rate_per_s=0.05, play=0.01)
    motion, step_s = motion_of(ship, replace(tug, pitch=actuation), moved(0.5, 2.0), seconds=20.0)
    rate = np.diff(motion.piston) / step_s
    assert np.abs(rate).max() == pytest.approx(0.05, rel=1e-9)
    behind = motion.piston - motion.blades
    assert np.abs(behind).max() == pytest.approx(0.005, rel=1e-9)


def test_a_servo_with_a_deadband_does_not_answer_what_lies_within_it(ship, tug, moved):
    within = PitchActuation(deadband=0.02)
    motion, _ = motion_of(ship, replace(tug, pitch=within), moved(0.2, 0.1), seconds=20.0)
    assert np.all(motion.piston == 0.0)


def test_pitch_that_stands_changes_nothing(ship, tug, ask, sine):
    """Bit for bit: a ship whose pitch is not moved is the same ship with a fixed propeller."""
    campaign = ask(40.0, sines=[sine(0.5, 0.2)])
    with_pitch, fixed = (simulate_signals(ship, campaign, tug=one) for one in (tug, replace(tug, pitch=None)))
    assert np.array_equal(with_pitch.shaft_torque_nm, fixed.shaft_torque_nm)
    assert np.array_equal(with_pitch.engine_speed_rev_s, fixed.engine_speed_rev_s)


def test_a_ship_that_cannot_move_its_pitch_says_so(ship, tug, moved):
    with pytest.raises(SettingsError, match=r"a vessel with a table \[pitch\].* found a tug of fixed pitch"):
        simulate_signals(ship, moved(0.2, 0.1), tug=replace(tug, pitch=None))
    with pytest.raises(SettingsError, match=r"a vessel with \[sensors.pitch_set_point\] where the pitch is moved"):
        simulate_signals(load_vessel("stan-tug-1205"), moved(0.2, 0.1), tug=tug)
    with pytest.raises(SettingsError, match=r"pitch.rate_per_s above 0, found 0"):
        simulate_signals(ship, moved(0.2, 0.1), tug=replace(tug, pitch=PitchActuation(rate_per_s=0.0)))


@pytest.fixture(scope="module")
def combined():
    return load_vessel("nifs-research-vessel-combinator")


def test_with_a_combinator_the_lever_moves_the_pitch_along_its_curve(combined, quiet, ask):
    """From 600 to 760 rpm it asks for P/D 0.80 and then 0.936, past the corner of the curve at 700 rpm."""
    tug = replace(like_stan_tug_1205(combined), noise=quiet)
    volts = 160.0 / tug.set_point_slope_rpm_per_v
    stairs = {"name": "St", "levels_v": [-5.0, -5.0 + volts], "dwell_s": 30.0, "start_s": 10.0}
    motion, step_s = motion_of(combined, tug, ask(80.0, staircases=[stairs]), seconds=70.0)
    piston = combined.propeller.pitch_ratio + motion.piston
    assert piston[round(39.0 / step_s)] == pytest.approx(0.80, abs=1e-9)
    # a lag of 0.6 s after a delay of 0.15 s, limited at 0.08 a second as long as it is further than 0.048 away
    assert piston[round(40.5 / step_s)] == pytest.approx(0.80 + 0.08 * 0.35, abs=2e-4)
    assert piston[round(69.0 / step_s)] == pytest.approx(0.936, abs=1e-6)


def test_small_signals_of_a_lever_are_those_of_speed_and_pitch_together(ship, combined, quiet):
    """At 600 rpm the combinator asks for 0.75 per cent of pitch with a per cent of speed."""
    tug = replace(like_stan_tug_1205(combined), noise=quiet)
    frequency = np.geomspace(0.1, 10.0, 40) / (2.0 * np.pi)
    outputs = ("n", "M_s", "theta")
    by_speed, by_pitch = (
        linearised_response(tug, ship, frequency, outputs=outputs, input=name) for name in ("n_set", "theta_set")
    )
    by_lever = linearised_response(tug, combined, frequency, outputs=outputs)
    np.testing.assert_allclose(by_lever, by_speed + 0.75 * by_pitch, rtol=1e-9)
    assert normalised_truth(tug, combined)["c_comb"] == pytest.approx(0.75)
