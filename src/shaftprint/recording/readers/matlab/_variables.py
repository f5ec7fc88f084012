"""What the variables of a MATLAB file mean, whatever its version: vectors, numbers, texts, and objects."""

import re
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from shaftprint.recording._channel import Source
from shaftprint.recording.readers._gather import Gathered
from shaftprint.recording.readers._time_scale import unit_in_name
from shaftprint.recording.readers._vectors import Vector, gather_vectors

MOST_STRUCTURES = 500
"""So many structures under one name are looked into."""
_TIMES_OF_SIMULINK = "tout"
_X_INDEX = "XIndex"
_UNIT = "_unit"
_INSTALL = 'pip install "shaftprint[readers]"'
_TITLE = re.compile(r"(.*?)\s*\[(.*)\]")
# Names of vectors with the name of their times, as Dewesoft and asammdf write them.
_TIMES_BY_NAME = (
    (re.compile(r"(Data\d+)_(?!time_)(.+)"), r"\1_time_\2"),
    (re.compile(r"DG(\d+)_.+"), r"DGM\1_timestamps"),
)
# What B&K PULSE and others write: each channel has a head, the file one with the rate as a text.
_OF_PULSE = re.compile(r"Channel_(\d+)_Data")
_HEAD, _FREQUENCY = "File_Header", "SampleFrequency"
_POSITIVE = re.compile(r"\d*[1-9]\d*(\.\d*)?([eE][+-]?\d+)?")


@dataclass(frozen=True, kw_only=True, slots=True)
class MatVariables:
    """The variables of a MATLAB file by their kind; those in structures have the structure as their group."""

    vectors: list[Vector] = field(default_factory=list)
    """Every real vector with at least two elements."""
    scalars: dict[str, dict[str, float]] = field(default_factory=dict)
    """Every real scalar, by group and name."""
    texts: dict[tuple[str, str], str] = field(default_factory=dict)
    """Every char variable, by group and name."""
    left_out: dict[str, str] = field(default_factory=dict)
    """Why others cannot be read, by name."""
    titles: tuple[str, ...] = ()
    """Names of the columns of tables, with units in brackets, where the caller knows them."""

    def add_table(self, name: str, shape: Sequence[int], columns: Callable[[int], Source]) -> None:
        """Add the columns of an array of two dimensions as vectors, or why it is none that the titles fit.

        ``name``: its name with the structures that it is in, which are the group of its columns. ``shape``: rows and
        columns. ``columns``: gives the source of a column.
        """
        if len(shape) != 2 or shape[1] != len(self.titles):
            self.left_out[name] = matrix_reason(name.rpartition("/")[2], shape)
            return
        for number, title in enumerate(self.titles):
            match = _TITLE.fullmatch(title.strip())
            plain, unit = (title.strip(), None) if match is None else (match[1], match[2])
            self.vectors.append(
                Vector(
                    name=plain,
                    group=name,
                    count=shape[0],
                    source=columns(number),
                    attributes={} if unit is None else {"unit": unit},
                )
            )


def titles_of(hints: Mapping[str, object]) -> tuple[str, ...]:
    """Return the titles of the hint ``columns``; none where it is not given."""
    columns = hints.get("columns")
    return tuple(columns.split(",")) if isinstance(columns, str) else ()


def object_reason(name: str, kind: str) -> str:
    """Return why an object is not read, and what to do in MATLAB.

    ``name``: name of the variable. ``kind``: its class, where the file says it, else ``object``.
    """
    reason = f"expected numbers, found a MATLAB {kind}, which only MATLAB can open"
    match kind:
        case "string":
            return f"{reason}; in MATLAB: {name} = char({name})."
        case "datetime":
            return f"{reason}; in MATLAB: {name} = posixtime({name})."
        case "duration":
            return f"{reason}; in MATLAB: {name} = seconds({name})."
        case "timeseries":
            return (
                f"{reason}; {_INSTALL} reads it, or in MATLAB: {name} = struct('t', {name}.Time, 'value', {name}.Data)."
            )
        case "categorical":
            return f"{reason}; in MATLAB: {name} = double({name})."
        case "table":
            return (
                f"{reason}; {_INSTALL} reads it, or in MATLAB: s = table2struct({name}, 'ToScalar', true); "
                "save('plain.mat', '-struct', 's')."
            )
        case "iddata":
            return (
                f"{reason}; {_INSTALL} reads it, or in MATLAB: s = struct('t', {name}.SamplingInstants, 'y', {name}.y, "
                f"'u', {name}.u); save('plain.mat', '-struct', 's')."
            )
        case "function" | "function_handle" | "inline":
            return f"{reason}."
        case "timetable" | "object":
            return _of_timetable(name, reason)
    return f"{reason}; save the vectors of numbers in it, with the times or the rate, as variables of their own."


def _of_timetable(name: str, reason: str) -> str:
    return (
        f"{reason}; {_INSTALL} reads a timetable, or in MATLAB: "
        f"s = struct('t', seconds({name}.Properties.RowTimes - {name}.Properties.RowTimes(1))); "
        f"for v = string({name}.Properties.VariableNames), s.(v) = {name}.(v); end; save('plain.mat', '-struct', 's')."
    )


def matrix_reason(name: str, shape: Sequence[int]) -> str:
    """Return why an array of several columns is not read, and what to do in MATLAB."""
    size = " x ".join(map(str, shape))
    return (
        f"expected a vector, found an array of {size}; say what its columns are (--columns), or save each of "
        f"them as a separate variable, in MATLAB: {name}_1 = {name}(:, 1)."
    )


