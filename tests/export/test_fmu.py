"""An FMU as other programs see it: its description, its functions, its state, its parameters, its binaries."""

import ctypes
import shutil
import threading
import zipfile
from xml.etree import ElementTree as ET

import numpy as np
import pytest

from shaftprint.catalogue import limited, structure
from shaftprint.errors import ExportError
from shaftprint.export import write_fmu
from shaftprint.export._fmu_build import PLATFORMS, host_platform
from shaftprint.models import Parameter
from shaftprint.simulation import simulate

SPEED_RPM, TORQUE_NM = 1183.8, 1740.0
GAUGE = structure("GAUGE-CLOSED"), {"t_d": 0.0437, "t_sp": 0.1133}
TORQUE = limited("torque"), {"t_d": 0.0437, "t_sp": 0.1133, "m_max": 1.1}
TIME = np.arange(101) * 0.02
SET_POINT = SPEED_RPM * (1.0 + np.where(TIME >= 0.1, 0.05, 0.0))


def same(one, two):
    return all(np.array_equal(one[name], two[name]) for name in one)


# ---- description ----


@pytest.mark.parametrize("version", [2, 3])
@pytest.mark.parametrize(
    "name",
    [
        "OL1",
        "OL5",
        "CL1",
        "CL4",
        "CL4-PADE5",
        "INITIAL",
        "GAUGE-CLOSED",
        "GAUGE-ECU",
        "GOVERNOR",
        "FREE-PITCH",
        "GAUGE-PITCH",
        "GAUGE-COMBINATOR",
    ],
)
def test_fmpy_finds_nothing_to_complain_about(exported, tmp_path, name, version):
    validation = pytest.importorskip("fmpy.validation", reason="FMPy checks the description")
    path = tmp_path / "model.fmu"
    write_fmu(exported(structure(name)), path, version=version, platforms=[])
    assert validation.validate_fmu(str(path)) == []


@pytest.mark.parametrize("version", [2, 3])
def test_fmpy_finds_nothing_to_complain_about_in_limits(exported, tmp_path, version):
    validation = pytest.importorskip("fmpy.validation", reason="FMPy checks the description")
    path, limits = tmp_path / "model.fmu", limited("torque", "rate", "smoke", "deadband", period_s=0.01)
    curve = limited("torque", curve=((-0.5, 0.6), (0.0, 1.0), (0.3, 0.9)), name="CURVE")
    for chosen in (limits, curve):
        write_fmu(exported(chosen), path, version=version, platforms=[], overwrite=True)
        assert validation.validate_fmu(str(path)) == []


def described(exported, path, chosen, version=2, **more):
    fmpy = pytest.importorskip("fmpy", reason="FMPy reads the description")
    write_fmu(exported(chosen), path, version=version, platforms=[], **more)
    return fmpy.read_model_description(path)


def test_variables_are_physical(exported, tmp_path):
    found = described(exported, tmp_path / "tug.fmu", GAUGE[0])
    named = {variable.name: variable for variable in found.modelVariables}
    assert {n for n, v in named.items() if v.causality == "input"} == {"engine_speed_set_point"}
    assert {n for n, v in named.items() if v.causality == "output"} == {"engine_speed", "shaft_torque"}
    assert float(named["engine_speed_set_point"].start) == SPEED_RPM
    assert (named["engine_speed"].unit, named["shaft_torque"].unit) == ("rpm", "N m")
    (rpm,) = (unit for unit in found.unitDefinitions if unit.name == "rpm")
    assert float(rpm.baseUnit.factor) == pytest.approx(2.0 * np.pi / 60.0, rel=1e-15)
    (torque,) = (unit for unit in found.unitDefinitions if unit.name == "N m")
    assert (torque.baseUnit.kg, torque.baseUnit.m, torque.baseUnit.s) == (1, 2, -2)
    tunable = {n for n, v in named.items() if v.causality == "parameter" and v.variability == "tunable"}
    # what is held at zero is no part of the equations
    zero = {p.name for p in GAUGE[0].parameters if p.held and p.value == 0.0}
    expected = set(GAUGE[0].names) - zero
    assert tunable == expected | {"working_point.engine_speed", "working_point.shaft_torque"}


def test_no_variable_of_fmi_3_is_an_array(exported, tmp_path):
    """FMPy writes an array as one field of text, and other hosts read none."""
    limits = limited("torque", curve=((-0.5, 0.6), (0.0, 1.0), (0.3, 0.9)), name="CURVE")
    for number, chosen in enumerate((GAUGE[0], structure("GAUGE-PITCH"), limits)):
        found = described(exported, tmp_path / f"tug{number}.fmu", chosen, version=3)
        assert len(found.modelVariables) > 10
        assert not any(variable.dimensions for variable in found.modelVariables)


