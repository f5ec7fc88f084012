"""Limits of governor and engine in time, against closed forms worked out by hand."""

import numpy as np
import pytest

from shaftprint.catalogue import limited
from shaftprint.errors import StructureError
from shaftprint.models import (
    Diagram,
    Parameter,
    Structure,
    boosted,
    clip,
    deadband,
    firing_delay,
    first_order_lag,
    full_load,
    limited_pi,
    maximum,
    quadratic_propeller,
    rate_limited,
    second_order_lag,
    table,
)
from shaftprint.simulation import simulate

TIME = np.arange(0.0, 6.0, 0.005)
GAIN = Parameter("k", "-", 0.0, 50.0, 1.0, "number")
SHIP = {
    "tau_up": 1.016,
    "tau_dn": 0.32,
    "K_p": 5.7,
    "K_i": 4.27,
    "omega_n": 10.3,
    "zeta": 0.47,
    "t_d": 0.0703,
    "k_q": 2.0,
}


def response(equations, u, values=(1.0,), *, time=TIME, parameters=(GAIN,)):
    """Return what equations of one output make of an input."""
    diagram = Diagram("part", "u", ("y",), equations, parameters)
    model = Structure(name="part", title="part", input="u", outputs={"y": diagram.port("y")})
    return simulate(model, values, time, {"u": u}).outputs["y"]


def test_deadband_takes_its_half_width_off():
    u = np.array([-0.01, -0.004, 0.0, 0.003, 0.02])
    found = response(lambda flow, u, p: {"y": deadband(u, 0.004 * p.k)}, u, time=np.arange(5.0))
    np.testing.assert_allclose(found, [-0.006, 0.0, 0.0, 0.0, 0.016], atol=1e-15)


def test_deadband_of_nothing_is_the_error_itself():
    found = response(lambda flow, u, p: {"y": deadband(u, 0.0)}, np.array([0.1, -0.2]), time=np.arange(2.0))
    np.testing.assert_allclose(found, [0.1, -0.2])


def test_rate_limit_turns_a_step_into_a_ramp():
    u = np.where(TIME >= 1.0, 1.0, 0.0)
    found = response(lambda flow, u, p: {"y": rate_limited(flow, u, p.k)}, u, (2.0,))
    # the set point itself takes one sample to rise
    expected = np.clip(2.0 * (TIME - 0.995), 0.0, 1.0)
    np.testing.assert_allclose(found, expected, atol=2.0 * 0.005 + 1e-12)
    assert np.diff(found).max() == pytest.approx(2.0 * 0.005)


def test_a_computer_moves_its_rack_once_a_period():
    u = np.where(TIME >= 1.0, 1.0, 0.0)
    found = response(lambda flow, u, p: {"y": rate_limited(flow, u, p.k, period_s=0.1)}, u, (2.0,))
    jumps = np.diff(found)
    moved = np.flatnonzero(jumps)
    np.testing.assert_allclose(jumps[moved], 0.2, atol=1e-12)
    np.testing.assert_allclose(np.diff(TIME[moved]), 0.1, atol=1e-9)
    assert moved.size == 5


def test_a_period_that_fits_no_step_is_refused():
    with pytest.raises(StructureError, match="computer's period in a whole number of time steps"):
        response(lambda flow, u, p: {"y": rate_limited(flow, u, p.k, period_s=0.0123456789)}, np.zeros_like(TIME))


def test_integrator_is_led_back_while_the_output_is_limited():
    def governor(flow, u, p):
        given = limited_pi(flow, u, proportional=2.0, integral=4.0, lowest=-1.0, highest=0.5 * p.k, anti_windup_s=0.25)
        return {"y": given.wanted}

    found = response(governor, np.where(TIME >= 0.5, 1.0, 0.0))
    # X - X_max goes to K_i e T_aw = 1 and no further, from K_p e - X_max = 1.5 with the time constant T_aw
    late = TIME >= 0.5
    expected = 0.5 + 1.0 + 0.5 * np.exp(-(TIME[late] - 0.5) / 0.25)
    np.testing.assert_allclose(found[late], expected, atol=2e-2)
    assert found[-1] == pytest.approx(1.5, abs=1e-6)


@pytest.mark.parametrize(("speed", "torque"), [(0.2, 0.44), (-0.3, -0.51), (-1.5, -1.25), (0.0, 0.0)])
def test_propeller_torque_goes_with_the_square_also_astern(speed, torque):
    found = response(lambda flow, u, p: {"y": quadratic_propeller(u, 2.0)}, np.full(2, speed), time=np.arange(2.0))
    np.testing.assert_allclose(found, torque, atol=1e-15)


def test_full_load_curve_of_the_reference_engine():
    # 1325, 1289 and 1172 N m at 1227, 1636 and 1800 rpm, over 465.54 N m at 1183.8 rpm
    curve = tuple((rpm / 1183.8 - 1.0, torque / 1325.0) for rpm, torque in ((1227, 1325), (1636, 1289), (1800, 1172)))
    speed = np.array([0.1, 1636 / 1183.8 - 1.0, 1718 / 1183.8 - 1.0, 0.9])
    found = response(lambda flow, u, p: {"y": full_load(u, 1325.0 / 465.54, curve)}, speed, time=np.arange(4.0))
    at_110 = 1325.0 + (1289.0 - 1325.0) * (1.1 * 1183.8 - 1227.0) / (1636.0 - 1227.0)
    np.testing.assert_allclose(465.54 * (1.0 + found), [at_110, 1289.0, 1230.5, 1172.0], atol=0.3)


