"""Simulations of linear structures against their frequency responses, and derivatives against a complex step."""

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.errors import StructureError
from shaftprint.models import (
    Delay,
    Diagram,
    FirstOrderLag,
    Gain,
    Inertia,
    Parameter,
    PIGovernor,
    Structure,
    TorqueBalance,
    choose,
    feedback,
    maximum,
    minimum,
    table,
)
from shaftprint.simulation import simulate

STEP_S = 4e-3
TIME = STEP_S * np.arange(4096)
PULSE = (6.0 - TIME) * np.exp(-(((TIME - 6.0) / 0.6) ** 2))
# the wave that the transform repeats has died out by as many times e
SHIFT = 1.2

K_1 = Parameter("k_1", "-", 0.0, 5.0, 0.7, "gain")
K_2 = Parameter("k_2", "-", 0.0, 5.0, 0.4, "gain")
D_1 = Parameter("d_1", "s", 0.0, 3.0, 0.31, "delay")
D_2 = Parameter("d_2", "s", 0.0, 3.0, 0.0013, "delay shorter than the step")
D_3 = Parameter("d_3", "s", 0.0, 3.0, 0.004, "delay of one step")
D_4 = Parameter("d_4", "s", 0.0, 3.0, 0.62, "delay of twice the other")
LAG = FirstOrderLag(Parameter("T_1", "s", 0.0, 3.0, 0.2, "lag"))
FAST = FirstOrderLag(Parameter("T_2", "s", 0.0, 3.0, 0.07, "lag"))
BALANCE = TorqueBalance(Parameter("tau", "s", 0.0, 3.0, 0.25, "inertia"), Parameter("q", "-", 0.0, 3.0, 0.5, "slope"))


def of(expression, **changes):
    """Return a structure of one output."""
    return Structure(name="own", title="own", input="u", outputs={"y": expression}, **changes)


OWN = {
    "nested loops with four delays": of(
        feedback(
            Gain(K_2) * feedback(Gain(K_1) * Delay(D_1) * LAG, Gain(K_2) * Delay(D_2)) * Delay(D_4) * FAST, Delay(D_3)
        )
    ),
    "loop without delay in a loop without delay": of(feedback(Gain(K_1) * feedback(Gain(K_2))) * LAG),
    "loop with a delay in a loop without": of(feedback(Gain(K_1) * feedback(Gain(K_2) * Delay(D_1))) * LAG),
    "numerator ahead of a lag": of(BALANCE * LAG),
    "two numerators ahead of two lags": of(BALANCE * BALANCE * LAG * FAST),
    "numerators around a delay": of(Gain(K_1) * BALANCE * Delay(D_1) * BALANCE * LAG * FAST),
    "numerator behind a delay in the loop": of(feedback(LAG * FAST * Delay(D_1), BALANCE)),
    "inverse of what is partly late": of(1 / (1.0 + Gain(K_1) * Delay(D_1)) * LAG),
    "side by side": of(Delay(D_1) * LAG + Delay(D_4) * Gain(K_2) * FAST - Gain(K_1)),
    "no states": of(Gain(K_1) * Delay(D_1) + Gain(K_2)),
    "tied, scaled and offset": of(feedback(PIGovernor(K_1, K_2) * LAG * Delay(D_1)))
    .tied("k_2", lambda k_1, T_i: k_1 / T_i, Parameter("T_i", "s", 0.1, 5.0, 1.4, "reset time"))
    .scaled(k_1=1.3, d_1=0.7)
    .offset(k_2=0.4),
    "two inputs": Structure(
        name="own",
        title="own",
        inputs=("a", "b"),
        outputs={"x": {"a": LAG * Delay(D_1), "b": Gain(K_1) * FAST}, "y": {"b": BALANCE * LAG, "a": FAST}},
    ),
}
SHIPPED = (
    "OL-PID",
    "CL4-PADE5",
    "INITIAL",
    "GAUGE-CORE",
    "GAUGE-OPEN",
    "GAUGE-ELASTIC",
    "GAUGE-HYBRID",
    "GAUGE-INFLOW",
    "GAUGE-ECU",
    "ENGINE",
)
ALL = OWN | {name: structure(name) for name in (*SHIPPED, "FREE-PITCH")}
# Each takes ten seconds and more to compile, of blocks that others have too.
LARGE = {
    "CL4-PADE5", "GAUGE-OPEN", "GAUGE-ELASTIC", "GAUGE-HYBRID", "GAUGE-INFLOW", "FREE-PITCH",
    "two numerators ahead of two lags", "numerators around a delay",
}  # fmt: skip


def large_ones_long(names):
    """Leave structures that take long to compile to the long tests."""
    return [pytest.param(name, marks=pytest.mark.long) if name in LARGE else name for name in names]


