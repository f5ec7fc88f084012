"""Objects in MATLAB files, which mat-io opens: timetables, tables, series, iddata, durations, dates become vectors."""

import importlib
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from shaftprint.recording.readers._vectors import LOCAL, Vector
from shaftprint.recording.readers.matlab._iddata import KIND, keep_iddata
from shaftprint.recording.readers.matlab._variables import MatVariables, object_reason

_READ = ("timetable", "table", "duration", "datetime", "timeseries", KIND)
_NUMBERS = "fiub"


def keep_objects(path: Path, kinds: Mapping[str, str], variables: MatVariables) -> None:
    """Add the objects of a file to its variables, or why they cannot be read.

    ``path``: the file. ``kinds``: class of each object by the name of its variable. ``variables``: what the file holds.
    """
    read = [name for name, kind in kinds.items() if kind in _READ and "/" not in name]
    opened: Mapping[str, Any] = {}
    is_zoned = False
    if read:
        opened, is_zoned = _opened(path, read)
    for name, kind in kinds.items():
        value = opened.get(name)
        if hasattr(value, "columns"):
            _keep_table(name, value, variables, is_zoned=is_zoned)
        elif isinstance(value, np.ndarray) and value.dtype.kind in "mM" and value.size > 1:
            variables.vectors.append(_vector(name, "", value.ravel(), "", is_zoned=is_zoned))
        elif kind == KIND and value is not None:
            keep_iddata(name, value, variables)
        elif kind == "timeseries" and (series := _properties(value)):
            _keep_series(name, series, variables)
        else:
            variables.left_out[name] = object_reason(name.replace("/", "."), kind)


def _opened(path: Path, names: list[str]) -> tuple[Mapping[str, Any], bool]:
    """Return what the library makes of some variables, and whether it says that dates had a zone: they are in UTC."""
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        try:
            matio = importlib.import_module("matio")
            opened = matio.load_from_mat(str(path), variable_names=names, add_table_attrs=True)
        except Exception:
            # not installed, or an object that it does not know: that costs the objects, not the file
            return {}, False
    return opened, any("timezone" in str(one.message) for one in said)


def _keep_table(name: str, table: Any, variables: MatVariables, *, is_zoned: bool) -> None:
    """Add the columns of a table that are numbers or times; of a timetable the times of its rows too."""
    if len(table) < 2:
        variables.left_out[name] = "expected rows of samples, found fewer than two."
        return
    row_times = np.asarray(table.index)
    if row_times.dtype.kind in "mM":
        variables.vectors.append(_vector("time", name, row_times, "", is_zoned=is_zoned))
    units = next((table.attrs[key] for key in ("varUnits", "VariableUnits") if key in table.attrs), ())
    stated = [str(unit) for unit in np.ravel(np.asarray(units, dtype=object))]
    for place, title in enumerate(table.columns):
        values = np.asarray(table.iloc[:, place])
        if values.ndim != 1 or values.dtype.kind not in f"{_NUMBERS}mM":
            variables.left_out[f"{name}/{title}"] = "expected real numbers, found texts or several numbers a row."
            continue
        unit = stated[place] if len(stated) == len(table.columns) else ""
        variables.vectors.append(_vector(str(title), name, values, unit, is_zoned=is_zoned))


def _keep_series(name: str, series: Mapping[str, Any], variables: MatVariables) -> None:
    """Add the columns of a time series and its times, which are stored, or an increment from a start on."""
    data, of_time = np.asarray(series.get("Data_")), _properties(series.get("TimeInfo"))
    times = next((one for one in map(_numbers, (series.get("Time_"), of_time.get("Time_"))) if one.size), None)
    if times is None:
        start, step, length = (_numbers(of_time.get(key)) for key in ("Start_", "Increment_", "Length"))
        # a length that the samples do not have may be any number
        is_whole = bool(start.size and step.size and length.size and length[0] in data.shape)
        times = start[0] + step[0] * np.arange(int(length[0])) if is_whole else None
    if times is None or times.size < 2 or data.dtype.kind not in _NUMBERS or times.size not in data.shape:
        variables.left_out[name] = "expected a time for each sample, found a time series without."
        return
    # of a series of matrices the time comes last
    first = data.shape[0] == times.size and (data.ndim == 2 or bool(np.ravel(series.get("IsTimeFirst_", True))[0]))
    columns = np.moveaxis(data, 0 if first else -1, 0).reshape(times.size, -1)
    variables.vectors.append(_vector("time", name, times, _text(of_time.get("Units")), is_zoned=False))
    unit = _properties(series.get("DataInfo")).get("Units")
    unit = _text(_properties(unit).get("Name", unit))
    for place, column in enumerate(columns.T, start=1):
        title = name if columns.shape[1] == 1 else f"{name} {place}"
        variables.vectors.append(_vector(title, name, column, unit, is_zoned=False))


def _properties(value: Any) -> Mapping[str, Any]:
    properties: Mapping[str, Any] = getattr(value, "properties", None) or {}
    return properties


def _numbers(value: Any) -> NDArray[Any]:
    numbers = np.ravel(np.asarray([] if value is None else value))
    return numbers.astype(np.float64) if numbers.dtype.kind in _NUMBERS else np.empty(0)


def _text(value: Any) -> str:
    texts = np.ravel(np.asarray([] if value is None else value))
    return str(texts[0]) if texts.size and texts.dtype.kind == "U" else ""


def _vector(name: str, group: str, values: NDArray[Any], unit: str, *, is_zoned: bool) -> Vector:
    """Return a vector in memory; times are nanoseconds, dates since 1970."""
    attributes: dict[str, object] = {"unit": unit} if unit else {}
    if values.dtype.kind in "mM":
        attributes = {"unit": "ns"}
        if values.dtype.kind == "M" and not is_zoned:
            attributes[LOCAL] = 1.0
        whole = values.astype("timedelta64[ns]" if values.dtype.kind == "m" else "datetime64[ns]")
        numbers = np.where(np.isnat(whole), np.nan, whole.astype(np.int64).astype(np.float64))
    else:
        numbers = values.astype(np.float64)

    def source(start: int, stop: int) -> NDArray[Any]:
        return numbers[start:stop].copy()

    return Vector(name=name, group=group, count=numbers.size, source=source, attributes=attributes)
