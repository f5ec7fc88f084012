"""Modelica text: read and flattened by pymoca, then taken at its word by a small reader of equations below."""

import operator
import re
from functools import cache

import numpy as np
import pytest

from shaftprint.catalogue import STRUCTURES, limited, structure
from shaftprint.errors import ExportError
from shaftprint.escape import modelica_string
from shaftprint.export import write_modelica
from shaftprint.export.modelica._expressions import modelica_name, modelica_number
from shaftprint.export.modelica._write import modelica_text
from shaftprint.models import Diagram, Parameter, Shaft, Structure, clip, firing_delay, first_order_lag
from shaftprint.simulation import simulate

OMEGA = np.array([0.11, 0.9, 3.7, 12.0, 33.0])
SENSORS = {"T_average": 0.05, "T_hold": 0.02, "t_pickup": 0.08, "T_filter": 0.03, "t_gauge": 0.004}
BINARY = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
    "^": operator.pow,
    "<=": operator.le,
    "<": operator.lt,
    ">": operator.gt,
    "min": min,
    "max": max,
    "smooth": lambda _, value: value,
}
UNARY = {"-": operator.neg, "abs": abs, "exp": np.exp, "sqrt": np.sqrt, "sin": np.sin, "cos": np.cos, "tanh": np.tanh}


@cache
def parsed(text):
    """Read a text."""
    parser = pytest.importorskip("pymoca.parser", reason="pymoca reads Modelica")
    return parser.parse(text, bypass_cache=True)


def flat(text, name):
    """Return one of the models of a text without structure."""
    whole = parsed(text)
    from pymoca import ast, tree

    return tree.flatten(whole, ast.ComponentRef.from_tuple(("Tug", name))).classes[f"Tug.{name}"]


class Reader:
    """Values of the variables of a flat model at one instant, from its equations alone."""

    def __init__(self, model):
        from pymoca import ast

        self.ast = ast
        self.model = model
        self.known = {}
        self.rates, self.late, self.equations, self.computers = {}, {}, {}, []
        for equation in model.equations:
            if isinstance(equation, ast.WhenEquation):
                self.computers.append(equation)
            elif isinstance(equation.left, ast.Expression):
                self.rates[str(equation.left.operands[0])] = equation.right
            else:
                self.equations[str(equation.left)] = equation.right
        for symbol in model.symbols.values():
            if "parameter" in symbol.prefixes:
                self.equations[symbol.name] = symbol.value
        for name, right in self.equations.items():
            branch = right.expressions[0] if isinstance(right, ast.IfExpression) else right
            if isinstance(branch, ast.Expression) and str(branch.operator) == "delay":
                self.late[name] = branch.operands[0], branch.operands[1]

    def at(self, **known):
        """Begin another instant."""
        self.known = {name.replace("__", "."): value for name, value in known.items()}

    def __call__(self, node):
        ast = self.ast
        if isinstance(node, str | ast.ComponentRef):
            name = str(node)
            if name not in self.known:
                self.known[name] = self(self.equations[name])
            return self.known[name]
        if isinstance(node, ast.Primary):
            return node.value
        if isinstance(node, ast.IfExpression):
            found = next((i for i, condition in enumerate(node.conditions) if self(condition)), len(node.conditions))
            return self(node.expressions[found])
        name = str(node.operator)
        if name == "pre":
            return self.known[str(node.operands[0])]
        parts = [self(part) for part in node.operands]
        return UNARY[name](*parts) if len(parts) == 1 else BINARY[name](*parts)


def response_of(text, inputs, outputs, sizes):
    """Return the response from the equations, solved for phasors: der() is j omega, delay() turns the phase."""
    reader = Reader(flat(text, "Line"))
    reader.at()
    delays = {name: float(reader(time)) for name, (_, time) in reader.late.items()}
    unknown, base = [*reader.rates, *reader.late], dict(zip(inputs, sizes[0], strict=True))

    def made(changed):
        reader.at(**(dict.fromkeys(unknown, 0.0) | base | changed))
        found = [reader(rate) for rate in reader.rates.values()]
        found += [reader(signal) for signal, _ in reader.late.values()]
        return np.array(found + [reader(name) for name in outputs])

    rest = made({})
    columns = [made({name: 1.0}) - rest for name in unknown]
    columns += [(made({name: base[name] + size}) - rest) for name, size in zip(inputs, sizes[1], strict=True)]
    table, count, states = np.array(columns).T, len(unknown), len(reader.rates)
    found = []
    for omega in OMEGA:
        own = np.diag([1j * omega] * states + [np.exp(1j * omega * delays[name]) for name in reader.late])
        inside = np.linalg.solve(own - table[:count, :count], table[:count, count:])
        found.append(table[count:, :count] @ inside + table[count:, count:])
    return np.moveaxis(np.array(found), 0, -1)


