"""Jumps through exact delays against the polynomials that the method of steps gives by hand."""

from math import factorial

import numpy as np
import pytest

from shaftprint.errors import StructureError
from shaftprint.models import Delay, Gain, Integrator, Parameter, Sensitivity, Structure, limited, structure
from shaftprint.simulation import simulate, simulate_exactly

K = Parameter("k", "1/s", 0.0, 5.0, 1.0, "gain")
INSIDE = Parameter("d_in", "s", 0.0, 3.0, 0.3, "delay inside the loop")
OUTSIDE = Parameter("d_out", "s", 0.0, 3.0, 0.1, "delay before the loop")
ONE = Parameter("one", "-", 0.0, 2.0, 1.0, "one", held=True)
TIME = np.arange(0.0, 6.0, 0.01)


def delayed_feedback():
    """Return ``dx/dt = u(t - d_out) - k x(t - d_in)``."""
    integrator = Integrator()
    loop = integrator * Gain(K) * Delay(INSIDE)
    expression = Delay(OUTSIDE) * (integrator * Sensitivity(loop)) * Gain(ONE)
    return Structure(name="late", title="delayed feedback", input="u", outputs={"x": expression})


def by_hand(time, k, inside):
    """Return ``x`` after a step of 1 at zero: ``sum (-k)^j (t - j d)^(j + 1) / (j + 1)!`` by the method of steps."""
    if inside == 0.0:
        return np.where(time > 0.0, (1.0 - np.exp(-k * time)) / k, 0.0)
    found = np.zeros_like(time)
    for j in range(int(time[-1] / inside) + 1):
        found += (-k) ** j * np.maximum(time - j * inside, 0.0) ** (j + 1) / factorial(j + 1)
    return found


@pytest.mark.parametrize("inside", [0.0, 0.0703, 0.1234567, 0.31, 0.5, 0.77777, 1.3, 1.9999])
@pytest.mark.parametrize("outside", [0.0, 0.1234567, 0.25])
def test_step_through_delays_is_that_of_the_method_of_steps(inside, outside):
    k = min(1.5, 1.2 / max(inside, 0.1))
    model = delayed_feedback()
    held = {name: 0.0 for name, value in (("d_in", inside), ("d_out", outside)) if value == 0.0}
    model = model.held_at(**held)
    values = model.vector({"k": k, "d_in": inside, "d_out": outside})
    found = simulate_exactly(model, values, TIME, {"u": np.where(TIME >= 1.0, 1.0, 0.0)}, hold=True)
    np.testing.assert_allclose(found.outputs["x"], by_hand(TIME - 1.0 - outside, k, inside), atol=1e-8)


def test_a_delay_shorter_than_the_step_is_exact_too():
    model = delayed_feedback().held_at(d_out=0.0)
    time = np.arange(0.0, 0.2, 0.01)
    values = model.vector({"k": 5.0, "d_in": 0.0013, "d_out": 0.0})
    found = simulate_exactly(model, values, time, {"u": np.where(time >= 0.05, 1.0, 0.0)}, hold=True)
    np.testing.assert_allclose(found.outputs["x"], by_hand(time - 0.05, 5.0, 0.0013), atol=1e-10)


def test_halving_the_step_of_the_thesis_loop_changes_nothing_that_matters():
    model = structure("CL4")
    values = model.vector({"tau_n": 0.39, "K_p": 1.8, "K_i": 4.3, "t_d": 0.1037, "omega_n": 9.0, "zeta": 1.2})
    inputs = {"n_set": np.where(TIME >= 0.5, 0.1, 0.0)}
    coarse = simulate_exactly(model, values, TIME, inputs, hold=True, longest_step_s=5e-3)
    fine = simulate_exactly(model, values, TIME, inputs, hold=True, longest_step_s=1e-3)
    for output in ("n", "M_s"):
        assert np.abs(coarse.outputs[output] - fine.outputs[output]).max() < 1e-8


def test_both_sides_of_a_jump_are_kept():
    # torque of a PI governor jumps by K_p times the step, exactly at the delay
    model = structure("OL3")
    values = model.vector({"K_p": 2.0, "K_i": 1.0, "t_d": 0.1})
    found = simulate_exactly(model, values, TIME, {"e": np.where(TIME >= 1.0, 1.0, 0.0)}, hold=True)
    at = np.searchsorted(TIME, 1.1 - 1e-9)
    assert found.outputs["M_s"][at - 1] == 0.0
    assert found.outputs["M_s"][at] == pytest.approx(2.0, abs=1e-9)
    assert found.outputs["M_s"][at + 10] == pytest.approx(2.1, abs=1e-9)


def test_straight_inputs_agree_with_the_fast_way():
    model = structure("CL4")
    values = model.vector({"tau_n": 0.39, "K_p": 1.8, "K_i": 4.3, "t_d": 0.1037, "omega_n": 9.0, "zeta": 1.2})
    inputs = {"n_set": 0.1 * np.sin(2.0 * TIME)}
    slow = simulate_exactly(model, values, TIME, inputs)
    fast = simulate(model, values, TIME, inputs)
    assert np.abs(slow.outputs["n"] - fast.outputs["n"]).max() < 1e-6


def test_computers_are_refused():
    ship = limited("rate")
    with pytest.raises(StructureError, match="constant delays and no computer's period"):
        simulate_exactly(ship, ship.vector({}), TIME, {"n_set": np.zeros_like(TIME)})
