"""What tools of others make of an FMU, each by its own calls.

A tool runs in a process of its own, which it may take down: ``python -m benchmarks.host_runs TOOL FMU STIMULUS`` prints
what one gives, as JSON, for a ``Stimulus`` in a JSON file.

The hosts are no dependencies of anything else; in an environment of your own: ``pip install fmpy libcosimpy ecospy tbb
fmuloader pathsim-fmi``. CoFMPy asks for an older FMPy, and so for another environment: ``pip install cofmupy``.
"""

import ctypes
import importlib.util
import json
import math
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

if TYPE_CHECKING:
    from shaftprint.arrays import FloatArray

SET_POINT: Final = "engine_speed_set_point"
OUTPUTS: Final = ("engine_speed", "shaft_torque")
LONGEST_S: Final = 120.0

Rows = list[list[float]]
"""Speed and torque at the start and after each step."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Stimulus:
    """What a line is moved by, and with which parameters."""

    step_s: float
    """From each set point to the next [s]."""
    set_point: Sequence[float]
    """Held from each step to the next [rpm]."""
    parameters: Mapping[str, float]
    """Set in the host, by name."""

    @property
    def time_s(self) -> "FloatArray":
        """Time of each set point [s]."""
        return np.arange(len(self.set_point)) * self.step_s

    @property
    def start(self) -> dict[str, float]:
        """Values at the start by their names in the FMU: set point and parameters."""
        return {SET_POINT: self.set_point[0], **self.parameters}


def _references(path: str) -> tuple[Any, dict[str, int]]:
    """Return the description of an FMU, and the references of its variables by name."""
    import fmpy

    description = fmpy.read_model_description(path)
    return description, {variable.name: variable.valueReference for variable in description.modelVariables}


def by_fmpy(path: str, stimulus: Stimulus, kind: str = "CoSimulation") -> Rows:
    """Return what ``fmpy.simulate_fmu`` gives; of two rows at one time the first, that before the event."""
    import fmpy

    time = stimulus.time_s
    rows = fmpy.simulate_fmu(
        path,
        input=np.array(list(zip(time, stimulus.set_point, strict=True)), dtype=[("time", float), (SET_POINT, float)]),
        start_values=stimulus.start,
        stop_time=time[-1],
        step_size=stimulus.step_s,
        output_interval=stimulus.step_s,
        output=list(OUTPUTS),
        fmi_type=kind,
    )
    first = np.searchsorted(rows["time"], time - 1e-9)
    return [[float(rows[name][at]) for name in OUTPUTS] for at in first]


def by_fmpy_solver(path: str, stimulus: Stimulus) -> Rows:
    """Return the same of FMPy's own solver, in model exchange."""
    return by_fmpy(path, stimulus, "ModelExchange")


def by_fmuloader(path: str, stimulus: Stimulus) -> Rows:
    """Return what the functions of the standard give one by one, as fmuloader calls them."""
    from fmuloader import fmi2, fmi3

    description, references = _references(path)
    is_old = description.fmiVersion.startswith("2")
    name = description.coSimulation.modelIdentifier
    with (fmi2.Fmi2Slave if is_old else fmi3.Fmi3Slave)(path, model_identifier=name) as instance:
        if is_old:
            instance.instantiate("tug", fmi2.Fmi2Type.CO_SIMULATION, guid=description.guid)
            instance.setup_experiment(start_time=0.0)
        else:
            instance.instantiate_co_simulation("tug", instantiation_token=description.instantiationToken)
        set_values = instance.set_real if is_old else instance.set_float64
        get_values = instance.get_real if is_old else instance.get_float64
        instance.enter_initialization_mode()
        set_values([references[name] for name in stimulus.start], list(stimulus.start.values()))
        instance.exit_initialization_mode()
        outputs = [references[name] for name in OUTPUTS]
        rows = [list(get_values(outputs))]
        for step, value in enumerate(stimulus.set_point[:-1]):
            set_values([references[SET_POINT]], [value])
            instance.do_step(step * stimulus.step_s, stimulus.step_s)
            rows.append(list(get_values(outputs)))
        instance.terminate()
        instance.free_instance()
    return rows


