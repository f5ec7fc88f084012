"""An exported FMU in tools of others: the same step and sine in each, beside shaftprint's own simulation.

``python -m benchmarks.hosts`` runs all that are installed. A tool runs in a process of its own, which it may take down:
``python -m benchmarks.hosts TOOL FMU DRIVE`` prints what one gives, as JSON. A drive is a JSON file with the step
``step_s``, the set points ``set_point`` that are held from each step to the next, and ``parameters`` by name.

The hosts are no dependencies of anything else; in an environment of your own: ``pip install libcosimpy ecospy tbb
fmuloader pathsim-fmi cofmupy``, and with Python 3.12 or newer ``modelica``.
"""

import ctypes
import importlib.util
import json
import math
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Literal

import numpy as np

if TYPE_CHECKING:
    from shaftprint.arrays import FloatArray
    from shaftprint.export import ExportedModel

SET_POINT: Final = "engine_speed_set_point"
OUTPUTS: Final = ("engine_speed", "shaft_torque")
LONGEST_S: Final = 120.0

Rows = list[list[float]]
"""Speed and torque at the start and after each step."""


def _references(path: str) -> tuple[Any, dict[str, int]]:
    """Return the description of an FMU, and the references of its variables by name."""
    import fmpy

    description = fmpy.read_model_description(path)
    return description, {variable.name: variable.valueReference for variable in description.modelVariables}


def by_fmpy(path: str, drive: Mapping[str, Any], kind: str = "CoSimulation") -> Rows:
    """Return what ``fmpy.simulate_fmu`` gives; of two rows at one time the first, that before the event."""
    import fmpy

    step_s, held = drive["step_s"], drive["set_point"]
    time = np.arange(len(held)) * step_s
    rows = fmpy.simulate_fmu(
        path,
        input=np.array(list(zip(time, held, strict=True)), dtype=[("time", float), (SET_POINT, float)]),
        start_values={SET_POINT: held[0], **drive["parameters"]},
        stop_time=time[-1],
        step_size=step_s,
        output_interval=step_s,
        output=list(OUTPUTS),
        fmi_type=kind,
    )
    first = np.searchsorted(rows["time"], time - 1e-9)
    return [[float(rows[name][at]) for name in OUTPUTS] for at in first]


def by_fmpy_solver(path: str, drive: Mapping[str, Any]) -> Rows:
    """Return the same of FMPy's own solver, in model exchange."""
    return by_fmpy(path, drive, "ModelExchange")


def by_fmuloader(path: str, drive: Mapping[str, Any]) -> Rows:
    """Return what the functions of the standard give one by one, as fmuloader calls them."""
    from fmuloader import fmi2, fmi3

    description, references = _references(path)
    is_old = description.fmiVersion.startswith("2")
    name = description.coSimulation.modelIdentifier
    with (fmi2.Fmi2Slave if is_old else fmi3.Fmi3Slave)(path, model_identifier=name) as own:
        if is_old:
            own.instantiate("tug", fmi2.Fmi2Type.CO_SIMULATION, guid=description.guid)
            own.setup_experiment(start_time=0.0)
        else:
            own.instantiate_co_simulation("tug", instantiation_token=description.instantiationToken)
        set_values = own.set_real if is_old else own.set_float64
        get_values = own.get_real if is_old else own.get_float64
        own.enter_initialization_mode()
        start = {SET_POINT: drive["set_point"][0], **drive["parameters"]}
        set_values([references[one] for one in start], list(start.values()))
        own.exit_initialization_mode()
        outputs = [references[one] for one in OUTPUTS]
        found = [list(get_values(outputs))]
        for k, value in enumerate(drive["set_point"][:-1]):
            set_values([references[SET_POINT]], [value])
            own.do_step(k * drive["step_s"], drive["step_s"])
            found.append(list(get_values(outputs)))
        own.terminate()
        own.free_instance()
    return found