@pytest.mark.parametrize(("name", "reached"), [("CL1", {"shaft_torque"}), ("CL4", set())])
def test_outputs_say_which_inputs_they_show_at_once(exported, tmp_path, name, reached):
    """A PI governor without delay gives torque at once; speed needs the inertia, and a delay lets nothing through."""
    found = described(exported, tmp_path / "tug.fmu", structure(name))
    inputs = {variable.name for variable in found.modelVariables if variable.causality == "input"}
    shown = {u.variable.name for u in found.outputs if inputs & {v.name for v in u.dependencies}}
    assert shown == reached


@pytest.mark.parametrize("version", [2, 3])
def test_the_name_of_the_model_is_a_name_and_its_title_is_in_the_words(exported, tmp_path, version):
    """OMSimulator refuses other names; libcosim and ecos look for files and sets by them."""
    found = described(exported, tmp_path / "Stan-Tug 1205, port.fmu", GAUGE[0], version=version)
    assert found.modelName == found.coSimulation.modelIdentifier == "Stan_Tug_1205__port"
    assert found.description.startswith("simulated tug, GAUGE-CLOSED: ")


@pytest.mark.parametrize("name", ["GAUGE-CLOSED", "FREE-PITCH", "GAUGE-HYBRID"])
def test_the_reference_of_a_state_is_its_place(exported, tmp_path, name):
    """OMSimulator takes the reference of a state, which its derivative names, for the state's place in the list."""
    write_fmu(exported(structure(name)), tmp_path / "tug.fmu", version=3, platforms=[], samples=0)
    with zipfile.ZipFile(tmp_path / "tug.fmu") as archive:
        root = ET.fromstring(archive.read("modelDescription.xml"))  # noqa: S314
    listed = list(root.find("ModelVariables"))
    derivatives = [variable for variable in listed if variable.get("derivative")]
    assert derivatives
    for variable in derivatives:
        state = listed[int(variable.get("derivative")) - 1]
        assert state.get("valueReference") == variable.get("derivative")
        assert variable.get("name") == f"der({state.get('name')})"


def test_equal_models_give_equal_files(exported, tmp_path):
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
        write_fmu(exported(GAUGE[0]), tmp_path / name / "tug.fmu", platforms=[])
    assert (tmp_path / "one" / "tug.fmu").read_bytes() == (tmp_path / "two" / "tug.fmu").read_bytes()


# ---- functions and state ----


@pytest.mark.slow
@pytest.mark.parametrize("version", [2, 3])
def test_binary_has_every_function_of_the_standard(fmu, declared_functions, tmp_path, version):
    with zipfile.ZipFile(fmu(*GAUGE, version=version)) as archive:
        (name,) = (name for name in archive.namelist() if name.startswith("binaries/"))
        library = ctypes.CDLL(archive.extract(name, tmp_path))
    names = declared_functions(version)
    assert len(names) > 40
    assert [name for name in sorted(names) if not hasattr(library, name)] == []


@pytest.mark.slow
def test_versions_agree(fmu, slave, solved):
    found = []
    for version in (2, 3):
        with slave(fmu(*TORQUE, version=version)) as own:
            own.start()
            found.append(own.run(TIME, SET_POINT))
        with solved(fmu(*TORQUE, version=version)) as own:
            own.start()
            other = own.solve(TIME, lambda t, begin, end: SPEED_RPM * (1.05 if begin + end >= 0.2 else 1.0), [0.1])
        assert np.abs(other["shaft_torque"] - found[-1]["shaft_torque"]).max() < 1e-5 * TORQUE_NM
    assert same(*found)


@pytest.mark.slow
@pytest.mark.parametrize("version", [2, 3])
def test_state_is_taken_and_restored(fmu, slave, version):
    middle = 30
    with slave(fmu(*TORQUE, version=version)) as own:
        own.start()
        own.run(TIME[: middle + 1], SET_POINT)
        state = own.fmu.getFMUState()
        data = own.fmu.serializeFMUstate(state) if version == 2 else own.fmu.serializeFMUState(state)
        first = own.run(TIME[middle:], SET_POINT[middle:])
        own.fmu.setFMUState(state)
        assert same(own.run(TIME[middle:], SET_POINT[middle:]), first)
        own.fmu.freeFMUState(state)
    with slave(fmu(*TORQUE, version=version)) as own:
        own.start()
        read = own.fmu.deSerializeFMUstate if version == 2 else own.fmu.deserializeFMUState
        own.fmu.setFMUState(read(data))
        assert same(own.run(TIME[middle:], SET_POINT[middle:]), first)
        with pytest.raises(Exception, match=r"[Ee]rror|failed"):
            read(data[:-1])


