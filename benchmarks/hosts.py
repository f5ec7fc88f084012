"""An exported FMU in tools of others: the same step and sine in each, beside shaftprint's own simulation.

``python -m benchmarks.hosts`` runs all that are installed; ``host_runs.py`` says how each is installed and called. One
of another environment is named with its interpreter: ``python -m benchmarks.hosts cofmupy=/other/venv/bin/python``.
"""

import argparse
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Final, Literal

import numpy as np

from benchmarks.host_runs import HOSTS, Rows, Stimulus, is_installed, run_host
from benchmarks.timing import print_table
from shaftprint.arrays import FloatArray
from shaftprint.catalogue import structure
from shaftprint.export import ExportedModel, write_fmu, write_osp
from shaftprint.simulation import simulate, simulate_exactly

SPEED_RPM, TORQUE_NM, STEP_S = 1183.8, 1740.0, 0.01
SET_POINTS: Final[Mapping[str, Callable[[FloatArray], FloatArray]]] = {
    "step": lambda time: SPEED_RPM + np.where(time >= 1.0 - 1e-9, 20.0, 0.0),
    "sine": lambda time: SPEED_RPM + 10.0 * np.sin(time),
}
PARAMETERS: Final = {"K_p": 1.7, "t_d": 0.0291, "working_point.shaft_torque": 1700.0}


def exported_line(folder: Path, version: Literal[2, 3]) -> tuple[ExportedModel, Path]:
    """Return a closed loop, and the FMU of it for this computer with its description for OSP."""
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
    model: ExportedModel, stimulus: Stimulus, rows: Rows, *, straight: bool = False
) -> tuple[float, float]:
    """Return the largest differences of speed and torque from shaftprint's simulation, over the motion of each.

    The set point is held from each step to the next, or straight. The parameters are those that were set in the host.
    """
    of_structure = {name: value for name, value in stimulus.parameters.items() if "." not in name}
    values = dict(zip(model.structure.names, model.values, strict=True)) | of_structure
    scale = (SPEED_RPM, stimulus.parameters.get("working_point.shaft_torque", TORQUE_NM))
    deviation = {"n_set": np.array(stimulus.set_point) / SPEED_RPM - 1.0}
    vector = model.structure.vector(values)
    if straight:
        trace = simulate(model.structure, vector, stimulus.time_s, deviation, longest_step_s=5e-4)
    else:
        trace = simulate_exactly(model.structure, vector, stimulus.time_s, deviation, hold=True, longest_step_s=5e-4)
    outputs = np.array(rows)
    expected = [size * (1.0 + trace.outputs[name]) for size, name in zip(scale, ("n", "M_s"), strict=True)]
    first, second = (
        float(np.nanmax(np.abs(outputs[:, i] - column)) / np.ptp(column)) for i, column in enumerate(expected)
    )
    return first, second


def stimulus_of(kind: str, last_s: float = 6.0) -> Stimulus:
    """Return a stimulus by its name."""
    time = np.arange(round(last_s / STEP_S) + 1) * STEP_S
    return Stimulus(step_s=STEP_S, set_point=SET_POINTS[kind](time).tolist(), parameters=PARAMETERS)


def _compare(folder: Path, pythons: Mapping[str, str]) -> list[tuple[str, ...]]:
    table = []
    models = {version: exported_line(folder, version) for version in (2, 3)}
    for host in (host for host in HOSTS if host in pythons or is_installed(host)):
        for version, (model, path) in models.items():
            cells = []
            for kind in SET_POINTS:
                stimulus = stimulus_of(kind)
                try:
                    rows = run_host(host, path, stimulus, folder, python=pythons.get(host, sys.executable))
                except (RuntimeError, subprocess.TimeoutExpired) as error:
                    cells.append(str(error).strip().splitlines()[-1][:80])
                    continue
                ways = [largest_differences(model, stimulus, rows, straight=way) for way in (False, True)]
                cells.append(" ".join(f"{number:.0e}" for number in min(ways, key=max)))
            table.append((host, f"{version}.0", *cells))
    return table


def main() -> None:
    """Run all hosts and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("pythons", nargs="*", metavar="HOST=PYTHON", help="another Python for a host")
    pythons = dict(word.split("=", 1) for word in parser.parse_args().pythons)
    with tempfile.TemporaryDirectory() as folder:
        header = ("host", "FMI", *(f"{kind}: speed, torque" for kind in SET_POINTS))
        print_table("Largest difference over the motion", header, _compare(Path(folder), pythons))


if __name__ == "__main__":
    main()
