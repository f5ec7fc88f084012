"""A structure from a file of the user's, wherever a command takes the name of one."""

import sys
import textwrap

import pytest

from shaftprint.catalogue import chosen_structures
from shaftprint.errors import StructureError
from shaftprint.fingerprint import read_fingerprint

GIVEN = ("--vessel", "stan-tug-1205", "--campaign", "short", "--no-progress")

CORE = """
    from shaftprint.models import Parameter, RationalBlock, Structure

    TAU = Parameter("inertia", "s", 0.0, 2.0, 0.3, "inertia time behind the gauge")
    SLOPE = Parameter("slope", "-", 1.0, 3.0, 2.0, "slope of the load")

    my_core = Structure(
        name="MY-CORE",
        title="core propulsion of my ship",
        input="M_s",
        outputs={"n": RationalBlock(lambda tau, k: ([1.0], [tau, k]), (TAU, SLOPE))},
    )
"""

LOOP = """
    from dataclasses import dataclass, replace

    import numpy as np

    from shaftprint.catalogue import structure
    from shaftprint.models import Parameter


    @dataclass
    class Note:
        text: "str"


    def my_loop():
        \"\"\"The thesis' CL4 with a reset time for the integral gain, and the logarithm of the inertia time.\"\"\"
        loop = structure("CL4").tied("K_i", lambda K_p, T_i: K_p / T_i, Parameter("T_i", "s", 0.1, 10.0, 1.0, "reset"))
        log_tau = Parameter("log_tau", "-", -3.0, 1.0, -1.0, "logarithm of the inertia time")
        return replace(loop.tied("tau_n", lambda log_tau: np.exp(log_tau), log_tau), name="MY/LOOP", title="own")
"""

LINE = """
    from shaftprint.catalogue import ShipRole
    from shaftprint.models import (
        AveragingSensor, Delay, Gain, PIGovernor, Parameter, SecondOrderLag, Sensitivity, Shaft, Structure,
        TorqueBalance,
    )

    J_AFT = Parameter("J_aft", "s", 0.0, 2.0, 0.3, "inertia time aft of the gauge", role=ShipRole.INERTIA_DOWNSTREAM)
    J_FORE = Parameter("J_fore", "s", 0.0, 5.0, 1.0, "inertia time before the gauge", role=ShipRole.INERTIA_UPSTREAM)
    LOAD = Parameter("load", "-", 1.0, 3.0, 2.0, "slope of the load", role=ShipRole.LOAD_SLOPE)
    ENGINE = Parameter("slope", "-", -3.0, 0.9, 0.0, "slope of the engine", role=ShipRole.ENGINE_SPEED_SLOPE)
    FUEL = Parameter("fuel", "-", 0.0, 5.0, 1.0, "torque for fuel", held=True, role=ShipRole.ENGINE_RACK_SLOPE)
    GAIN = Parameter("P", "-", 0.0, 20.0, 5.0, "gain", role=ShipRole.PROPORTIONAL_GAIN)
    RESET = Parameter("I", "1/s", 0.0, 20.0, 4.0, "integral gain", role=ShipRole.INTEGRAL_GAIN)
    DELAY = Parameter("dead", "s", 0.0, 0.5, 0.1, "delay in the loop", role=ShipRole.LOOP_DELAY)
    LATE = Parameter("late", "s", 0.0, 0.5, 0.05, "latency of the set point", role=ShipRole.SET_POINT_LATENCY)
    FREQUENCY = Parameter("w", "rad/s", 3.0, 60.0, 10.0, "actuator", role=ShipRole.ACTUATOR_FREQUENCY)
    DAMPING = Parameter("d", "-", 0.1, 4.0, 0.5, "actuator", role=ShipRole.ACTUATOR_DAMPING)
    MEAN = Parameter("mean", "s", 0.0, 1.0, 0.0, "mean of the pick-up", held=True, role=ShipRole.PICK_UP_AVERAGE)
    HOLD = Parameter("hold", "s", 0.0, 1.0, 0.0, "hold of the pick-up", held=True, role=ShipRole.PICK_UP_HOLD)
    PICK_UP = Parameter("behind", "s", 0.0, 1.0, 0.0, "delay of the pick-up", held=True, role=ShipRole.PICK_UP_DELAY)

    loop = PIGovernor(GAIN, RESET) * Gain(FUEL) * Delay(DELAY) * SecondOrderLag(FREQUENCY, DAMPING)
    loop = loop * Shaft((J_AFT, J_FORE), LOAD, ENGINE)
    speed = loop * Sensitivity(loop) * Delay(LATE)
    line = Structure(
        name="MY-LINE",
        title="the line in names of my own",
        input="n_set",
        outputs={"n": speed * AveragingSensor(MEAN, HOLD, PICK_UP), "M_s": speed * TorqueBalance(J_AFT, LOAD)},
    )
"""