def test_reset_begins_anew(fmu, slave):
    with slave(fmu(*TORQUE)) as own:
        own.start(K_p=1.0)
        other = own.run(TIME, SET_POINT)
        own.fmu.reset()
        own.start()
        first = own.run(TIME, SET_POINT)
        own.fmu.reset()
        own.start()
        assert same(own.run(TIME, SET_POINT), first)
        assert not same(first, other)


# ---- parameters ----


@pytest.mark.slow
def test_parameters_that_are_set_are_those_of_another_export(fmu, slave):
    changed = {"K_p": 1.7, "t_d": 0.0291, "tau_dn": 0.3, "omega_n": 11.0}
    chosen, values = GAUGE
    with slave(fmu(chosen, values)) as own:
        own.start(**changed)
        found = own.run(TIME, SET_POINT)
    with slave(fmu(chosen, {**values, **changed})) as own:
        own.start()
        assert same(own.run(TIME, SET_POINT), found)


@pytest.mark.slow
def test_parameters_are_tuned_during_the_run(fmu, slave):
    """At the working point a governor's gains and a delay change nothing; the step that follows shows the new ones."""
    chosen, values = GAUGE
    changed = {"K_p": 1.7, "t_d": 0.0291}
    late = TIME + 1.0
    with slave(fmu(chosen, values)) as own:
        own.start()
        own.fmu.doStep(0.0, 0.5)
        own.set(**changed)
        own.fmu.doStep(0.5, 0.5)
        assert own.get("engine_speed", "shaft_torque") == pytest.approx([SPEED_RPM, TORQUE_NM], rel=1e-12)
        found = own.run(late, SET_POINT)
    with slave(fmu(chosen, {**values, **changed})) as own:
        own.start()
        own.fmu.doStep(0.0, 1.0)
        other = own.run(late, SET_POINT)
    for name in found:
        assert found[name] == pytest.approx(other[name], rel=1e-9)


@pytest.mark.slow
def test_working_point_scales_inputs_and_outputs(fmu, slave):
    chosen, values = GAUGE
    with slave(fmu(chosen, values)) as own:
        own.start()
        first = own.run(TIME, SET_POINT)
    point = {"working_point.engine_speed": 2.0 * SPEED_RPM, "working_point.shaft_torque": 3.0 * TORQUE_NM}
    with slave(fmu(chosen, values)) as own:
        own.start(2.0 * SPEED_RPM, **point)
        found = own.run(TIME, 2.0 * SET_POINT)
    assert found["engine_speed"] == pytest.approx(2.0 * first["engine_speed"], rel=1e-12)
    assert found["shaft_torque"] == pytest.approx(3.0 * first["shaft_torque"], rel=1e-12)


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_no_limit_that_is_no_number(fmu, slave, exported, tmp_path, value):
    with slave(fmu(*TORQUE)) as own:
        for name in ("m_max", "engine_speed_set_point"):
            with pytest.raises(Exception, match=r"[Ee]rror|failed"):
                own.set(**{name: value})
        own.start()
        assert own.get("m_max", "engine_speed_set_point") == [TORQUE[1]["m_max"], SPEED_RPM]
        assert np.isfinite(own.run(TIME, SET_POINT)["shaft_torque"]).all()
    with pytest.raises(ExportError, match="none of m_max"):
        exported(TORQUE[0], {"m_max": value})
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
def test_step_is_refined_for_fast_parameters(fmu, slave):
    """A lag of half a millisecond is out of reach of a step of 1 ms: 2.8 times the lag is the end of stability."""
    chosen = structure("GAUGE-CLOSED").free_between(T_filter=(1e-4, 1.0))
    values = {**GAUGE[1], "T_filter": 0.1}
    with slave(fmu(chosen, values)) as own:
        own.start(T_filter=3e-4)
        own.fmu.doStep(0.0, 0.1)
        (taken,) = own.get("internal_step_taken")
        assert 1e-6 < taken < 3e-4
        own.set(engine_speed_set_point=1.05 * SPEED_RPM)
        own.fmu.doStep(0.1, 20.0)
        assert own.get("engine_speed")[0] == pytest.approx(1.05 * SPEED_RPM, rel=1e-6)