def from_response(model, values):
    """Return each channel's output for the pulse, by a transform along a line beside the frequency axis."""
    s = SHIFT + 2j * np.pi * np.fft.rfftfreq(TIME.size, STEP_S)
    spectrum = np.fft.rfft(PULSE * np.exp(-SHIFT * TIME))
    return np.fft.irfft(model.response(values, s) * spectrum, n=TIME.size) * np.exp(SHIFT * TIME)


@pytest.mark.parametrize("name", large_ones_long(ALL))
def test_a_pulse_does_what_the_frequency_response_says(name):
    model = ALL[name]
    values = model.vector({})
    part = TIME < 11.0
    for source in model.inputs:
        inputs = {other: PULSE if other == source else np.zeros_like(PULSE) for other in model.inputs}
        found = simulate(model, values, TIME, inputs, wanted=lively(model, values)[:1])
        for (output, channel), expected in zip(model.channels, from_response(model, values), strict=True):
            if channel == source:
                worst = np.abs(found.outputs[output] - expected)[part].max()
                # a pulse that is straight between its samples is off by h^2 / 8 times its curvature
                assert worst < 2e-4 * np.abs(expected[part]).max()


def lively(model, values):
    """Return the parameters that are not zero for good."""
    pairs = zip(model.parameters, values, strict=True)
    return tuple(p.name for p, value in pairs if not (p.held and value == 0.0))


@pytest.mark.parametrize("name", large_ones_long([*OWN, "FREE-PITCH"]))
def test_derivatives_are_those_of_a_complex_step(name):
    model = ALL[name]
    values = model.vector({})
    time = TIME[:1900]
    inputs = {source: np.cos(0.3 * place) * PULSE[: time.size] for place, source in enumerate(model.inputs)}
    wanted = lively(model, values)
    found = simulate(model, values, time, inputs, wanted=wanted)
    for place, name in enumerate(wanted):
        moved = values.astype(np.complex128)
        moved[model.names.index(name)] += 1e-30j
        stepped = simulate(model, moved, time, inputs)
        for output in model.outputs:
            exact = np.imag(stepped.outputs[output]) / 1e-30
            worst = np.abs(found.derivatives[output][place] - exact).max()
            assert worst <= 1e-9 * max(np.abs(exact).max(), 1e-3)


def test_derivatives_of_every_function_hold_also_where_the_start_moves():
    def equations(flow, u, p):
        x = flow.state("x")
        k = p.k_1
        curve = table(k * u, ((-1.0, 0.0), (0.0, 1.0), (2.0, 0.0)))
        flow.rate(x, curve + np.sin(k * u) + np.cos(k * x) + np.tanh(k * u) - np.sqrt(1.0 + k * x * x) - x**3 / k - x)
        picked = choose(u, k * x, k * x, np.exp(k * u)) + abs(k * x) + maximum(k * x, u) - minimum(k * u, x)
        return {"y": picked + np.log(2.0 + k * x * x) + (1.0 + k * u * u) ** 1.5}

    model = of(Diagram("functions", "u", ("y",), equations, (K_1,)).port("y"))
    found = simulate(model, [0.7], TIME, {"u": PULSE}, wanted=("k_1",))
    above, below = (simulate(model, [value], TIME, {"u": PULSE}).outputs["y"] for value in (0.7001, 0.6999))
    # corners of the functions are met one step earlier or later
    wrong = np.abs(found.derivatives["y"][0] - (above - below) / 2e-4) > 1e-5
    assert np.abs(found.derivatives["y"][0]).max() > 1.0
    assert wrong.mean() < 0.01


def test_a_varying_delay_beyond_what_is_kept_stays_at_the_oldest_node():
    def equations(flow, u, p):
        return {"y": flow.delayed(u, p.d_1 * (1.0 + 99.0 * u))}

    model = of(Diagram("late", "u", ("y",), equations, (D_1,)).port("y"))
    found = simulate(model, [0.02], TIME, {"u": np.clip(TIME - 1.0, 0.0, 1.0)})
    assert np.all(np.isfinite(found.outputs["y"]))
    assert np.abs(found.outputs["y"]).max() < 1.1


def test_a_second_change_of_the_input_is_refused():
    double = of(Inertia(Parameter("m", "s", 0.0, 1.0, 0.3, "inertia")) * BALANCE)
    with pytest.raises(StructureError, match="second change of an input"):
        simulate(double, double.vector({}), TIME, {"u": PULSE})


def test_a_second_change_of_a_late_signal_is_refused():
    def equations(flow, u, p):
        return {"y": flow.change(flow.change(flow.delayed(u, p.d_1)))}

    late = of(Diagram("late", "u", ("y",), equations, (D_1,)).port("y"))
    with pytest.raises(StructureError, match="second change of a late signal"):
        simulate(late, late.vector({}), TIME, {"u": PULSE})