@pytest.fixture
def written(tmp_path, monkeypatch):
    """Write a file into the working folder."""
    monkeypatch.chdir(tmp_path)

    def write(text, name="my_ship.py"):
        (tmp_path / name).write_text(textwrap.dedent(text), encoding="utf-8")
        return tmp_path / name

    return write


@pytest.mark.slow
def test_an_own_structure_is_fitted_from_the_command_line(run, recording, written, tmp_path):
    written(CORE)
    result = run("identify", recording, *GIVEN, "--structure", "my_ship.py:my_core", "-o", tmp_path / "out")
    assert result.exit_code == 3, result.stderr
    found = read_fingerprint(tmp_path / "out" / "fingerprint.json")
    assert found.structure == "MY-CORE"
    # the truth of the simulated tug, 17 kg m2 behind the gauge at its working point, and a quadratic propeller
    assert found.quantity("inertia").value == pytest.approx(0.3172, rel=0.02)
    assert found.quantity("slope").value == pytest.approx(2.0, rel=0.02)
    # the names mean nothing to shaftprint, so there is no inertia in kg m2, but the working point's torque coefficient
    assert [quantity.name for quantity in found.physical] == ["K_Q"]
    assert found.margins == ()
    # the file is one of the sources, with its hash
    assert [(source.role, source.name) for source in found.sources][-1] == ("structure", "my_ship.py")
    page = (tmp_path / "out" / "index.html").read_text(encoding="utf-8")
    assert "MY-CORE" in page
    assert "inertia time behind the gauge" in page
    # nothing is left beside the user's file
    assert not (tmp_path / "__pycache__").exists()
    assert run("show", tmp_path / "out").exit_code == 0


@pytest.mark.long
def test_ties_go_through_the_whole_chain_and_lead_to_the_same_optimum(run, recording, written, tmp_path):
    written(LOOP)
    options = ("--structure", "my_ship.py:my_loop", "--structure", "CL4", "--structure", "GAUGE-CORE")
    result = run("identify", recording, *GIVEN, *options, "-o", tmp_path / "tied")
    assert result.exit_code == 3, result.stderr
    tied = read_fingerprint(tmp_path / "tied" / "fingerprint.json")
    # the gauge of the tug lies between engine and propeller, which neither loop knows: no number is to be used
    assert not tied.verdict.trustworthy
    table = result.output[result.output.index("All structures") :]
    assert all(name in table for name in ("MY/LOOP", "CL4", "GAUGE-CORE"))
    assert {"T_i", "log_tau"} <= {quantity.name for quantity in tied.parameters}
    # a tied parameter is reported as a combination, with a physical value and margins as if it were free
    assert {quantity.name for quantity in tied.combinations} == {"tau_n", "K_i"}
    k_p, k_i, t_i = (tied.quantity(name).value for name in ("K_p", "K_i", "T_i"))
    assert k_i == pytest.approx(k_p / t_i, rel=1e-9)
    assert tied.quantity("gain margin").interval_95 is not None
    figures = {path.stem for path in (tmp_path / "tied" / "plots").iterdir()}
    assert {"sensitivity_my-loop_1", "structures_5_3", "structures_gauge-core"} <= figures

    assert run("identify", recording, *GIVEN, "--structure", "CL4", "-o", tmp_path / "plain").exit_code == 3
    plain = read_fingerprint(tmp_path / "plain" / "fingerprint.json")
    for name in ("K_i", "tau_n", "t_d", "gain margin", "I"):
        assert tied.quantity(name).value == pytest.approx(plain.quantity(name).value, rel=1e-3), name
        assert tied.quantity(name).std == pytest.approx(plain.quantity(name).std, rel=2e-2), name


def test_a_structure_of_other_channels_is_refused_with_those_that_there_are(run, recording, written, tmp_path):
    written(CORE.replace('input="M_s"', 'input="voltage"').replace('"n":', '"omega_1":'))
    result = run("identify", recording, *GIVEN, "--structure", "my_ship.py:my_core", "-o", tmp_path / "out")
    assert result.exit_code == 1
    assert "structure MY-CORE goes from voltage to omega_1" in result.stderr
    assert "n_set to n, M_s; e to M_s; M_s to n" in result.stderr
    assert not (tmp_path / "out").exists()


def test_an_output_that_the_recording_lacks_is_refused(run, recording, tmp_path):
    result = run("identify", recording, *GIVEN, "--structure", "INITIAL", "-o", tmp_path / "out")
    assert result.exit_code == 1
    assert "structure INITIAL goes from n_set to n, E_n, M_s" in result.stderr


