"""Data of the System Identification Toolbox (iddata): outputs and inputs of one experiment or several."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from shaftprint.recording.readers._units import seconds_in
from shaftprint.recording.readers._vectors import Vector
from shaftprint.recording.readers.matlab._variables import MatVariables

KIND = "iddata"
"""The class in MATLAB."""
_SIDES = (("OutputData", "OutputName", "OutputUnit"), ("InputData", "InputName", "InputUnit"))
_FIELDS = ("Domain", "Ts", "Tstart", "SamplingInstants", "TimeUnit", "ExperimentName")


def keep_iddata(name: str, value: Any, variables: MatVariables) -> None:
    """Add outputs and inputs as vectors with the rate or the times of their experiment, or why there are none.

    ``name``: name of the variable. ``value``: what the library makes of it: a structured array of the properties.
    """
    record = np.ravel(np.asarray(value))[0]
    if not set(record.dtype.names or ()) >= {*(key for side in _SIDES for key in side), *_FIELDS}:
        variables.left_out[name] = "expected the properties of an iddata, found others."
        return
    if _text(record["Domain"]).lower() not in ("time", ""):
        variables.left_out[name] = "expected samples in time, found an iddata of frequencies."
        return
    second = seconds_in(_text(record["TimeUnit"]) or "s")
    if second is None:
        variables.left_out[name] = f"expected a unit of time, found TimeUnit {_text(record['TimeUnit'])[:40]!r}."
        return
    several = _cells(record["OutputData"])
    for number in range(max(len(several), len(_cells(record["InputData"])))):
        group = name if len(several) == 1 else f"{name}({number + 1})"
        step, start, instants = (_numbers(_at(record[key], number)) for key in _FIELDS[1:4])
        clock: dict[str, object] = {}
        if instants.size > 1:
            variables.vectors.append(_vector("time", group, instants * second, {"unit": "s"}))
        elif step.size == 1 and np.isfinite(step[0]) and step[0] > 0.0:
            clock = {"sample_rate_hz": 1.0 / float(step[0] * second)}
            clock["start_s"] = float(start[0] * second) if start.size == 1 and np.isfinite(start[0]) else 0.0
        for data, names, units in _SIDES:
            columns = np.asarray(_at(record[data], number))
            if columns.ndim != 2 or columns.dtype.kind not in "fiu":
                continue
            titles, of_titles = ([_text(one) for one in _cells(record[key])] for key in (names, units))
            for place, column in enumerate(columns.T):
                unit = of_titles[place] if place < len(of_titles) else ""
                title = (titles[place] if place < len(titles) else "") or f"{data[0].lower()}{place + 1}"
                variables.vectors.append(
                    _vector(title, group, column.astype(np.float64), {**clock, **({"unit": unit} if unit else {})})
                )


def _cells(value: Any) -> list[Any]:
    """Return what is in a cell array."""
    array = np.asarray(value)
    return list(array.ravel()) if array.dtype.kind == "O" else [array]


def _at(value: Any, number: int) -> Any:
    """Return what a cell array holds of one experiment, or nothing."""
    cells = _cells(value)
    return cells[number] if number < len(cells) else np.empty(0)


def _numbers(value: Any) -> NDArray[Any]:
    array = np.asarray(value)
    return array.ravel().astype(np.float64) if array.dtype.kind in "fiu" else np.empty(0)


def _text(value: Any) -> str:
    array = np.ravel(np.asarray(value))
    while array.size and array.dtype.kind == "O":
        array = np.ravel(np.asarray(array[0]))
    return str(array[0]) if array.size and array.dtype.kind in "UT" else ""


def _vector(name: str, group: str, values: NDArray[Any], attributes: dict[str, object]) -> Vector:
    def source(start: int, stop: int) -> NDArray[Any]:
        return values[start:stop].copy()

    return Vector(name=name, group=group, count=values.size, source=source, attributes=attributes)
