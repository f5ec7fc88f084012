"""Run an FMU of somebody else, in a process that may end with it: ``python _fmu_child.py FOLDER``.

The folder holds ``job.json`` and the set point ``set_point.npy`` [rev/s]; ``outputs.npy``, speed [rev/s] and torque
[N m], or the sentence ``problem.txt`` is written into it. It imports little of shaftprint, its units and types of
arrays, so that the process begins at once.
"""

import json
import math
import sys
from pathlib import Path
from typing import Any

import fmpy
import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.units import NM_PER_UNIT, REV_S_PER_UNIT, plain_unit

ROLES = {"set_point": REV_S_PER_UNIT, "speed": REV_S_PER_UNIT, "torque": NM_PER_UNIT}
# powers of base units in a description of an FMU
BASES = {"rad/s": {"rad": 1, "s": -1}, "N m": {"kg": 1, "m": 2, "s": -2}}
POWERS = ("kg", "m", "s", "A", "K", "mol", "cd", "rad")


class ForeignError(Exception):
    """What a user can mend, as a sentence."""


def _factor(description: Any, role: str, name: str, unit: str) -> float:
    """Return what one unit of a variable is in rev/s or N m; a unit that the user gives goes before the FMU's."""
    by_name = {variable.name: variable for variable in description.modelVariables}
    if name not in by_name:
        of_kind = [v.name for v in by_name.values() if v.causality == ("input" if role == "set_point" else "output")]
        raise ForeignError(
            f"expected a variable {name} for {role}, found none; {'inputs' if role == 'set_point' else 'outputs'} are "
            f"{', '.join(of_kind[:8]) or 'none'}: name one with --model-variable"
        )
    if role == "set_point" and by_name[name].causality != "input":
        raise ForeignError(f"expected an input for set_point, found {name}, a {by_name[name].causality}")
    declared = unit or getattr(by_name[name], "unit", None) or getattr(by_name[name].declaredType, "unit", None) or ""
    factors = ROLES[role]
    if plain_unit(declared) in factors:
        return factors[plain_unit(declared)]
    base = "N m" if role == "torque" else "rad/s"
    factor = None if unit else _factor_to_base(description, declared, base)
    if factor is not None:
        return factor * factors[base]
    found = f"the unit {declared!r}" if declared else "no unit"
    raise ForeignError(
        f"expected {role} in {', '.join(factors)}, found {found} at {name}; "
        f"say it with --model-variable '{role}={name} [UNIT]'"
    )


def _factor_to_base(description: Any, unit: str, base: str) -> float | None:
    """Return what a unit is in one of ``BASES`` by its definition in the FMU; None where it says nothing of that."""
    definition = next((one.baseUnit for one in description.unitDefinitions if one.name == unit), None)
    if definition is None or float(definition.offset or 0.0) != 0.0:
        return None
    powers = {power: getattr(definition, power) for power in POWERS if getattr(definition, power, None)}
    return float(definition.factor or 1.0) if powers == BASES[base] else None


def run(job: dict[str, Any], set_point_rev_s: FloatArray) -> FloatArray:
    """Return speed [rev/s] and torque [N m] of an FMU at the samples of a set point, shape (2, samples).

    Before the first the set point stands still for ``job["before_s"]``. It goes straight between samples: what the FMU
    is given from one to the next is the mean of both.
    """
    description = fmpy.read_model_description(job["fmu"], validate=False)
    if description.coSimulation is None or not description.fmiVersion.startswith(("2", "3")):
        raise ForeignError(f"expected FMI 2 or 3 for co-simulation, found FMI {description.fmiVersion} without it")
    variables = job["variables"]
    names = {role: name for role, (name, _) in variables.items()}
    factors = {role: _factor(description, role, name, unit) for role, (name, unit) in variables.items()}
    step_s = 1.0 / job["rate_hz"]
    samples_before = math.ceil(job["before_s"] * job["rate_hz"])
    level = np.concatenate([np.full(samples_before, set_point_rev_s[0]), set_point_rev_s]) / factors["set_point"]
    held = np.append(0.5 * (level[1:] + level[:-1]), level[-1])
    time = np.arange(level.size) * step_s
    rows = fmpy.simulate_fmu(
        job["fmu"],
        validate=False,
        input=np.array(list(zip(time, held, strict=True)), dtype=[("time", float), (names["set_point"], float)]),
        start_values={names["set_point"]: level[0]},
        start_time=0.0,
        stop_time=time[-1],
        step_size=step_s,
        output_interval=step_s,
        output=[names["speed"], names["torque"]],
        fmi_type="CoSimulation",
    )
    outputs = np.stack([np.asarray(rows[names[role]], dtype=float) * factors[role] for role in ("speed", "torque")])
    if outputs.shape != (2, level.size) or not np.all(np.isfinite(outputs)):
        raise ForeignError(
            f"expected {level.size} finite rows, found {outputs.shape[1]}, not all of them finite numbers"
        )
    return np.asarray(outputs[:, samples_before:])


def main() -> None:
    """Do the job of a folder."""
    folder = Path(sys.argv[1])
    job = json.loads((folder / "job.json").read_text(encoding="utf-8"))
    try:
        np.save(folder / "outputs.npy", run(job, np.load(folder / "set_point.npy")))
    except ForeignError as error:
        (folder / "problem.txt").write_text(str(error), encoding="utf-8")
    except Exception as error:  # whatever the FMU or its reader raises is the user's to read
        (folder / "problem.txt").write_text(f"it could not be run: {error}", encoding="utf-8")


if __name__ == "__main__":
    main()