def test_time_constants_that_no_step_can_follow(exported, tmp_path):
    chosen = structure("GAUGE-CLOSED").free_between(T_filter=(1e-12, 1.0))
    with pytest.raises(ExportError, match="pole at"):
        write_fmu(exported(chosen, {"T_filter": 1e-9}), tmp_path / "tug.fmu", platforms=[])
    assert list(tmp_path.iterdir()) == []


# ---- samples ----


@pytest.mark.slow
def test_samples_scatter_as_the_covariance_says(exported, fmu, slave, tmp_path):
    """The standard deviation over samples is that of exact derivatives and the covariance."""
    fmu(*GAUGE)  # skips where there is no compiler
    chosen, values = GAUGE
    uncertain, count = ("K_p", "K_i", "t_d"), 400
    std = np.array([0.02, 0.03, 0.001])
    correlation = np.array([[1.0, 0.6, 0.0], [0.6, 1.0, -0.3], [0.0, -0.3, 1.0]])
    covariance = correlation * np.outer(std, std)
    model = exported(chosen, values, uncertain=uncertain, covariance=covariance)
    path = tmp_path / "samples.fmu"
    rng = np.random.default_rng(11)
    write_fmu(model, path, platforms=[host_platform()], samples=count, rng=rng)
    at = 0.5
    trace = simulate(
        chosen,
        model.values,
        np.linspace(0.0, at, 501),
        {"n_set": np.full(501, 0.05) * (np.arange(501) > 0)},
        wanted=uncertain,
    )
    slopes = SPEED_RPM * trace.derivatives["n"][:, -1]
    found = []
    with slave(path) as own:
        for number in range(count + 1):
            own.choose(posterior_sample=number)
            own.start()
            own.set(engine_speed_set_point=1.05 * SPEED_RPM)
            own.fmu.doStep(0.0, at)
            found += own.get("engine_speed")
            own.fmu.reset()
        with pytest.raises(Exception, match=r"[Ee]rror|failed"):
            own.choose(posterior_sample=count + 1)
    with slave(fmu(*GAUGE)) as own:
        own.start()
        own.set(engine_speed_set_point=1.05 * SPEED_RPM)
        own.fmu.doStep(0.0, at)
        assert found[0] == pytest.approx(own.get("engine_speed")[0], rel=1e-12)
    # the standard deviation of 400 samples is known to 3.5 %
    assert np.std(found[1:]) == pytest.approx(np.sqrt(slopes @ covariance @ slopes), rel=0.12)


def test_samples_need_a_covariance_and_a_source(exported, tmp_path):
    with pytest.raises(ExportError, match="expected parameters with a covariance"):
        write_fmu(exported(GAUGE[0]), tmp_path / "a.fmu", platforms=[], samples=2, rng=np.random.default_rng(0))
    with pytest.raises(ExportError, match="expected rng"):
        write_fmu(exported(GAUGE[0]), tmp_path / "a.fmu", platforms=[], samples=2)


# ---- sources and binaries ----


@pytest.mark.slow
@pytest.mark.parametrize("version", [2, 3])
def test_sources_are_built_by_fmpy(fmu, exported, slave, tmp_path, version, capfd):
    build = pytest.importorskip("fmpy.build", reason="FMPy builds the sources")
    if shutil.which("cmake") is None or shutil.which("cc") is None:
        pytest.skip("FMPy builds sources with cmake and a C compiler")
    chosen, values = TORQUE
    path, folder = tmp_path / "tug.fmu", tmp_path / "tug"
    write_fmu(exported(chosen, values), path, version=version, platforms=[])
    with zipfile.ZipFile(path) as archive:
        assert not any(name.startswith("binaries") for name in archive.namelist())
        archive.extractall(folder)
    (tmp_path / "build").mkdir()
    build.build_platform_binary(folder, tmp_path / "build")
    capfd.readouterr()
    built = tmp_path / "built.fmu"
    with zipfile.ZipFile(built, "w") as archive:
        for file in folder.rglob("*"):
            archive.write(file, file.relative_to(folder).as_posix())
    with slave(built) as own:
        own.start()
        found = own.run(TIME, SET_POINT)
    with slave(fmu(chosen, values, version=version)) as own:
        own.start()
        other = own.run(TIME, SET_POINT)
    for name in found:
        assert found[name] == pytest.approx(other[name], rel=1e-9)


