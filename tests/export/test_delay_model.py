"""State space with exact delays: against transfer functions written out by hand, and against the structures."""

import numpy as np
import pytest

from shaftprint.catalogue import STRUCTURES, limited, structure
from shaftprint.errors import ExportError
from shaftprint.export.linear._delay_model import delay_model
from shaftprint.export.linear._past_rates import without_past_rates
from shaftprint.models import Parameter, Structure, TorqueBalance
from shaftprint.models._program import program_of
from shaftprint.models.equations._calculus import postorder

OMEGA = np.geomspace(0.05, 50.0, 61)
S = 1j * OMEGA
SENSORS = {"T_average": 0.05, "T_hold": 0.02, "t_pickup": 0.04, "T_filter": 0.03, "t_gauge": 0.004}


def test_gauge_closed_is_the_loop_of_two_free_bodies(exported):
    p = {"K_p": 4.6, "K_i": 3.8, "t_d": 0.0731, "omega_n": 11.0, "zeta": 0.35, "tau_dn": 0.32, "tau_up": 1.01}
    p |= {"k_q": 2.05, "g": -0.1, "t_sp": 0.0417, "c_set": 0.99, "t_gauge": -0.011}
    found = delay_model(exported(structure("GAUGE-CLOSED"), p)).response(S)
    lag = p["omega_n"] ** 2 / (S**2 + 2 * p["zeta"] * p["omega_n"] * S + p["omega_n"] ** 2)
    governor = p["K_p"] + p["K_i"] / S
    body = (p["tau_up"] + p["tau_dn"]) * S + p["k_q"] - p["g"]
    loop = governor * np.exp(-S * p["t_d"]) * lag / body
    speed = p["c_set"] * np.exp(-S * p["t_sp"]) * loop / (1 + loop)
    torque = (p["tau_dn"] * S + p["k_q"]) * speed * np.exp(-S * p["t_gauge"])
    np.testing.assert_allclose(found[:, 0], [speed, torque], rtol=1e-12)


def test_a_delay_in_the_loop_is_inside_and_one_behind_it_outside(exported):
    linear = delay_model(exported(structure("GAUGE-CLOSED"), {"t_d": 0.08, "t_sp": 0.05, "t_gauge": -0.06}))
    np.testing.assert_allclose(linear.tau_s, [0.08])
    np.testing.assert_allclose(linear.shift_s, [0.05, -0.01], rtol=1e-12)
    assert linear.a.shape == (4, 4)
    assert linear.b.shape == (4, 2)
    assert linear.d.shape == (3, 2)


def test_a_delay_of_nothing_needs_no_channel(exported):
    linear = delay_model(exported(structure("CL4"), {"t_d": 0.0}))
    same = delay_model(exported(structure("CL3")))
    assert linear.tau_s.size == 0
    np.testing.assert_allclose(linear.response(S), same.response(S), rtol=1e-12)


@pytest.mark.parametrize("name", STRUCTURES)
def test_every_structure_keeps_its_response(exported, name):
    chosen = structure(name)
    model = exported(chosen)
    expected = chosen.response(model.values, S).reshape(len(chosen.outputs), len(chosen.inputs), -1)
    np.testing.assert_allclose(delay_model(model).response(S), expected, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("name", ["GAUGE-CLOSED", "GAUGE-CORE", "ENGINE", "FREE-PITCH"])
def test_windows_of_the_sensors_are_means_over_the_past(exported, name):
    chosen = structure(name)
    model = exported(chosen, {n: value for n, value in SENSORS.items() if n in chosen.names})
    expected = chosen.response(model.values, S).reshape(len(chosen.outputs), len(chosen.inputs), -1)
    np.testing.assert_allclose(delay_model(model).response(S), expected, rtol=1e-8)


def test_a_rate_limit_leaves_the_hold_of_its_computer(exported):
    chosen = limited("torque", "rate", period_s=0.04)
    model, plain = exported(chosen), limited("torque")
    np.testing.assert_allclose(delay_model(model).response(S)[:, 0], chosen.response(model.values, S), rtol=1e-9)
    held = structure("GAUGE-CLOSED").response(structure("GAUGE-CLOSED").vector({}), S)
    without = delay_model(exported(plain)).response(S)[:, 0]
    np.testing.assert_allclose(without, held, rtol=1e-9)
    assert np.abs(delay_model(model).response(S)[:, 0] / held - 1.0).max() > 0.01


def test_the_change_of_a_late_signal_is_a_late_signal():
    program = program_of(structure("FREE-PITCH"), ["T_average", "T_hold", "t_pickup", "T_filter"])
    prompt = without_past_rates(program)

    def kinds(of):
        return {node.operation for node in postorder([*of.rates, *of.signals, *(late.signal for late in of.pasts)])}

    assert "past rate" in kinds(program)
    assert "past rate" not in kinds(prompt)
    assert len(prompt.pasts) == len(program.pasts) + 1


def test_the_change_of_an_input_is_refused(exported):
    tau, slope = Parameter("tau", "s", 0.0, 1.0, 0.3, "inertia time"), Parameter("k", "-", 0.0, 3.0, 2.0, "slope")
    improper = Structure(name="RISING", title="rising", input="n", outputs={"M_s": TorqueBalance(tau, slope)})
    with pytest.raises(ExportError, match=r"how fast the input n changes.*put a lag behind it"):
        delay_model(exported(improper))


def test_a_time_constant_of_zero_that_is_free_is_refused(exported):
    chosen = structure("CL4")
    with pytest.raises(ExportError, match="division by zero; hold a time constant"):
        delay_model(exported(chosen.free_between(tau_n=(0.0, 1.0)), {"tau_n": 0.0}))
