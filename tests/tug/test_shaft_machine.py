"""An electric machine on the gearbox of a simulated ship: its torque by hand, its small signals, what it refuses."""

from dataclasses import replace

import numpy as np
import pytest
from tests.tug.ideal_signals import simulate_signals
from tests.tug.linearised import linearised_response

from shaftprint.errors import SettingsError
from shaftprint.tug import Tug, build_plant, like_stan_tug_1205, normalised_truth
from shaftprint.tug._shaft_machine import ShaftMachineTruth
from shaftprint.vessel import load_vessel

SPEED_RPM, TORQUE_NM, RATIO, EFFICIENCY = 1200.0, 31236.0, 6.8, 0.95


@pytest.fixture(scope="module")
def hybrid():
    return load_vessel("foss-carolyn-dorothy")


@pytest.fixture
def tug(hybrid, quiet):
    return replace(like_stan_tug_1205(hybrid), noise=quiet)


def with_share(tug, share):
    return replace(tug, shaft_machine=replace(tug.shaft_machine, share=share))


@pytest.mark.parametrize("share", [0.35, -0.2, 0.0])
def test_engine_gives_what_the_machine_leaves(hybrid, tug, share):
    plant = build_plant(with_share(tug, share), hybrid)
    rack = normalised_truth(with_share(tug, share), hybrid)["X_0"]
    assert plant.machine_nm == pytest.approx(share * TORQUE_NM)
    # rack 1 is rated torque at rated speed, and the engine is flat
    rated_nm = 1342e3 / (2.0 * np.pi * 1800.0 / 60.0)
    assert rack * rated_nm == pytest.approx((1.0 - share) * TORQUE_NM / RATIO / EFFICIENCY)


def closed_form(tug, frequency_hz):
    """Hand-derived: torque of the machine beside a loop whose engine gives the rest."""
    s = 2j * np.pi * frequency_hz
    given = 1.0 - tug.shaft_machine.share
    # 13 + 2.5 and the rotor's 9 kg m2 at the engine, 60 at the shaft; 799 kg m2 behind the gauge
    seconds = 2.0 * np.pi * SPEED_RPM / 60.0 / RATIO / TORQUE_NM
    up, down = seconds * ((13.0 + 2.5 + 9.0) * RATIO**2 + 60.0), seconds * 799.0
    omega, zeta = tug.natural_frequency_rad_s, tug.damping_ratio
    fuel = np.exp(-s * tug.governor_delay_s) * omega**2 / (s**2 + 2.0 * zeta * omega * s + omega**2)
    line = (up + down) * s + 2.0 - given * tug.g
    loop = given * (tug.proportional_gain + tug.integral_gain_per_s / s) * fuel / line
    speed = {
        "n_set": loop / (1.0 + loop) * np.exp(-s * tug.set_point_latency_s),
        "M_m": 1.0 / line / (1.0 + loop) / tug.shaft_machine.shown,
    }
    return {name: np.array([value, (down * s + 2.0) * value]) for name, value in speed.items()}


@pytest.mark.parametrize(("share", "shown"), [(0.35, 1.0), (-0.3, 0.97), (0.0, 1.04)])
@pytest.mark.parametrize("moved", ["n_set", "M_m"])
def test_small_signals_are_those_worked_out_by_hand(hybrid, tug, share, shown, moved):
    machine = ShaftMachineTruth(share=share, shown=shown)
    tug = replace(tug, shaft_machine=machine, g=-0.2)
    frequency = np.geomspace(0.1, 10.0, 30) / (2.0 * np.pi)
    found = linearised_response(tug, hybrid, frequency, input=moved)[:, 0]
    ratio = found / closed_form(tug, frequency)[moved]
    assert np.abs(ratio) == pytest.approx(np.ones(ratio.shape), abs=1e-8)
    assert np.degrees(np.angle(ratio)) == pytest.approx(np.zeros(ratio.shape), abs=1e-6)


def test_stepped_line_follows_a_small_sine_of_the_machine(hybrid, tug, ask):
    frequency, amplitude_v = 0.5, 0.05
    sine = {
        "name": "T",
        "input": "machine_torque",
        "frequency_hz": frequency,
        "amplitude_v": amplitude_v,
        "start_s": 1.0,
        "settled_s": 20.0,
        "stop_s": 24.01,
    }
    campaign = ask(25.0, sines=[sine], further_offsets_v={"machine_torque": 1.692})
    signals = simulate_signals(hybrid, campaign, tug=tug)
    inside = (signals.time_s >= 20.0) & (signals.time_s < 24.0)
    turn = np.exp(-2j * np.pi * frequency * signals.time_s[inside])
    speed, torque = signals.engine_speed_rev_s[inside] / 20.0, signals.shaft_torque_nm[inside] / TORQUE_NM
    measured = np.array([2.0 * np.mean(values * turn) for values in (speed, torque)])
    s, machine = 2j * np.pi * frequency, tug.shaft_machine
    asked = amplitude_v * 1000.0 * RATIO * EFFICIENCY / TORQUE_NM
    reached = asked * np.exp(-s * machine.delay_s) / (machine.torque_time_s * s + 1.0)
    # a sine that begins at 1 s: half a turn of its phase at 0.5 Hz, and a quarter from cosine to sine
    sine_of_time = -1j * np.exp(-2j * np.pi * frequency * 1.0)
    expected = closed_form(tug, frequency)["M_m"] * reached * sine_of_time
    assert measured / expected == pytest.approx(np.ones(2), abs=2e-3)


def test_machine_without_a_vessel_that_has_one_is_refused(vessel):
    with pytest.raises(SettingsError, match="expected a shaft_machine"):
        build_plant(Tug(shaft_machine=ShaftMachineTruth(share=0.1)), vessel)


def test_share_of_all_the_torque_is_refused(hybrid, tug):
    with pytest.raises(SettingsError, match="from -1 to below 1"):
        build_plant(with_share(tug, 1.0), hybrid)