def test_smoke_limit_opens_with_the_boost():
    a, lag_s, m_max = 0.5, 0.8, 2.5

    def engine(flow, u, p):
        burnt = flow.unknown()
        air = boosted(flow, burnt, m_max * p.k - 1.0, at_rest=m_max, unboosted=a, lag_s=lag_s)
        return {"y": flow.close(burnt, clip(u, -1.0, air), "engine")}

    u = np.where(TIME >= 1.0, 3.0, 0.0)
    found = response(engine, u)
    # boost is 1 / m_max at rest; at the limit 1 - b falls as exp(-a t / tau_tc)
    after = TIME >= 1.0
    missing = (1.0 - 1.0 / m_max) * np.exp(-a * (TIME[after] - 1.0) / lag_s)
    np.testing.assert_allclose(1.0 + found[after], m_max * (1.0 - (1.0 - a) * missing), atol=6e-3)
    assert 1.0 + found[after][0] == pytest.approx(1.75, abs=6e-3)


def test_firing_delay_falls_with_the_speed():
    found = response(
        lambda flow, u, p: {"y": firing_delay(u, 6, 1183.8 / 60.0)}, np.array([0.0, 0.5]), time=np.arange(2.0)
    )
    # half of 16.9 ms and a quarter of 50.7 ms
    np.testing.assert_allclose(found, [0.02112, 0.01408], atol=2e-5)


def test_lags_by_hand():
    u = np.where(TIME >= 1.0, 1.0, 0.0)
    first = response(lambda flow, u, p: {"y": first_order_lag(flow, u, 0.3 * p.k)}, u)
    second = response(lambda flow, u, p: {"y": second_order_lag(flow, u, 5.0 * p.k, 1.0)}, u)
    t = np.maximum(TIME - 0.9975, 0.0)
    np.testing.assert_allclose(first, 1.0 - np.exp(-t / 0.3), atol=1e-2)
    np.testing.assert_allclose(second, 1.0 - (1.0 + 5.0 * t) * np.exp(-5.0 * t), atol=1e-4)


def test_a_limited_engine_accelerates_the_line_by_the_tanh_law():
    # tau dn/dt = m - (1 + n)^2 while the engine gives its limit m
    ship = limited("torque")
    values = ship.vector(SHIP | {"m_max": 2.25, "omega_n": 60.0, "zeta": 1.0})
    found = simulate(ship, values, TIME, {"n_set": np.where(TIME >= 0.5, 0.6, 0.0)}).outputs["n"]
    part = (TIME >= 1.2) & (TIME <= 1.45)
    begun = TIME[part] - TIME[part][0]
    speed = 1.5 * np.tanh(1.5 * begun / 1.336 + np.arctanh((1.0 + found[part][0]) / 1.5))
    np.testing.assert_allclose(1.0 + found[part], speed, atol=1e-6)


@pytest.mark.parametrize(
    ("limits", "worst"), [((), 1e-4), (("torque",), 1e-4), (("torque", "rate"), 1e-3), (("torque", "smoke"), 1e-4)]
)
def test_halving_the_step_changes_nothing_that_matters(limits, worst):
    ship = limited(*limits)
    levels = {"m_max": 2.2, "m_min": -0.3, "T_aw": 0.4, "r_x": 6.0, "a_0": 0.5, "tau_tc": 0.8}
    values = ship.vector(SHIP | {name: value for name, value in levels.items() if name in ship.names})
    rise = np.clip((TIME - 0.5) / 0.2, 0.0, 1.0) - np.clip((TIME - 3.0) / 0.2, 0.0, 1.0)
    whole, half = (simulate(ship, values, TIME, {"n_set": 0.42 * rise}, longest_step_s=step) for step in (5e-3, 2.5e-3))
    for output in ("n", "M_s"):
        assert np.abs(whole.outputs[output] - half.outputs[output]).max() < worst


def test_equations_that_compare_are_told_what_to_use():
    with pytest.raises(StructureError, match="use minimum, maximum, clip or choose"):
        response(lambda flow, u, p: {"y": u if u > 0.0 else -u}, np.zeros_like(TIME))


def test_outputs_that_are_missing_are_named():
    with pytest.raises(StructureError, match="expected equations of y, found z"):
        response(lambda flow, u, p: {"z": u}, np.zeros_like(TIME))


def test_a_state_without_rate_is_named():
    with pytest.raises(StructureError, match="no rate is given for the state speed"):
        response(lambda flow, u, p: {"y": flow.state("speed")}, np.zeros_like(TIME))


def test_an_algebraic_loop_that_is_not_linear_is_refused():
    def equations(flow, u, p):
        y = flow.unknown()
        return {"y": flow.close(y, u - p.k * y * y, "square")}

    with pytest.raises(StructureError, match=r"square: an algebraic loop \(no delay, no state\) is not linear"):
        response(equations, np.zeros_like(TIME))


def test_an_algebraic_loop_that_is_linear_is_solved():
    def equations(flow, u, p):
        y = flow.unknown()
        return {"y": flow.close(y, u - 3.0 * p.k * y, "loop")}

    np.testing.assert_allclose(response(equations, np.ones_like(TIME)), 0.25)


def test_tables_ascend():
    with pytest.raises(StructureError, match="ascending points"):
        response(lambda flow, u, p: {"y": table(u, ((0.0, 1.0), (0.0, 2.0)))}, np.zeros_like(TIME))


def test_quantities_and_numbers_only():
    with pytest.raises(StructureError, match="expected a formula or a number"):
        response(lambda flow, u, p: {"y": maximum(u, "0.5")}, np.zeros_like(TIME))


def test_an_unknown_limit_is_named():
    with pytest.raises(StructureError, match="there is no limit 'torqe'"):
        limited("torqe")


def test_smoke_needs_a_torque_limit():
    with pytest.raises(StructureError, match="smoke limit needs the torque limit"):
        limited("smoke")
