"""Simulation on a uniform grid: laws, sums of exponentials by hand, and derivatives by a complex step."""

import numpy as np
import pytest

from shaftprint.catalogue import limited, structure
from shaftprint.errors import StructureError
from shaftprint.models import (
    AveragingSensor,
    Delay,
    Diagram,
    FirstOrderLag,
    FunctionBlock,
    Parameter,
    Structure,
    choose,
    clip,
    table,
)
from shaftprint.simulation import equilibrium, simulate

TIME = np.arange(0.0, 20.0, 0.01)
TRUTH = {"tau_up": 1.016, "tau_dn": 0.32, "K_p": 5.7, "K_i": 4.27, "t_d": 0.0703, "omega_n": 10.3, "zeta": 0.47}
TRUTH |= {"t_sp": 0.0518, "k_q": 2.0, "g": -0.1, "t_gauge": 0.004}
THESIS = {"tau_n": 0.39, "K_p": 1.8, "K_i": 4.3, "t_d": 0.1037, "omega_n": 9.0, "zeta": 1.2}
LEVELS = {"m_max": 2.2, "m_min": -0.3, "T_aw": 0.4, "r_x": 6.0, "d_e": 0.01, "a_0": 0.5, "tau_tc": 0.8}


@pytest.mark.parametrize("name", ["CL4", "GAUGE-CLOSED", "GAUGE-INFLOW", "GAUGE-ECU", "BENCHMARK", "CL4-PADE5"])
def test_a_sine_settles_to_the_frequency_response(name):
    model = structure(name)
    given = TRUTH if name.startswith("GAUGE") else THESIS
    values = model.vector({key: value for key, value in given.items() if key in model.names})
    omega = 2.0 * np.pi * 0.4
    found = simulate(model, values, np.arange(0.0, 60.0, 0.01), {"n_set": np.sin(omega * np.arange(0.0, 60.0, 0.01))})
    expected = model.response(values, [1j * omega])[:, 0]
    # the last 25 s hold ten periods
    late = found.time_s >= 35.0 - 1e-9
    wave = np.exp(-1j * omega * found.time_s[late]) * 2j / late.sum()
    for output, response in zip(model.outputs, expected, strict=True):
        assert abs(found.outputs[output][late] @ wave - response) < 2e-4 * abs(response)


def test_first_order_lag_by_hand():
    time_constant = Parameter("T", "s", 0.1, 5.0, 0.8, "lag")
    model = Structure(name="lag", title="lag", input="u", outputs={"y": FirstOrderLag(time_constant)})
    found = simulate(model, [0.8], TIME, {"u": TIME}, wanted=("T",))
    # a ramp stays behind by T once it has settled
    decay = np.exp(-TIME / 0.8)
    np.testing.assert_allclose(found.outputs["y"], TIME - 0.8 * (1.0 - decay), atol=1e-9)
    np.testing.assert_allclose(found.derivatives["y"][0], -(1.0 - decay) + decay * TIME / 0.8, atol=1e-8)


def test_pick_up_shows_the_mean_of_its_window():
    average = Parameter("T_average", "s", 0.0, 1.0, 0.4, "window", held=True)
    hold = Parameter("T_hold", "s", 0.0, 1.0, 0.0, "hold", held=True)
    late = Parameter("t_pickup", "s", 0.0, 1.0, 0.5, "delay", held=True)
    model = Structure(name="pick-up", title="pick-up", input="n", outputs={"n": AveragingSensor(average, hold, late)})
    found = simulate(model, model.vector({}), TIME, {"n": 1.0 + TIME**2})
    # mean of t^2 over a window of T about t - d: (t - d)^2 + T^2 / 12; before zero the input stood at 1
    settled = TIME > 1.0
    expected = 1.0 + (TIME - 0.5) ** 2 + 0.4**2 / 12.0
    np.testing.assert_allclose(found.outputs["n"][settled], expected[settled], atol=2e-5)
    assert found.outputs["n"][0] == pytest.approx(1.0, abs=1e-12)


def test_a_latency_that_was_corrected_by_too_much_needs_no_future():
    late = Parameter("t", "s", -0.1, 0.1, -0.0237, "error of a latency")
    model = Structure(name="early", title="early", input="u", outputs={"y": Delay(late)})
    found = simulate(model, [-0.0237], TIME, {"u": np.sin(TIME)}, wanted=("t",))
    inside = TIME[-1] - 0.05 > TIME
    np.testing.assert_allclose(found.outputs["y"][inside], np.sin(TIME + 0.0237)[inside], atol=2e-5)
    np.testing.assert_allclose(found.derivatives["y"][0][inside], -np.cos(TIME + 0.0237)[inside], atol=5e-3)