def by_ecospy(path: str, stimulus: Stimulus) -> Rows:
    """Return what ecos gives, with the parameters as a set by its name."""
    # its library asks the system for that of the package tbb
    for library in Path(sys.prefix, "lib").glob("libtbb.so.12"):
        ctypes.CDLL(str(library))
    from ecospy import EcosSimulation, EcosSimulationStructure

    with EcosSimulationStructure() as system:
        system.add_model("line", path)
        system.add_parameter_set("start", {f"line::{name}": value for name, value in stimulus.start.items()})
        with EcosSimulation(structure=system, step_size=stimulus.step_s) as run:
            run.init(parameter_set="start")
            rows = [[run.get_real(f"line::{name}") for name in OUTPUTS]]
            for value in stimulus.set_point[:-1]:
                run.set_real(f"line::{SET_POINT}", value)
                run.step()
                rows.append([run.get_real(f"line::{name}") for name in OUTPUTS])
            run.terminate()
    return rows


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


def by_libcosimpy(path: str, stimulus: Stimulus) -> Rows:
    """Return what libcosim gives of one line whose group of its speed is the set point of a second one.

    Three columns more are of the second line: its set point, speed and torque. Its description must lie beside the FMU.
    """
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimManipulator import CosimManipulator
    from libcosimpy.CosimObserver import CosimObserver

    description, references = _references(path)
    values = "".join(f'<InitialValue variable="{name}"><Real value="{value!r}"/></InitialValue>'
                     for name, value in stimulus.start.items())  # fmt: skip
    with tempfile.TemporaryDirectory() as folder:
        for file in (Path(path), Path(path).with_name(f"{description.modelName}_OspModelDescription.xml")):
            shutil.copy(file, folder)
        system = Path(folder) / "OspSystemStructure.xml"
        text = GROUPS.format(step_s=stimulus.step_s, fmu=Path(path).name, values=values)
        system.write_text(text, encoding="utf-8")
        run = CosimExecution.from_osp_config_file(str(system))
        observer, manipulator = CosimObserver.create_last_value(), CosimManipulator.create_override()
        run.add_observer(observer)
        run.add_manipulator(manipulator)
        port, starboard = (run.slave_index_from_instance_name(name) for name in ("port", "starboard"))
        outputs = [references[name] for name in OUTPUTS]
        rows = []
        for value in stimulus.set_point[:-1]:
            manipulator.slave_real_values(port, [references[SET_POINT]], [value])
            if not run.step():
                raise RuntimeError("libcosim: the step failed")
            rows.append(
                [
                    *observer.last_real_values(port, outputs),
                    *observer.last_real_values(starboard, [references[SET_POINT], *outputs]),
                ]
            )
    # what it was before the first step cannot be asked for
    return [[math.nan] * 5, *rows]


def _by_pathsim(block: Any, solver: Any, stimulus: Stimulus, *, moved: Callable[[float], float]) -> Rows:
    from pathsim import Connection, Simulation
    from pathsim.blocks import Scope, Source

    source, scope = Source(moved), Scope(sampling_period=None)
    run = Simulation(
        [source, block, scope],
        [Connection(source, block[SET_POINT]), *(Connection(block[name], scope[i]) for i, name in enumerate(OUTPUTS))],
        dt=stimulus.step_s,
        Solver=solver,
        log=False,
    )
    run.run(stimulus.time_s[-1], adaptive=False)
    time, values = scope.read()
    samples = np.searchsorted(time, stimulus.time_s - 1e-9)
    return [[float(values[i][min(sample, len(time) - 1)]) for i in range(len(OUTPUTS))] for sample in samples]