def test_parameters_outputs_and_combinations_are_listed(run, written):
    written(LOOP + "\n\n    core = structure('OL1')\n")
    result = run("structures", "my_ship.py:my_loop")
    assert result.exit_code == 0, result.stderr
    assert result.output.startswith("MY/LOOP: own, n_set -> n, M_s\n")
    rows = {line.split()[0]: line.split() for line in result.output.splitlines() if line.strip()}
    assert rows["T_i"][1:4] == ["s", "0.1", "10"]
    assert "  tau_n [s]: inertia time" in result.output
    assert "follows from log_tau" in result.output


def test_several_inputs_are_listed(run, written):
    written(
        """
        from shaftprint.models import Gain, Parameter, Structure

        a, b = (Gain(Parameter(name, "mm/N", 0.0, 1.0, 0.1, name)) for name in "ab")
        pair = Structure(name="PAIR", title="p", inputs=("F_1", "F_2"), outputs={"x": {"F_1": a, "F_2": b}})
        """
    )
    assert run("structures", "my_ship.py:pair").output.startswith("PAIR: p, F_1, F_2 -> x\n")


@pytest.mark.slow
def test_sensitivity_of_an_own_structure(run, written, tmp_path):
    written(LOOP)
    result = run("sensitivity", "my_ship.py:my_loop", "--between", 0.1, 50, "-o", "out", "--format", "png")
    assert result.exit_code == 0, result.stderr
    assert {path.name for path in (tmp_path / "out").glob("*.png")} == {"MY-LOOP_n.png", "MY-LOOP_M_s.png"}
    again = run("sensitivity", "my_ship.py:my_loop", "--between", 50, 0.1, "-o", "out")
    assert again.exit_code == 2
    assert "expected ascending frequencies above 0 rad/s, found 50 and 0.1" in again.stderr


def test_the_file_may_import_one_beside_it(written):
    written("GAIN = 2.5\n", "my_numbers.py")
    written(
        """
        from my_numbers import GAIN
        from shaftprint.catalogue import structure

        line = structure("OL2").held_at(K_p=GAIN)
        """
        + NAMED
    )
    before = list(sys.path)
    (found,) = chosen_structures(["my_ship.py:line"])
    assert found.parameters[0].value == 2.5
    assert sys.path == before


NAMED = """
        from dataclasses import replace

        line = replace(line, name="LINE")
"""


def test_one_file_is_run_once_and_a_changed_one_again(written):
    path = written("print('run')" + CORE.replace("\n    ", "\n"))
    first = chosen_structures(["my_ship.py:my_core", f"{path}:my_core"])
    assert len(first) == 1
    path.write_text(path.read_text().replace('"inertia"', '"J"'))
    assert chosen_structures(["my_ship.py:my_core"])[0].names == ("J", "slope")