@pytest.mark.parametrize(
    "limits",
    [
        pytest.param((), marks=pytest.mark.long),
        pytest.param(("torque",), marks=pytest.mark.long),
        pytest.param(("torque", "rate"), marks=pytest.mark.long),
        ("torque", "smoke", "deadband"),
    ],
)
def test_derivatives_are_those_of_a_complex_step(limits):
    ship = limited(*limits, curve=((-0.5, 0.8), (0.0, 1.0), (0.3, 1.02), (0.5, 0.9)))
    values = ship.vector(TRUTH | {name: v for name, v in LEVELS.items() if name in ship.names})
    inputs = {"n_set": 0.42 * ((TIME > 2.0) & (TIME < 12.0))}
    wanted = tuple(p.name for p in ship.free)
    found = simulate(ship, values, TIME, inputs, wanted=wanted)
    for place, name in enumerate(wanted):
        moved = values.astype(np.complex128)
        moved[ship.names.index(name)] += 1e-30j
        stepped = simulate(ship, moved, TIME, inputs)
        for output in ("n", "M_s"):
            exact = np.imag(stepped.outputs[output]) / 1e-30
            largest = np.abs(exact).max()
            assert np.abs(found.derivatives[output][place] - exact).max() <= 1e-10 * max(largest, 1e-6)


def test_a_delay_that_varies_with_the_state():
    delay = Parameter("d", "s", 0.0, 1.0, 0.2, "delay at rest")
    model = Structure(
        name="varying",
        title="delay that falls with the speed",
        input="u",
        outputs={"x": Diagram("varying", "u", ("x",), falling_delay, (delay,)).port("x")},
    )
    found = simulate(model, [0.2], TIME, {"u": smooth(TIME)}, wanted=("d",))
    np.testing.assert_allclose(found.outputs["x"], tiny_steps(0.2), atol=5e-6)
    moved = simulate(model, np.array([0.2 + 1e-30j]), TIME, {"u": smooth(TIME)})
    np.testing.assert_allclose(found.derivatives["x"][0], np.imag(moved.outputs["x"]) / 1e-30, atol=1e-12)


def falling_delay(flow, u, p):
    x = flow.state("x")
    flow.rate(x, flow.delayed(u, p.d / (1.0 + x)) - x)
    return {"x": x}


def smooth(time):
    return np.where(time < 0.0, 0.0, 0.3 * np.sin(time) ** 2)


def tiny_steps(delay):
    """Return the same by Runge-Kutta steps of 1 ms with the input as a formula."""
    x, step, found = 0.0, 1e-3, []

    def rate(t, y):
        return smooth(np.asarray(t - delay / (1.0 + y))) - y

    for k in range(10 * TIME.size):
        if k % 10 == 0:
            found.append(x)
        t = k * step
        k1 = rate(t, x)
        k2 = rate(t + step / 2, x + step / 2 * k1)
        k3 = rate(t + step / 2, x + step / 2 * k2)
        x += step / 6 * (k1 + 2 * k2 + 2 * k3 + rate(t + step, x + step * k3))
    return np.array(found)


def test_tables_and_choices_in_equations():
    gain = Parameter("k", "-", 0.0, 5.0, 2.0, "gain")
    corners = ((-1.0, 0.0), (0.0, 1.0), (2.0, 0.0))

    def equations(flow, u, p):
        return {
            "curve": p.k * table(u, corners),
            "side": choose(u, 0.5, p.k, -p.k),
            "size": abs(u) + np.sqrt(1.0 + u * u) + np.exp(-u) + np.cos(u) + np.sin(u) + np.tanh(u) + np.log(2.0 + u),
            "held": clip(u, -0.2, 0.3) ** 3,
        }

    diagram = Diagram("shapes", "u", ("curve", "side", "size", "held"), equations, (gain,))
    model = Structure(name="shapes", title="shapes", input="u", outputs=dict(diagram.ports()))
    u = np.linspace(-1.5, 3.0, 46)
    found = simulate(model, [2.0], np.arange(46) * 0.1, {"u": u}, wanted=("k",))
    np.testing.assert_allclose(
        found.outputs["curve"], 2.0 * np.interp(u, [-1.0, 0.0, 2.0], [0.0, 1.0, 0.0]), atol=1e-12
    )
    np.testing.assert_allclose(found.outputs["side"], np.where(u <= 0.5, 2.0, -2.0))
    np.testing.assert_allclose(found.derivatives["side"][0], np.where(u <= 0.5, 1.0, -1.0))
    expected = np.abs(u) + np.hypot(1.0, u) + np.exp(-u) + np.cos(u) + np.sin(u) + np.tanh(u) + np.log(2.0 + u)
    np.testing.assert_allclose(found.outputs["size"], expected, atol=1e-12)
    np.testing.assert_allclose(found.outputs["held"], np.clip(u, -0.2, 0.3) ** 3, atol=1e-15)


