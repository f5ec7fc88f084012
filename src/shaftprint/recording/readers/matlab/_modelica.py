"""Trajectories of Modelica tools: what Dymola, OpenModelica and OMSimulator write into a MATLAB file of version 4."""

import re
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray, IntArray
from shaftprint.errors import RecordingError
from shaftprint.recording._channel import Channel
from shaftprint.recording.readers._clock import SampleClock, clock_of_times, on_clock
from shaftprint.recording.readers._gather import Gathered, names_in_words, unique_names
from shaftprint.recording.readers._hints import OF_HINT, expect_one_rate
from shaftprint.units import plain_unit

NAME = "Modelica trajectories (MATLAB v4)"
VARIABLES = frozenset({"Aclass", "name", "description", "dataInfo", "data_2"})
"""Variables of which such a file always has each."""

_CLASS, _TRANSPOSED = "Atrajectory", "binTrans"
# Times nearer than this part of a step are the same; rows this near to the clock lie on it.
_SAME_TIME, _ON_CLOCK = 1e-6, 0.02
# Which matrix a variable lies in: parameters have two rows, the first and the last time.
_PARAMETERS, _TRAJECTORIES = 1, 2
# The unit ends the description; behind a bar stands the one that is shown, behind a colon a type: [rad/s|rev/min].
_UNIT = re.compile(r"\[(?P<unit>[^\[\]|:]*)(\|[^\[\]]*)?(:[^\[\]]*)?\]\s*$")


def read_trajectories(path: Path, *, rate_hz: float | None) -> Gathered:
    """Make a channel of every variable that may change; a file has one column of times for all.

    Where an event changes a variable such a file has two rows of one time; the later of them counts, where it lies on
    the clock of the others.

    ``path``: the file, which has all `VARIABLES`. ``rate_hz``: sample rate that the caller knows [Hz]. Raises
    RecordingError if it holds no trajectories, its table does not fit its matrices, or it has a rate of its own.
    """
    kept = [*sorted(VARIABLES - {"data_2"}), "data_2"]
    content: Mapping[str, Any] = scipy.io.loadmat(path, variable_names=kept, chars_as_strings=False)
    kind = [*_texts(content["Aclass"], is_transposed=False), "", "", "", ""]
    if kind[0] != _CLASS:
        raise RecordingError(
            f"{path}: expected the trajectories of a Modelica tool, found {kind[0] or 'a text'!r}; simulate the model "
            "and save its results."
        )
    is_transposed = kind[3] == _TRANSPOSED
    names = _texts(content["name"], is_transposed=is_transposed)
    descriptions = _texts(content["description"], is_transposed=is_transposed)
    table: IntArray = np.asarray(content["dataInfo"] if is_transposed else content["dataInfo"].T, dtype=np.int64)
    rows: NDArray[Any] = np.asarray(content["data_2"].T if is_transposed else content["data_2"])
    if table.shape[0] < 2 or not len(names) == len(descriptions) == table.shape[1] or rows.ndim != 2 or not rows.size:
        raise RecordingError(
            f"{path}: expected a place and a description for each of {len(names)} names, found {table.shape[-1]} and "
            f"{len(descriptions)}; simulate the model again."
        )
    return _gathered(path, names, descriptions, table, rows, rate_hz)


def _gathered(
    path: Path,
    names: list[str],
    descriptions: list[str],
    table: IntArray,
    rows: NDArray[Any],
    rate_hz: float | None,
) -> Gathered:
    matrices, places = table[0], table[1]
    if np.any((places == 0) | (np.abs(places) > rows.shape[1]) & (matrices == _TRAJECTORIES)):
        raise RecordingError(f"{path}: expected places from 1 to {rows.shape[1]}, found another; simulate it again.")
    gathered = Gathered(path=path)
    parameters = [name for name, matrix in zip(names, matrices, strict=True) if matrix == _PARAMETERS]
    if parameters:
        gathered.left_out[f"{len(parameters)} parameters"] = f"they do not change: {names_in_words(parameters)}"
    times = rows[:, 0].astype(np.float64)
    counting, remarks = _rows_that_count(times)
    gathered.remarks.extend(remarks)
    rows, times = rows[counting], times[counting]
    clock = _clock(path, times, rate_hz)
    chosen = np.flatnonzero(matrices == _TRAJECTORIES).tolist()
    for number, name in zip(chosen, unique_names([("", names[number]) for number in chosen]), strict=True):
        unit = _UNIT.search(descriptions[number])
        column = int(places[number])
        channel = Channel(
            name=name,
            unit="" if unit is None else plain_unit(unit["unit"]),
            rate_hz=clock.rate_hz,
            start_s=clock.start_s,
            count=times.size,
            source=partial(_column, rows, abs(column) - 1),
            # the same column with the other sign is another name of it
            scale=float(np.sign(column)),
            long_name=_UNIT.sub("", descriptions[number]).strip(),
        )
        gathered.add(name, partial(on_clock, channel, clock))
    return gathered


def _rows_that_count(times: FloatArray) -> tuple[NDArray[np.bool_], list[str]]:
    """Return which rows count, and what has to be said of the others.

    At an event there are two rows of one time, the later with the values behind it. Where the other rows lie on a
    clock, and it does not, it is no sample.
    """
    steps = np.diff(times)
    usual = float(np.median(steps[steps > 0.0])) if np.any(steps > 0.0) else 0.0
    # a time that is not a number is no other's
    is_before = np.append((steps >= 0.0) & (steps <= _SAME_TIME * usual), False)
    if not np.any(is_before):
        return ~is_before, []
    is_behind = np.roll(is_before, 1) & ~is_before
    places = (times - times[0]) / usual if usual else times
    between = is_behind & (np.abs(places - np.rint(places)) > _ON_CLOCK)
    remarks = [
        f"{np.count_nonzero(is_before)} rows before an event have the time of the row behind them, which counts."
    ]
    on_clock_steps = np.diff(times[~is_before & ~between])
    if np.any(between) and np.all(np.abs(on_clock_steps - usual) <= _ON_CLOCK * usual):
        remarks.append(f"{np.count_nonzero(between)} rows at events between two samples were left out.")
        return ~is_before & ~between, remarks
    return ~is_before, remarks


def _clock(path: Path, times: FloatArray, rate_hz: float | None) -> SampleClock:
    clock = clock_of_times(path, "variable time", times.size, lambda start, stop: times[start:stop])
    if rate_hz is not None:
        expect_one_rate(path, {"variable time": clock.rate_hz, OF_HINT: rate_hz}, 1e-6)
    return clock


def _column(rows: NDArray[Any], place: int, start: int, stop: int) -> FloatArray:
    return np.asarray(rows[start:stop, place], dtype=np.float64)


def _texts(letters: NDArray[Any], *, is_transposed: bool) -> list[str]:
    """Return the texts of a matrix of letters, a row or a column each."""
    matrix = np.atleast_2d(letters)
    return ["".join(row).rstrip(" \0") for row in (matrix.T if is_transposed else matrix).tolist()]
