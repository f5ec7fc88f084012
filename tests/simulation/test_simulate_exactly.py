"""Jumps through exact delays against the polynomials that the method of steps gives by hand."""

from math import factorial

import numpy as np
import pytest

from shaftprint.catalogue import limited, structure
from shaftprint.errors import StructureError
from shaftprint.models import Delay, FirstOrderLag, Gain, Integrator, Parameter, Sensitivity, Structure
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


def test_jumps_that_arrive_by_two_ways_at_once_are_one():
    early, later, both = (
        Parameter(name, "s", 0.0, 3.0, value, "delay") for name, value in (("a", 0.1), ("b", 0.2), ("c", 0.3))
    )
    # 0.1 + 0.2 and 0.3 differ by rounding
    twice = Gain(ONE) * Delay(early) * Delay(later)
    lagging = FirstOrderLag(Parameter("T", "s", 0.0, 3.0, 0.2, "lag"))
    model = Structure(
        name="two ways",
        title="two ways",
        input="u",
        outputs={"y": twice - Gain(ONE) * Delay(both) + lagging * Delay(early) * Delay(later)},
    )
    step = {"u": np.where(TIME >= 1.0, 1.0, 0.0)}
    for start in (0.0, 1e5):
        found = simulate_exactly(model, model.vector({}), TIME + start, step, hold=True)
        late = np.maximum(TIME - 1.3, 0.0)
        np.testing.assert_allclose(found.outputs["y"], 1.0 - np.exp(-late / 0.2), atol=1e-8)


@pytest.mark.parametrize("late_s", [-0.0237, 0.0237])
def test_outputs_that_are_early_or_late_are_those_of_the_lag(late_s):
    late = Parameter("t", "s", -1.0, 1.0, late_s, "error of a latency")
    lag = FirstOrderLag(Parameter("T", "s", 0.0, 3.0, 0.2, "lag"))
    model = Structure(name="lag", title="lag", input="u", outputs={"y": lag * Delay(late)})
    found = simulate_exactly(model, model.vector({}), TIME, {"u": np.where(TIME >= 1.0, 3.0, 2.0)}, hold=True)
    since = np.maximum(TIME - late_s - 1.0, 0.0)
    np.testing.assert_allclose(found.outputs["y"], 3.0 - np.exp(-since / 0.2), atol=1e-8)


def test_a_long_wave_of_corners_through_unequal_delays():
    model = structure("GAUGE-CLOSED").held_at(T_average=0.0507, t_pickup=0.0531, T_hold=0.0113, T_filter=0.02)
    values = model.vector({"t_d": 0.1037, "t_sp": 0.0518, "t_gauge": 0.004})
    time = np.arange(0.0, 20.0, 0.01)
    inputs = {"n_set": 0.1 * np.sin(3.0 * time)}
    slow, fast = simulate_exactly(model, values, time, inputs), simulate(model, values, time, inputs)
    for output in ("n", "M_s"):
        assert np.abs(slow.outputs[output] - fast.outputs[output]).max() < 2e-5


def test_corners_without_end_are_refused():
    model = delayed_feedback()
    time = np.arange(0.0, 1500.0, 0.01)
    values = model.vector({"k": 1.0, "d_in": 0.1234567, "d_out": 0.0234567})
    with pytest.raises(StructureError, match="shorten the record, or use simulate"):
        simulate_exactly(model, values, time, {"u": np.sin(time)})