def test_systems_that_are_none(exported, tmp_path):
    with pytest.raises(ExportError, match="no system 'amiga'"):
        write_fmu(exported(*TORQUE), tmp_path / "tug.fmu", platforms=["amiga"])
    assert "win64" in PLATFORMS
    assert list(tmp_path.iterdir()) == []


def test_parameters_with_names_that_c_does_not_take(exported, tmp_path):
    fmpy = pytest.importorskip("fmpy", reason="FMPy reads the description")
    from shaftprint.models import Gain, Integrator, Structure, feedback

    odd = Parameter("gain of 'it'", "rad/s", 0.1, 10.0, 2.0, "a name with blanks & <signs>")
    own = Structure(name="OWN", title="own", input="wanted", outputs={"got": feedback(Gain(odd) * Integrator())})
    path = tmp_path / "own ship.fmu"
    write_fmu(exported(own), path, platforms=[])
    found = fmpy.read_model_description(path)
    names = [variable.name for variable in found.modelVariables]
    assert "'gain of it'" in names
    assert {"wanted", "got"} <= set(names)
    assert found.coSimulation.modelIdentifier == "own_ship"


@pytest.fixture
def compile_by(monkeypatch):
    """Let another function compile the binary of each system."""
    return lambda build: monkeypatch.setattr("shaftprint.export._fmu.build_binary", build)


def test_systems_are_compiled_together_and_stand_in_their_order(exported, tmp_path, monkeypatch, compile_by):
    both, shares = threading.Barrier(2, timeout=10.0), []

    def build(folder, sources, name, binary):
        both.wait()
        binary.write_bytes(name.encode())

    compile_by(build)
    monkeypatch.setattr("os.cpu_count", lambda: 2)
    write_fmu(exported(*TORQUE), tmp_path / "m.fmu", platforms=["win64", "linux64"], progress=shares.append)
    with zipfile.ZipFile(tmp_path / "m.fmu") as archive:
        binaries = [name for name in archive.namelist() if name.startswith("binaries/")]
        assert binaries == ["binaries/win64/m.dll", "binaries/linux64/m.so"]
        assert [archive.read(name) for name in binaries] == [b"win64", b"linux64"]
    assert shares == [0.5, 1.0]


def test_a_compiler_that_fails_costs_its_own_system_only(exported, tmp_path, compile_by):
    def build(folder, sources, name, binary):
        if name == "win64":
            raise ExportError("FMU for win64: no compiler")
        binary.write_bytes(b"")

    compile_by(build)
    written = write_fmu(exported(*TORQUE), tmp_path / "m.fmu", platforms=["win64", "linux64"])
    assert (written.platforms, written.failed) == (("linux64",), ("FMU for win64: no compiler",))
    with zipfile.ZipFile(tmp_path / "m.fmu") as archive:
        assert [name for name in archive.namelist() if name.startswith("bin")] == ["binaries/linux64/m.so"]
    with pytest.raises(ExportError, match="FMU for win64"):
        write_fmu(exported(*TORQUE), tmp_path / "other.fmu", platforms=["win64"])
    assert not (tmp_path / "other.fmu").exists()


def test_this_system_is_compiled_for_by_default(exported, tmp_path, compile_by):
    compile_by(lambda folder, sources, name, binary: binary.write_bytes(b""))
    assert write_fmu(exported(*TORQUE), tmp_path / "m.fmu").platforms == (host_platform(),)


@pytest.mark.slow
def test_what_was_compiled_is_kept(exported, tmp_path, monkeypatch):
    """The second time a compiler that cannot compile any more is not asked; other sources are compiled."""
    if shutil.which("cc") is None:
        pytest.skip("there is no C compiler called cc")
    monkeypatch.setenv("SHAFTPRINT_CACHE", str(tmp_path / "kept"))
    calls = tmp_path / "calls"
    compiler = tmp_path / "cc"
    compiler.write_text(f'#!/bin/sh\necho >> {calls}\nexec {shutil.which("cc")} "$@"\n')
    compiler.chmod(0o755)
    monkeypatch.setattr("shaftprint.export._fmu_build._host_compiler", lambda: str(compiler))
    for _ in range(2):
        write_fmu(exported(*TORQUE), tmp_path / "m.fmu", overwrite=True)
        assert calls.read_text() == "\n"
    write_fmu(exported(*GAUGE), tmp_path / "m.fmu", overwrite=True)
    assert calls.read_text() == "\n\n"