def by_ecospy(path: str, drive: Mapping[str, Any]) -> Rows:
    """Return what ecos gives, with the parameters as a set by its name."""
    # its library asks the system for that of the package tbb
    for place in Path(sys.prefix, "lib").glob("libtbb.so.12"):
        ctypes.CDLL(str(place))
    from ecospy import EcosSimulation, EcosSimulationStructure

    start = {SET_POINT: float(drive["set_point"][0]), **drive["parameters"]}
    with EcosSimulationStructure() as system:
        system.add_model("line", path)
        system.add_parameter_set("start", {f"line::{name}": value for name, value in start.items()})
        with EcosSimulation(structure=system, step_size=drive["step_s"]) as run:
            run.init(parameter_set="start")
            found = [[run.get_real(f"line::{name}") for name in OUTPUTS]]
            for value in drive["set_point"][:-1]:
                run.set_real(f"line::{SET_POINT}", float(value))
                run.step()
                found.append([run.get_real(f"line::{name}") for name in OUTPUTS])
            run.terminate()
    return found


GROUPS: Final = """<?xml version="1.0" encoding="UTF-8"?>
<OspSystemStructure xmlns="http://opensimulationplatform.com/MSMI/OSPSystemStructure" version="0.1">
  <StartTime>0.0</StartTime>
  <BaseStepSize>{step_s!r}</BaseStepSize>
  <Algorithm>fixedStep</Algorithm>
  <Simulators>
    <Simulator name="port" source="{fmu}" stepSize="{step_s!r}"><InitialValues>{values}</InitialValues></Simulator>
    <Simulator name="starboard" source="{fmu}" stepSize="{step_s!r}"/>
  </Simulators>
  <Connections>
    <VariableGroupConnection>
      <VariableGroup simulator="port" name="engine_speed"/>
      <VariableGroup simulator="starboard" name="engine_speed_set_point"/>
    </VariableGroupConnection>
  </Connections>
</OspSystemStructure>
"""


def by_libcosimpy(path: str, drive: Mapping[str, Any]) -> Rows:
    """Return what libcosim gives of one line whose group of its speed is the set point of a second one.

    Three columns more are of the second line: its set point, speed and torque. Its description must lie beside the FMU.
    """
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimManipulator import CosimManipulator
    from libcosimpy.CosimObserver import CosimObserver

    description, references = _references(path)
    start = {SET_POINT: float(drive["set_point"][0]), **drive["parameters"]}
    values = "".join(f'<InitialValue variable="{name}"><Real value="{value!r}"/></InitialValue>'
                     for name, value in start.items())  # fmt: skip
    with tempfile.TemporaryDirectory() as folder:
        for file in (Path(path), Path(path).with_name(f"{description.modelName}_OspModelDescription.xml")):
            shutil.copy(file, folder)
        place = Path(folder) / "OspSystemStructure.xml"
        place.write_text(GROUPS.format(step_s=drive["step_s"], fmu=Path(path).name, values=values), encoding="utf-8")
        run = CosimExecution.from_osp_config_file(str(place))
        observer, manipulator = CosimObserver.create_last_value(), CosimManipulator.create_override()
        run.add_observer(observer)
        run.add_manipulator(manipulator)
        port, starboard = (run.slave_index_from_instance_name(name) for name in ("port", "starboard"))
        outputs = [references[name] for name in OUTPUTS]
        found = []
        for value in drive["set_point"][:-1]:
            manipulator.slave_real_values(port, [references[SET_POINT]], [float(value)])
            if not run.step():
                raise RuntimeError("libcosim: the step failed")
            found.append(
                [
                    *observer.last_real_values(port, outputs),
                    *observer.last_real_values(starboard, [references[SET_POINT], *outputs]),
                ]
            )
    # what it was before the first step cannot be asked for
    return [[math.nan] * 5, *found]


def _by_pathsim(block: Any, solver: Any, drive: Mapping[str, Any], *, moved: Callable[[float], float]) -> Rows:
    from pathsim import Connection, Simulation
    from pathsim.blocks import Scope, Source

    step_s, count = drive["step_s"], len(drive["set_point"])
    source, scope = Source(moved), Scope(sampling_period=None)
    run = Simulation(
        [source, block, scope],
        [Connection(source, block[SET_POINT]), *(Connection(block[name], scope[i]) for i, name in enumerate(OUTPUTS))],
        dt=step_s,
        Solver=solver,
        log=False,
    )
    run.run((count - 1) * step_s, adaptive=False)
    time, values = scope.read()
    places = np.searchsorted(time, np.arange(count) * step_s - 1e-9)
    return [[float(values[i][min(place, len(time) - 1)]) for i in range(len(OUTPUTS))] for place in places]