@pytest.mark.parametrize(
    ("text", "name", "message"),
    [
        (None, "none.py:x", "none.py: expected a Python file, found nothing there."),
        (None, "folder.py:x", "folder.py: expected a Python file, found a folder."),
        (
            "",
            "my_ship.txt:x",
            "my_ship.txt:x: expected a file whose name ends in .py and the name of a structure",
        ),
        (CORE, "my_ship.py", "my_ship.py: expected the name of a structure in it, such as my_ship.py:my_core"),
        (CORE, "my_ship.py:my_cor", "my_ship.py: found no my_cor; its structures are my_core."),
        ("x = 1", "my_ship.py:y", "my_ship.py: found no y, and no other structure in it."),
        (LOOP, "my_ship.py:loop", "my_ship.py: found no loop; its structures are my_loop."),
        ("x = 1", "my_ship.py:x", "my_ship.py:x: expected a Structure, or a function without arguments that returns"),
        ("def x():\n    return [1]", "my_ship.py:x", "my_ship.py:x: expected a Structure, found list."),
        (
            "def x(a, b=1):\n    return a",
            "my_ship.py:x",
            "my_ship.py:x: expected a function without arguments, found",
        ),
        (
            "import nothing_there",
            "my_ship.py:x",
            "my_ship.py, line 1: ModuleNotFoundError: No module named",
        ),
        ("x = 1\ny = x +\n", "my_ship.py:x", "my_ship.py, line 2: SyntaxError: invalid syntax."),
        (
            "def f():\n    return 1 / 0\n\n\nx = f()",
            "my_ship.py:x",
            "my_ship.py, line 2: ZeroDivisionError: division",
        ),
        ("def x():\n    raise KeyError('k')", "my_ship.py:x", "my_ship.py, line 2: KeyError: 'k'."),
        ("raise SystemExit(3)", "my_ship.py:x", "my_ship.py, line 1: SystemExit: 3."),
        ("raise ValueError", "my_ship.py:x", "my_ship.py, line 1: ValueError."),
        (
            "from shaftprint.models import Parameter\n\nx = Parameter('K', '-', 2.0, 1.0, 1.5, 'gain')",
            "my_ship.py:x",
            "my_ship.py, line 3: parameter K: expected lower bound < upper bound, found 2.0 and 1.0.",
        ),
        (
            "from shaftprint.catalogue import structure\n\nCL4 = structure('CL4').held_at(zeta=0.5)",
            "my_ship.py:CL4",
            "my_ship.py:CL4: its name CL4 is that of a shipped structure; give it its own, with "
            'dataclasses.replace(structure, name="...").',
        ),
        (
            """
            from shaftprint.models import FunctionBlock, Parameter, Structure

            def lag(s, t):
                return 1.0 / (s * t + 1.0) if t > 0.0 else 0.0 * s

            x = Structure(name="X", title="x", input="M_s", outputs={
                "n": FunctionBlock(lag, (Parameter("T", "s", 0.0, 1.0, 0.5, "time"),))})
            """,
            "my_ship.py:x",
            "my_ship.py, line 5: ValueError: The truth value of an array with more than one element is ambiguous.",
        ),
        (
            """
            from shaftprint.models import FunctionBlock, Parameter, Structure

            x = Structure(name="X", title="x", input="M_s", outputs={
                "n": FunctionBlock(lambda s, t: t * abs(s) * 1j, (Parameter("T", "s", 0.0, 1.0, 0.5, "time"),))})
            """,
            "my_ship.py:x",
            "my_ship.py:x: structure X, block FunctionBlock of T: its response at -s is not the conjugate",
        ),
    ],
)
def test_what_is_wrong_with_a_file_is_one_sentence(run, written, tmp_path, text, name, message):
    (tmp_path / "folder.py").mkdir()
    if text is not None:
        written(text, name.rpartition(":")[0] or name)
    result = run("structures", name)
    assert result.exit_code == 1
    assert result.stderr.startswith("Error: ")
    assert message in result.stderr
    assert len(result.stderr.splitlines()) == 1
    assert "Traceback" not in result.output


def test_two_structures_of_one_name_cannot_stand_beside_each_other(written):
    written(CORE)
    written(CORE, "sister.py")
    with pytest.raises(StructureError, match=r"two structures have the name MY-CORE, my_ship\.py:my_core and si"):
        chosen_structures(["my_ship.py:my_core", "sister.py:my_core"])


def test_a_fault_while_a_file_runs_leaves_the_path_as_it_was(written):
    written("raise ValueError('x')")
    before = list(sys.path), set(sys.modules)
    with pytest.raises(StructureError):
        chosen_structures(["my_ship.py:x"])
    assert list(sys.path) == before[0]


@pytest.mark.slow
def test_a_structure_in_names_of_ones_own_is_known_by_its_roles(run, recording, written, tmp_path):
    """``J_aft`` in seconds gets kg m2, the vessel file's value, a budget and its place in a comparison."""
    written(LINE)
    for name, more in (("first", ()), ("second", ("--no-report",))):
        result = run("identify", recording, *GIVEN, "--structure", "my_ship.py:line", *more, "-o", tmp_path / name)
        assert result.exit_code == 0, result.stderr
    found = read_fingerprint(tmp_path / "first" / "fingerprint.json")
    inertia, action = found.quantity("I_dn"), found.quantity("governor proportional action")
    # the truth of the simulated tug, and the torsional vibration calculation of its vessel file
    assert abs(inertia.value - 17.0) < 3.0 * inertia.std < 1.5
    assert inertia.expected == pytest.approx(17.0, rel=1e-3)
    assert action.unit == "N m/rpm"
    assert action.value / found.quantity("P").value == pytest.approx(
        found.conditions.shaft_torque.value / found.conditions.engine_speed.value
    )
    # of the inertia upstream the vessel file knows as much as of tau_up
    assert set(found.priors) == {"J_fore", "slope"}
    assert "TVC" in found.priors["J_fore"].sources
    budget = {row.name: row.variances for row in found.budget.rows}
    assert "TVC" in budget["P"]
    assert {"gauge scale"} <= set(budget["I_dn"])
    compared = run("compare", tmp_path / "first", tmp_path / "second")
    assert compared.exit_code == 0, compared.stderr
    assert "I_dn" in compared.stdout
    assert "J_aft (see I_dn)" in compared.stdout