PHYSICAL = {"n_set": "engine_speed_set_point", "n": "engine_speed", "e": "engine_speed_error", "M_s": "shaft_torque"}


def sides(model, names):
    """Return names, values at the working point and sizes of a deviation of 1."""
    speed, torque = model.engine_speed_rpm, model.shaft_torque_nm
    sizes = [{"n_set": speed, "n": speed, "e": speed, "M_s": torque}.get(name, 1.0) for name in names]
    rest = [size if name in ("n_set", "n", "M_s") else 0.0 for name, size in zip(names, sizes, strict=True)]
    return [PHYSICAL.get(name, name) for name in names], rest, sizes


@pytest.mark.parametrize("sensors", [{}, SENSORS], ids=["plain", "sensors"])
@pytest.mark.parametrize("name", STRUCTURES)
def test_the_equations_have_the_response_of_the_structure(exported, name, sensors):
    chosen = structure(name)
    model = exported(chosen, {n: value for n, value in sensors.items() if n in chosen.names})
    inputs, at_rest, input_sizes = sides(model, chosen.inputs)
    outputs, _, output_sizes = sides(model, tuple(chosen.outputs))
    text, equations = modelica_text(model, "Tug")
    found = response_of(text, inputs, outputs, (at_rest, input_sizes)) / np.array(output_sizes)[:, None, None]
    expected = chosen.response(model.values, 1j * OMEGA).reshape(found.shape)
    if equations.late:
        # an output that would need the future comes late: its size only
        found, expected = np.abs(found), np.abs(expected)
    np.testing.assert_allclose(found, expected, rtol=1e-7, atol=1e-10)


@pytest.mark.parametrize("name", [*STRUCTURES, "limited"])
def test_there_is_an_equation_for_every_unknown(exported, name):
    ast = pytest.importorskip("pymoca.ast", reason="pymoca reads Modelica")
    chosen = limited("torque", "rate", "smoke", "deadband", period_s=0.02) if name == "limited" else structure(name)
    text, _ = modelica_text(exported(chosen), "Tug")
    model = flat(text, "Line")
    # pymoca leaves connectors out of what is flat
    block = parsed(text).classes["Tug"].classes["Line"]
    outputs = [symbol.name for symbol in block.symbols.values() if str(symbol.type) == "RealOutput"]
    assert outputs == sides(exported(chosen), tuple(chosen.outputs))[0]
    unknown = outputs + [symbol.name for symbol in model.symbols.values() if "parameter" not in symbol.prefixes]
    parts = [
        part
        for equation in model.equations
        for part in (equation.blocks[0] if isinstance(equation, ast.WhenEquation) else [equation])
    ]
    solved = [str(part.left.operands[0] if isinstance(part.left, ast.Expression) else part.left) for part in parts]
    assert sorted(solved) == sorted(unknown)


def in_time(text, outputs, until_s, step_s, jump):
    """Return outputs of the experiment by Runge and Kutta's rule, late signals straight between the steps."""
    reader = Reader(flat(text, "Step"))
    states, held = dict.fromkeys(reader.rates, 0.0), {}
    reader.at()
    computers = []
    for computer in reader.computers:
        computers.append((float(reader(computer.conditions[0].operands[0])), computer.blocks[0]))
        held |= {str(equation.left): 0.0 for equation in computer.blocks[0]}
    delays = {}
    history = {name: [] for name in reader.late}
    times, found = np.arange(0.0, until_s + step_s / 2, step_s), []

    def begin(time, values):
        known = {"time": time, "jump": jump} | held | values
        past = np.arange(len(next(iter(history.values()), []))) * step_s
        for name, values_then in history.items():
            before = time - delays.get(name, 0.0)
            known[name] = 0.0 if before <= 0.0 or not values_then else np.interp(before, past, values_then)
        reader.at(**known)

    def rates(time, values):
        begin(time, values)
        return {name: reader(rate) for name, rate in reader.rates.items()}

    def moved(values, slopes, by):
        return {name: value + by * slopes[name] for name, value in values.items()}

    begin(0.0, states)
    delays = {name: float(reader(time)) for name, (_, time) in reader.late.items()}
    for time in times:
        begin(time, states)
        for period, block in computers:
            if time > 0.0 and abs(time / period - round(time / period)) < 1e-6:
                taken = {}
                for equation in block:
                    taken[str(equation.left)] = reader.known[str(equation.left)] = reader(equation.right)
                    if str(equation.left).rpartition(".")[2].startswith("held"):
                        del reader.known[str(equation.left)]
                held |= taken
        begin(time, states)
        for name, (signal, _) in reader.late.items():
            history[name].append(reader(signal))
        found.append([reader(name) for name in outputs])
        one = rates(time, states)
        two = rates(time + step_s / 2, moved(states, one, step_s / 2))
        three = rates(time + step_s / 2, moved(states, two, step_s / 2))
        four = rates(time + step_s, moved(states, three, step_s))
        slopes = {n: (one[n] + 2 * two[n] + 2 * three[n] + four[n]) / 6 for n in states}
        states = moved(states, slopes, step_s)
    return times, np.array(found).T