def by_pathsim(path: str, drive: Mapping[str, Any]) -> Rows:
    """Return what PathSim gives in co-simulation, whose rows of the end of a step stand at its beginning, put right."""
    from pathsim.solvers import SSPRK22
    from pathsim_fmi import CoSimulationFMU

    step_s, held = drive["step_s"], drive["set_point"]
    block = CoSimulationFMU(path, start_values={SET_POINT: held[0], **drive["parameters"]}, dt=step_s)
    before = list(map(float, block.outputs.to_array()))

    def moved(time: float) -> float:
        return float(held[min(int(time / step_s + 1e-6), len(held) - 1)])

    return [before, *_by_pathsim(block, SSPRK22, drive, moved=moved)[:-1]]


def by_pathsim_solver(path: str, drive: Mapping[str, Any]) -> Rows:
    """Return what PathSim's own solver gives in model exchange, the set point straight from each step to the next."""
    from pathsim.solvers import RK4
    from pathsim_fmi import ModelExchangeFMU

    step_s, held = drive["step_s"], drive["set_point"]
    time = np.arange(len(held)) * step_s
    block = ModelExchangeFMU(path, start_values={SET_POINT: held[0], **drive["parameters"]})
    return _by_pathsim(block, RK4, drive, moved=lambda now: float(np.interp(now, time, held)))


def by_cofmupy(path: str, drive: Mapping[str, Any]) -> Rows:
    """Return what CoFMPy gives; it sets every input to zero in initialisation that has no start value there."""
    from cofmupy import Coordinator

    step_s, held = drive["step_s"], drive["set_point"]
    with tempfile.TemporaryDirectory() as folder:
        table = Path(folder) / "set_point.csv"
        rows = (f"{k * step_s!r},{value!r}\n" for k, value in enumerate(held))
        table.write_text("t," + SET_POINT + "\n" + "".join(rows), encoding="utf-8")
        config = {
            "fmus": [{"id": "line", "path": path, "initialization": {SET_POINT: held[0], **drive["parameters"]}}],
            "connections": [
                {
                    "source": {"type": "csv", "path": str(table), "variable": SET_POINT, "interpolation": "previous"},
                    "target": {"id": "line", "variable": SET_POINT},
                }
            ],
            "cosim_method": "jacobi",
        }
        place = Path(folder) / "system.json"
        place.write_text(json.dumps(config), encoding="utf-8")
        run = Coordinator()
        run.start(str(place))
        run.run_simulation(step_size=step_s, end_time=(len(held) - 1) * step_s)
        results = run.get_results()
    series = [list(map(float, results["line", name])) for name in OUTPUTS]
    return [[math.nan, math.nan], *map(list, zip(*series, strict=True))][: len(held)]


HOSTS: Final[Mapping[str, tuple[str, Callable[[str, Mapping[str, Any]], Rows]]]] = {
    "fmpy": ("fmpy", by_fmpy),
    "fmpy-solver": ("fmpy", by_fmpy_solver),
    "fmuloader": ("fmuloader", by_fmuloader),
    "ecospy": ("ecospy", by_ecospy),
    "libcosimpy": ("libcosimpy", by_libcosimpy),
    "pathsim": ("pathsim_fmi", by_pathsim),
    "pathsim-solver": ("pathsim_fmi", by_pathsim_solver),
    "cofmupy": ("cofmupy", by_cofmupy),
}


def is_installed(host: str) -> bool:
    """Return whether a host can be imported here."""
    return importlib.util.find_spec(HOSTS[host][0]) is not None


def run_host(host: str, path: Path, drive: Mapping[str, Any], folder: Path) -> Rows:
    """Return what a host gives, in a process of its own."""
    place = folder / f"{host}.json"
    place.write_text(json.dumps(drive), encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-m", "benchmarks.hosts", host, str(path), str(place)],
        capture_output=True, text=True, timeout=LONGEST_S, check=False, cwd=Path(__file__).parents[1],
    )  # fmt: skip
    if done.returncode != 0:
        raise RuntimeError(f"{host} ended with {done.returncode}: {done.stderr[-2000:]}")
    rows: Rows = json.loads(done.stdout.splitlines()[-1])
    return rows