def sparse_reason(name: str) -> str:
    """Return why a sparse matrix is not read, and what to do in MATLAB."""
    return f"expected a full vector, found a sparse matrix; in MATLAB: {name} = full({name})."


def cell_reason() -> str:
    """Return why a cell array is not read, and what to do in MATLAB."""
    return "expected a vector of numbers, found a cell array; save each element as a variable of its own."


def gather_variables(path: Path, variables: MatVariables, *, rate_hz: float | None, time_unit: str = "") -> Gathered:
    """Make a channel of every vector but the times.

    The clock of a structure or of the whole file is a vector ``time`` or ``t`` [s], or a scalar ``sample_rate_hz`` or
    ``fs`` [Hz] with an optional scalar ``start_s``. A char variable ``<channel>_unit`` gives the unit.

    ``path``: the file, for messages. ``variables``: what it holds. ``rate_hz``: sample rate that the caller knows [Hz].
    ``time_unit``: unit of the times that the caller knows. Raises RecordingError if two clocks of one group disagree.
    """
    named = [
        _by_its_label(replace(vector, attributes={**vector.attributes, **_unit(vector, variables.texts)}), variables)
        for vector in variables.vectors
    ]
    named = _on_times_of_their_own(named)
    if not any(unit_in_name(vector.name) is not None for vector in named if not vector.group):
        # the times of Simulink's outputs
        named = [
            replace(vector, name="time") if (vector.group, vector.name) == ("", _TIMES_OF_SIMULINK) else vector
            for vector in named
        ]
    scalars: Mapping[str, Mapping[str, float]] = {
        group: {name.lower(): value for name, value in numbers.items()}
        for group, numbers in variables.scalars.items()
        # Dewesoft's rate is that of its fastest channels
        if group or not any(vector.axis for vector in named if not vector.group)
    }
    return gather_vectors(path, named, scalars, rate_hz=rate_hz, time_unit=time_unit, left_out=variables.left_out)


def element_of(structures: str, number: int) -> str:
    """Return the name of one of several structures under one name, as MATLAB writes it; the first is 0."""
    return f"{structures}({number + 1})"


def _by_its_label(vector: Vector, variables: MatVariables) -> Vector:
    """Return a vector under the name that stands beside it.

    Simulink saves ``signals(1).values`` beside a ``label``, dSPACE ``Y(1).Data`` beside ``Name`` and ``Unit``, with the
    times in ``X(k).Data``, of which ``XIndex`` says k; PULSE ``Channel_1_Data`` beside ``Channel_1_Header``.
    """
    outer, _, last = vector.group.rpartition("/")
    of_pulse = _OF_PULSE.fullmatch(vector.name)
    if of_pulse is not None and not vector.group:
        return _of_pulse(vector, int(of_pulse[1]), variables)
    texts = {key: variables.texts.get((vector.group, key), "").strip() for key in ("label", "Name", "Unit")}
    unit = {"unit": texts["Unit"]} if texts["Unit"] else {}
    match last.partition("(")[0], vector.name:
        case "signals", "values":
            return replace(vector, name=texts["label"] or vector.name)
        case "Y", "Data":
            place = variables.scalars.get(vector.group, {}).get(_X_INDEX)
            axis = "" if place is None else element_of("X", int(place) - 1)
            return replace(
                vector, name=texts["Name"] or vector.name, axis=axis, attributes={**vector.attributes, **unit}
            )
        case "X", "Data":
            # one alone has no number
            of_index = element_of("X", 0) if last == "X" else last
            name = of_index if any(_X_INDEX in numbers for numbers in variables.scalars.values()) else "time"
            return replace(vector, name=name, group=outer, attributes={**vector.attributes, **unit})
    return vector


def _of_pulse(vector: Vector, number: int, variables: MatVariables) -> Vector:
    """Return a vector of PULSE under the name of its signal, with its unit and its rate."""
    head = f"Channel_{number}_Header"
    name, unit = (variables.texts.get((head, key), "").strip() for key in ("SignalName", "Unit"))
    attributes = {**vector.attributes, **({"unit": unit} if unit else {})}
    # one a channel, or one for all, which have to be as long
    rates = variables.texts.get((_HEAD, _FREQUENCY), "").replace(",", ".").split()
    counts = {one.count for one in variables.vectors if _OF_PULSE.fullmatch(one.name)}
    rates = rates * number if len(rates) == len(counts) == 1 else rates if len(rates) > 1 else []
    stated = rates[number - 1] if number <= len(rates) else ""
    is_timed = any(
        unit_in_name(text.strip()) is not None for (_, key), text in variables.texts.items() if key == "SignalName"
    )
    if _POSITIVE.fullmatch(stated) and not is_timed:
        attributes["sample_rate_hz"] = float(stated)
    return replace(vector, name=name or vector.name, attributes=attributes)


def _on_times_of_their_own(vectors: Sequence[Vector]) -> list[Vector]:
    """Return vectors with the times that belong to them by their names."""
    top = {vector.name for vector in vectors if not vector.group}
    return [replace(vector, axis=vector.axis or _times_by_name(vector, top)) for vector in vectors]


def _times_by_name(vector: Vector, top: Collection[str]) -> str:
    if vector.group:
        return ""
    theirs = (match.expand(times) for name, times in _TIMES_BY_NAME if (match := name.fullmatch(vector.name)))
    return next((name for name in theirs if name in top), "")


def _unit(vector: Vector, texts: Mapping[tuple[str, str], str]) -> dict[str, object]:
    unit = texts.get((vector.group, f"{vector.name}{_UNIT}"))
    return {} if unit is None else {"unit": unit}