@pytest.mark.slow
@pytest.mark.parametrize(
    ("chosen", "jump"),
    [
        (structure("GAUGE-CLOSED"), 0.02),
        (limited("torque"), 0.35),
        (limited("torque", "rate", "smoke", period_s=0.02, curve=((-0.3, 0.7), (0.0, 1.0), (0.3, 0.9))), 0.3),
        pytest.param(limited("deadband", "torque"), -0.2, marks=pytest.mark.long),
    ],
    ids=lambda value: getattr(value, "name", ""),
)
def test_a_step_goes_as_in_the_simulation(exported, chosen, jump):
    model = exported(chosen, {"t_d": 0.0733, "t_sp": 0.0417, "r_x": 4.0} if "r_x" in chosen.names else {"t_d": 0.0733})
    text, _ = modelica_text(model, "Tug")
    step = 0.005
    times, found = in_time(text, ["line.engine_speed", "line.shaft_torque"], 4.0, step, jump)
    fine = np.arange(0.0, 4.0 + 1e-9, 0.0005)
    given = np.where(fine < 1.0 - 1e-9, 0.0, jump)
    trace = simulate(chosen, model.values, fine, {"n_set": given}, hold=True)
    for row, name, size in ((0, "n", model.engine_speed_rpm), (1, "M_s", model.shaft_torque_nm)):
        expected = size * (1.0 + trace.outputs[name][::10])
        reach = np.ptp(expected)
        assert reach > 0.015 * size
        np.testing.assert_allclose(found[row], expected, atol=0.01 * reach)
        assert np.sqrt(np.mean((found[row] - expected) ** 2)) < 0.003 * reach
    assert times.size == 801


def test_a_delay_that_varies_has_a_bound(exported):
    def equations(flow, demand, p):
        speed = flow.state("speed")
        late = flow.delayed(demand - p.k * speed, firing_delay(speed, 6, 20.0))
        flow.rate(speed, clip(first_order_lag(flow, late, 0.1), -0.5, 0.5))
        return {"n": speed}

    gain = Parameter("k", "-", 0.0, 5.0, 1.0, "gain")
    loop = Diagram(name="loop", input="demand", outputs=("n",), equations=equations, of=(gain,))
    own = Structure(name="OWN", title="own", input="n_set", outputs={"n": loop.ports()["n"]})
    text, _ = modelica_text(exported(own), "Tug")
    assert re.search(r"parameter Real longest_delay_1\(unit = \"s\"\) = 0\.208", text)
    assert "delay(prompt_1, delay_1, longest_delay_1)" in text
    reader = Reader(flat(text, "Line"))
    reader.at(engine_speed_set_point=1183.8, late_1=0.0, **dict.fromkeys(reader.rates, 0.0))
    # half of a sixth of two revolutions and a quarter of one, at 20 revolutions a second
    assert reader("delay_1") == pytest.approx((1.0 / 6.0 + 0.25) / 20.0)


def test_words_and_numbers():
    assert modelica_name("K_p") == "K_p"
    assert modelica_name("end") == "'end'"
    assert modelica_name("k 1's") == "'k 1\\'s'"
    assert modelica_string('a "b"\n c\\') == '"a \\"b\\"? c\\\\"'
    assert modelica_number(-1e-05) == "(-1e-05)"
    with pytest.raises(ExportError, match="finite numbers"):
        modelica_number(float("nan"))


def test_names_that_are_taken_get_another(exported):
    tau = Parameter("u_1", "s", 0.01, 1.0, 0.3, "inertia time called as an input")
    odd = Parameter("x y", "furlong", 0.0, 3.0, 2.0, "slope with a blank")
    own = Structure(name="ODD", title='a "title"', input="M_s", outputs={"n": Shaft((tau,), odd)})
    text, _ = modelica_text(exported(own), "Tug")
    flat(text, "Step")
    assert "parameter Real u_1(" in text
    assert "Real 'x y' = 2.0" in text


def test_the_file_is_a_package_of_its_name(exported, tmp_path):
    written = write_modelica(exported(structure("GAUGE-CORE"), {"t_gauge": 0.01}), tmp_path / "stan-tug.mo")
    text = written.path.read_text()
    assert written.package == "stan_tug"
    assert written.late_outputs == ("n",)
    assert text.startswith("within;\npackage stan_tug ")
    assert text.endswith("end stan_tug;\n")
    with pytest.raises(FileExistsError, match="exists already"):
        write_modelica(exported(structure("GAUGE-CORE")), tmp_path / "stan-tug.mo")