SPEED_RPM, TORQUE_NM, STEP_S = 1183.8, 1740.0, 0.01
DRIVES: Final[Mapping[str, Callable[["FloatArray"], "FloatArray"]]] = {
    "step": lambda time: SPEED_RPM + np.where(time >= 1.0 - 1e-9, 20.0, 0.0),
    "sine": lambda time: SPEED_RPM + 10.0 * np.sin(time),
}
PARAMETERS: Final = {"K_p": 1.7, "t_d": 0.0291, "working_point.shaft_torque": 1700.0}


def exported_line(folder: Path, version: Literal[2, 3]) -> "tuple[ExportedModel, Path]":
    """Return a closed loop, and the FMU of it for this computer with its description for OSP."""
    # here, so that the process of a host need not import it
    from shaftprint.catalogue import structure
    from shaftprint.export import ExportedModel, write_fmu, write_osp

    line = structure("GAUGE-CLOSED")
    model = ExportedModel(
        title="simulated tug",
        structure=line,
        values=line.vector({"t_d": 0.0703, "t_sp": 0.0518}),
        engine_speed_rpm=SPEED_RPM,
        shaft_torque_nm=TORQUE_NM,
    )
    path = folder / f"line{version}.fmu"
    write_osp(model, path)
    return model, write_fmu(model, path, version=version).path


def largest_differences(
    model: "ExportedModel", drive: Mapping[str, Any], rows: Rows, *, straight: bool = False
) -> tuple[float, float]:
    """Return the largest differences of speed and torque from shaftprint's simulation, over the motion of each.

    The set point is held from each step to the next, or straight. The parameters are those that were set in the host.
    """
    from shaftprint.simulation import simulate, simulate_exactly

    set_point = np.array(drive["set_point"])
    time = np.arange(set_point.size) * drive["step_s"]
    own = {name: value for name, value in drive["parameters"].items() if "." not in name}
    values = dict(zip(model.structure.names, model.values, strict=True)) | own
    scale = (SPEED_RPM, drive["parameters"].get("working_point.shaft_torque", TORQUE_NM))
    deviation = {"n_set": set_point / SPEED_RPM - 1.0}
    vector = model.structure.vector(values)
    if straight:
        trace = simulate(model.structure, vector, time, deviation, longest_step_s=5e-4)
    else:
        trace = simulate_exactly(model.structure, vector, time, deviation, hold=True, longest_step_s=5e-4)
    found = np.array(rows)
    expected = [size * (1.0 + trace.outputs[name]) for size, name in zip(scale, ("n", "M_s"), strict=True)]
    first, second = (
        float(np.nanmax(np.abs(found[:, i] - column)) / np.ptp(column)) for i, column in enumerate(expected)
    )
    return first, second


def drive_of(kind: str, last_s: float = 6.0) -> dict[str, Any]:
    """Return a drive by its name."""
    time = np.arange(round(last_s / STEP_S) + 1) * STEP_S
    return {"step_s": STEP_S, "set_point": DRIVES[kind](time).tolist(), "parameters": PARAMETERS}


def _compare(folder: Path) -> list[tuple[str, ...]]:
    table = []
    models = {version: exported_line(folder, version) for version in (2, 3)}
    for host in HOSTS:
        for version, (model, path) in models.items():
            cells = []
            for kind in DRIVES:
                drive = drive_of(kind)
                try:
                    rows = run_host(host, path, drive, folder)
                except (RuntimeError, subprocess.TimeoutExpired) as error:
                    cells.append(str(error).strip().splitlines()[-1][:80])
                    continue
                ways = [largest_differences(model, drive, rows, straight=way) for way in (False, True)]
                cells.append(" ".join(f"{number:.0e}" for number in min(ways, key=max)))
            if is_installed(host):
                table.append((host, f"{version}.0", *cells))
    return table


def main() -> None:
    """Run one host and print what it gives as JSON, or all and print the table."""
    if len(sys.argv) > 1:
        host, path, place = sys.argv[1:]
        print(json.dumps(HOSTS[host][1](path, json.loads(Path(place).read_text(encoding="utf-8")))))
        return
    from benchmarks.timing import print_table

    with tempfile.TemporaryDirectory() as folder:
        header = ("host", "FMI", *(f"{kind}: speed, torque" for kind in DRIVES))
        print_table("Largest difference over the motion", header, _compare(Path(folder)))


if __name__ == "__main__":
    main()
