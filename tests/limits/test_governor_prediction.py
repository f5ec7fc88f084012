"""The limited governor on a measured speed, against the simulated tug, which shares no equation with it."""

import numpy as np
import pytest
from tests.tug.ideal_signals import simulate_signals

from shaftprint.campaign import load_campaign
from shaftprint.catalogue import AHEAD_S, limited_governor
from shaftprint.simulation import simulate
from shaftprint.tug import Tug

RATE = 200.0
TRUE = {"K_p": 5.7, "K_i": 4.27, "t_d": 0.0703, "omega_n": 10.3, "zeta": 0.47, "t_sp": 0.0518}


@pytest.fixture(scope="module")
def sailed(vessel):
    """Sines S6 to S8 of the short campaign without noise, the rack limited to 0.6 of its travel a second."""
    tug = Tug(rack_rate_limit_per_s=0.6, motoring_torque_nm=5000.0)
    ideal = simulate_signals(vessel, load_campaign("short"), tug=tug, rate_hz=RATE, start_s=635.0, stop_s=774.0)
    speed_0, torque_0 = vessel.working_point.engine_speed_rpm / 60.0, vessel.working_point.shaft_torque_nm
    brake_0 = torque_0 / (vessel.gearbox.ratio * vessel.gearbox.efficiency)
    return {
        "time": ideal.time_s - ideal.time_s[0],
        "n_set": ideal.set_point_rev_s / speed_0 - 1.0,
        "n": ideal.engine_speed_rev_s / speed_0 - 1.0,
        "M_b": ideal.brake_torque_nm / brake_0 - 1.0,
        "limited": ideal.limited,
    }


def predicted(sailed, **values):
    governor = limited_governor("torque", "rate", "deadband", "ramp", "smoke")
    idle = {"m_max": 60.0, "m_min": -60.0, "r_s": 1e5, "d_e": 1e-12, "a_0": 1.0, "g": 1e-12}
    time = sailed["time"]
    early = {name: np.interp(time + AHEAD_S, time, sailed[name]) for name in ("n", "M_b")}
    inputs = {"n_set": sailed["n_set"], **early, "c": np.zeros(time.size)}
    return simulate(governor, governor.vector(TRUE | idle | values), time, inputs, longest_step_s=5e-4).outputs["y"]


@pytest.mark.slow
def test_torque_of_a_limited_rack_is_that_of_the_tug(sailed):
    rack_0 = 0.39706613784717726
    y = (1.0 + sailed["M_b"]) / (1.0 + sailed["n"]) ** 2 - 1.0
    # S7 and S8: by then the observer has forgotten how the first sine began
    inside = (sailed["time"] > 50.0) & (sailed["time"] < 138.0)
    assert sailed["limited"].mean() > 0.2
    error = (predicted(sailed, r_x=0.6 / rack_0) - y)[inside]
    assert np.sqrt(np.mean(error**2)) < 0.01 * np.std(y[inside])
    # without its limit the governor asks for something else
    free = (predicted(sailed, r_x=1e5) - y)[inside]
    assert np.sqrt(np.mean(free**2)) > 0.1 * np.std(y[inside])


def test_small_signals_from_each_input():
    """``s I = K_i e + w (M_b - D F X)`` and ``y = D F X - 2 n``, solved by hand."""
    governor = limited_governor("rate")
    s = 2j * np.pi * np.array([0.05, 0.4, 1.5])
    values = governor.vector({**TRUE, "r_x": 10.0, "g": 0.0})
    by_channel = dict(zip(governor.channels, governor.response(values, s), strict=True))
    actuation = np.exp(-s * TRUE["t_d"]) * 10.3**2 / (s**2 + 2.0 * 0.47 * 10.3 * s + 10.3**2)
    observer = 0.1
    from_error = actuation * (5.7 * s + 4.27) / (s + observer * actuation)
    early = np.exp(-s * AHEAD_S)
    np.testing.assert_allclose(by_channel["y", "n_set"], from_error * np.exp(-s * TRUE["t_sp"]), rtol=1e-9)
    np.testing.assert_allclose(by_channel["y", "n"], (-from_error - 2.0) * early, rtol=1e-9)
    from_torque = actuation * observer / (s + observer * actuation)
    np.testing.assert_allclose(by_channel["y", "M_b"], from_torque * early, rtol=1e-9)
