"""What the variables of a MATLAB file mean, whatever its version: vectors, numbers, texts, and objects."""

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from shaftprint.recording._channel import Source
from shaftprint.recording.readers._gather import Gathered
from shaftprint.recording.readers._time_scale import unit_in_name
from shaftprint.recording.readers._vectors import Vector, gather_vectors

MOST_STRUCTURES = 500
"""So many structures under one name are looked into."""
_TIMES_OF_SIMULINK = "tout"
_UNIT = "_unit"
_INSTALL = 'pip install "shaftprint[readers]"'
_TITLE = re.compile(r"(.*?)\s*\[(.*)\]")


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
        case "function" | "function_handle" | "inline":
            return f"{reason}."
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
    if not any(unit_in_name(vector.name) is not None for vector in named if not vector.group):
        # the times of Simulink's outputs
        named = [
            replace(vector, name="time") if (vector.group, vector.name) == ("", _TIMES_OF_SIMULINK) else vector
            for vector in named
        ]
    scalars: Mapping[str, Mapping[str, float]] = {
        group: {name.lower(): value for name, value in numbers.items()} for group, numbers in variables.scalars.items()
    }
    return gather_vectors(path, named, scalars, rate_hz=rate_hz, time_unit=time_unit, left_out=variables.left_out)


def element_of(structures: str, number: int) -> str:
    """Return the name of one of several structures under one name, as MATLAB writes it; the first is 0."""
    return f"{structures}({number + 1})"


def _by_its_label(vector: Vector, variables: MatVariables) -> Vector:
    """Return a vector under the name that stands beside it.

    Simulink saves ``signals(1).values`` beside a ``label``, dSPACE ``Y(1).Data`` beside ``Name`` and ``Unit``, with the
    times in ``X(1).Data``.
    """
    outer, _, last = vector.group.rpartition("/")
    texts = {key: variables.texts.get((vector.group, key), "").strip() for key in ("label", "Name", "Unit")}
    unit = {"unit": texts["Unit"]} if texts["Unit"] else {}
    match last.partition("(")[0], vector.name:
        case "signals", "values":
            return replace(vector, name=texts["label"] or vector.name)
        case "Y", "Data":
            return replace(vector, name=texts["Name"] or vector.name, attributes={**vector.attributes, **unit})
        case "X", "Data":
            return replace(vector, name="time", group=outer, attributes={**vector.attributes, **unit})
    return vector


def _unit(vector: Vector, texts: Mapping[tuple[str, str], str]) -> dict[str, object]:
    unit = texts.get((vector.group, f"{vector.name}{_UNIT}"))
    return {} if unit is None else {"unit": unit}