def test_given_states_are_where_it_starts():
    time_constant = Parameter("T", "s", 0.1, 5.0, 0.8, "lag")
    model = Structure(name="lag", title="lag", input="u", outputs={"y": FirstOrderLag(time_constant)})
    found = simulate(model, [0.8], TIME, {"u": np.zeros_like(TIME)}, initial=[2.0])
    np.testing.assert_allclose(found.outputs["y"], found.outputs["y"][0] * np.exp(-TIME / 0.8), atol=1e-9)
    assert found.outputs["y"][0] != 0.0


def test_what_cannot_be_simulated_says_so():
    gain = Parameter("k", "-", 0.0, 5.0, 2.0, "gain")
    model = Structure(
        name="own", title="own", input="u", outputs={"y": FunctionBlock(lambda s, k: k / (s + 1.0), (gain,))}
    )
    with pytest.raises(StructureError, match="FunctionBlock of k has no equations in time"):
        simulate(model, [2.0], TIME, {"u": TIME})


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"values": [0.8, 1.0]}, "expected 1 parameter values"),
        ({"time": np.array([0.0, 0.1, 0.3])}, "uniform ascending times"),
        ({"time": np.array([0.0])}, "two or more times"),
        ({"inputs": {"x": TIME}}, "expected the inputs u, found x"),
        ({"inputs": {"u": TIME[:5]}}, "expected 2000 finite values"),
        ({"inputs": {"u": np.full(TIME.size, np.nan)}}, "not finite"),
        ({"wanted": ("K",)}, "has no parameter K"),
        ({"initial": [0.0, 1.0]}, "expected 1 states"),
    ],
)
def test_wrong_input_is_named(change, message):
    time_constant = Parameter("T", "s", 0.1, 5.0, 0.8, "lag")
    model = Structure(name="lag", title="lag", input="u", outputs={"y": FirstOrderLag(time_constant)})
    given = {"values": [0.8], "time": TIME, "inputs": {"u": TIME}} | change
    rest = {name: value for name, value in given.items() if name in ("wanted", "initial")}
    with pytest.raises(StructureError, match=message):
        simulate(model, given["values"], given["time"], given["inputs"], **rest)


def test_a_late_mean_of_a_speed_away_from_the_working_point_starts_where_it_stays():
    """What the pick-up shows is the difference of two sums that go on for ever, both late, and one late of late."""
    ship = structure("FREE-PITCH").held_at(T_average=0.1, t_pickup=0.2)
    time_s = np.arange(0.0, 2.0, 0.01)
    still = {name: np.full(time_s.size, 0.02 if name == "n_set" else 0.0) for name in ship.inputs}
    found = simulate(ship, ship.vector({}), time_s, still)
    assert found.outputs["n"] == pytest.approx(np.full(time_s.size, 0.02), abs=1e-9)


@pytest.mark.parametrize("held", [False, True])
def test_derivatives_to_the_states_at_the_start_are_differences(held):
    """A loop with a delay, whose past stands as it does at the start, and an actuator of second order."""
    line = structure("CL4")
    values, n_set = line.vector({"tau_n": 0.33, "t_d": 0.116}), 0.1 * np.sin(3.0 * TIME)
    rest = equilibrium(line, values, {"n_set": 0.02}).states

    def run(states, **options):
        return simulate(line, values, TIME, {"n_set": n_set}, hold=held, initial=states, **options)

    exact = run(rest, wanted=["K_p"], of_states=True)
    assert exact.derivatives["n"].shape == (1 + rest.size, TIME.size)
    np.testing.assert_array_equal(exact.derivatives["n"][0], run(rest, wanted=["K_p"]).derivatives["n"][0])
    for place, step in enumerate(1e-5 * np.eye(rest.size)):
        for output in ("n", "M_s"):
            slope = (run(rest + step).outputs[output] - run(rest - step).outputs[output]) / 2e-5
            assert exact.derivatives[output][1 + place] == pytest.approx(slope, abs=1e-7)