def by_pathsim(path: str, stimulus: Stimulus) -> Rows:
    """Return what PathSim gives in co-simulation, whose rows of the end of a step stand at its beginning, put right."""
    from pathsim.solvers import SSPRK22
    from pathsim_fmi import CoSimulationFMU

    block = CoSimulationFMU(path, start_values=stimulus.start, dt=stimulus.step_s)
    at_start = list(map(float, block.outputs.to_array()))

    def moved(time: float) -> float:
        step = int(time / stimulus.step_s + 1e-6)
        return stimulus.set_point[min(step, len(stimulus.set_point) - 1)]

    return [at_start, *_by_pathsim(block, SSPRK22, stimulus, moved=moved)[:-1]]


def by_pathsim_solver(path: str, stimulus: Stimulus) -> Rows:
    """Return what PathSim's own solver gives in model exchange, the set point straight from each step to the next."""
    from pathsim.solvers import RK4
    from pathsim_fmi import ModelExchangeFMU

    times_s = stimulus.time_s
    block = ModelExchangeFMU(path, start_values=stimulus.start)

    def moved(time: float) -> float:
        return float(np.interp(time, times_s, stimulus.set_point))

    return _by_pathsim(block, RK4, stimulus, moved=moved)


def by_cofmupy(path: str, stimulus: Stimulus) -> Rows:
    """Return what CoFMPy gives; it sets every input to zero in initialisation that has no start value there.

    Its time is a sum of steps, which falls short of some rows of the table by rounding: these are a millionth earlier.
    """
    from cofmupy import Coordinator

    with tempfile.TemporaryDirectory() as folder:
        table = Path(folder) / "set_point.csv"
        times = [max(step - 1e-6, 0.0) * stimulus.step_s for step in range(len(stimulus.set_point))]
        rows = (f"{time!r},{value!r}\n" for time, value in zip(times, stimulus.set_point, strict=True))
        table.write_text("t," + SET_POINT + "\n" + "".join(rows), encoding="utf-8")
        config = {
            "fmus": [{"id": "line", "path": path, "initialization": stimulus.start}],
            "connections": [
                {
                    "source": {"type": "csv", "path": str(table), "variable": SET_POINT, "interpolation": "previous"},
                    "target": {"id": "line", "variable": SET_POINT},
                }
            ],
            "cosim_method": "jacobi",
        }
        system = Path(folder) / "system.json"
        system.write_text(json.dumps(config), encoding="utf-8")
        run = Coordinator()
        run.start(str(system))
        run.run_simulation(step_size=stimulus.step_s, end_time=float(stimulus.time_s[-1]))
        results = run.get_results()
    series = [list(map(float, results["line", name])) for name in OUTPUTS]
    return [[math.nan, math.nan], *map(list, zip(*series, strict=True))][: len(stimulus.set_point)]


HOSTS: Final[Mapping[str, tuple[str, Callable[[str, Stimulus], Rows]]]] = {
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


def run_host(host: str, path: Path, stimulus: Stimulus, folder: Path, *, python: str = sys.executable) -> Rows:
    """Return what a host gives, in a process of its instance, of the interpreter that has it."""
    job = folder / f"{host}.json"
    job.write_text(json.dumps(asdict(stimulus)), encoding="utf-8")
    done = subprocess.run(
        [python, "-m", "benchmarks.host_runs", host, str(path), str(job)],
        capture_output=True, text=True, timeout=LONGEST_S, check=False, cwd=Path(__file__).parents[1],
    )  # fmt: skip
    if done.returncode != 0:
        raise RuntimeError(f"{host} ended with {done.returncode}: {done.stderr[-2000:]}")
    rows: Rows = json.loads(done.stdout.splitlines()[-1])
    return rows


def main() -> None:
    """Run one host and print what it gives as JSON."""
    host, path, job = sys.argv[1:]
    stimulus = Stimulus(**json.loads(Path(job).read_text(encoding="utf-8")))
    print(json.dumps(HOSTS[host][1](path, stimulus)))


if __name__ == "__main__":
    main()
