"""Which recordings are to be identified: those of a folder, or the rows of a list."""

import csv
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from shaftprint.arguments import refusing_none
from shaftprint.errors import SettingsError
from shaftprint.files import reason
from shaftprint.fleet._arguments import JobArguments, job_arguments
from shaftprint.spelling import meant

ENDINGS: Final = (
    ".nc", ".h5", ".hdf5", ".csv", ".txt", ".tsv", ".mat", ".mf4", ".mdf", ".dat", ".tdms", ".dxd", ".d7d", ".d7z",
)  # fmt: skip
"""Endings of the files of a folder that are taken for recordings."""
_MOST_BYTES: Final = 64 * 2**20
_NUMBERS: Final = ("draught_m", "trim_m", "water_temperature_c", "water_density_kg_m3", "depth_m", "wind_m_s")
_WHOLE: Final = ("imo", "seed", "starts")
_TEXTS: Final = (
    "recording", "vessel", "campaign", "structure", "ship", "line", "class", "tested_at", "time_zone", "place",
)  # fmt: skip
COLUMNS: Final = (*_TEXTS, *_WHOLE, *_NUMBERS)
"""Columns that a list may have; the hyphen of an option does as well as the underscore."""


@refusing_none(SettingsError)
def recordings_in(folder: str | Path, **facts: Any) -> tuple[JobArguments, ...]:
    """Return the recordings of a folder, by their endings, in the order of their names; those of inner folders too.

    Parameters
    ----------
    folder
        The folder.
    facts
        Vessel, campaign and what else holds for all of them.

    Raises
    ------
    SettingsError
        If there is none.
    """
    place = Path(folder)
    found = sorted(path for path in place.rglob("*") if _is_recording(path, place))
    if not found:
        raise SettingsError(
            f"{folder}: expected recordings ({' '.join(ENDINGS)}), found none; name their folder, or a list."
        )
    return tuple(_arguments({"recording": str(path)} | facts, named=str(path)) for path in found)


@refusing_none(SettingsError)
def recordings_of_list(path: str | Path, **facts: Any) -> tuple[JobArguments, ...]:
    """Return the recordings of a list: a table in CSV with a row for each, under a line with names out of ``COLUMNS``.

    Parameters
    ----------
    path
        The list. Paths in it are seen from its folder.
    facts
        What holds where a row says nothing.

    Raises
    ------
    SettingsError
        If the list cannot be read, or a row cannot be used; the message says which.
    """
    file = Path(path)
    rows = _rows(file)
    if not rows:
        raise SettingsError(f"{file}: expected a row for each recording, found none.")
    return tuple(
        _arguments(dict(facts) | _stated(row, file.parent, named), named=named)
        for number, row in enumerate(rows, start=2)
        for named in (f"{file}, row {number}",)
    )


def _is_recording(path: Path, folder: Path) -> bool:
    is_hidden = any(part.startswith(".") for part in path.relative_to(folder).parts)
    return path.suffix.lower() in ENDINGS and not is_hidden and path.is_file()


def _rows(file: Path) -> list[dict[str, str]]:
    try:
        if file.stat().st_size > _MOST_BYTES:
            raise SettingsError(f"{file}: expected a list of at most {_MOST_BYTES >> 20} MiB; is it a recording?")
        text = file.read_text(encoding="utf-8-sig")
    except OSError as refusal:
        raise SettingsError(f"{file}: expected a list in CSV, but it cannot be read: {reason(refusal)}.") from None
    except UnicodeDecodeError:
        raise SettingsError(f"{file}: expected a list in CSV in UTF-8, found others; save it as UTF-8.") from None
    lines = text.splitlines()
    # a program set to a language with decimal commas writes semicolons
    delimiter = ";" if lines and lines[0].count(";") > lines[0].count(",") else ","
    try:
        cells = list(csv.reader(lines, delimiter=delimiter, strict=True))
    except csv.Error as fault:
        raise SettingsError(f"{file}: expected a list in CSV, found something else: {fault}.") from None
    table = [row for row in cells if any(cell.strip() for cell in row)]
    names = [name.strip().lower().replace("-", "_") for name in (table[0] if table else [])]
    _expect_names(file, names)
    return [_row(file, names, row, number) for number, row in enumerate(table[1:], start=2)]


def _expect_names(file: Path, names: list[str]) -> None:
    for name in names:
        if name not in COLUMNS:
            raise SettingsError(
                f"{file}: expected columns of {', '.join(COLUMNS)}, found {name[:40]!r}.{meant(name, COLUMNS)}"
            )
    if "recording" not in names or len(set(names)) != len(names):
        raise SettingsError(f"{file}: expected a column recording and each column once; the first line names them.")


def _row(file: Path, names: list[str], row: list[str], number: int) -> dict[str, str]:
    if len(row) != len(names):
        raise SettingsError(f"{file}, row {number}: expected {len(names)} cells, found {len(row)}.")
    return {name: cell.strip() for name, cell in zip(names, row, strict=True) if cell.strip()}


def _stated(row: Mapping[str, str], folder: Path, named: str) -> dict[str, Any]:
    """Return what a row states, numbers as numbers and paths as seen from the folder of the list."""
    stated: dict[str, Any] = {"class_name" if name == "class" else name: cell for name, cell in row.items()}
    for name in stated.keys() & set(_NUMBERS):
        stated[name] = _number(row[name], name, named)
    for name in stated.keys() & set(_WHOLE):
        if not row[name].isdecimal():
            raise SettingsError(f"{named}: {name}: expected a whole number, found {row[name][:40]!r}.")
        stated[name] = int(row[name])
    for name in stated.keys() & {"recording", "vessel", "campaign"}:
        is_path = name == "recording" or row[name].endswith(".toml") or "/" in row[name] or "\\" in row[name]
        stated[name] = str(folder / row[name]) if is_path else row[name]
    return stated


def _number(text: str, name: str, named: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise SettingsError(f"{named}: {name}: expected a number with a point, found {text[:40]!r}.")
    return value


def _arguments(fields: Mapping[str, Any], *, named: str) -> JobArguments:
    known = {name: value for name, value in fields.items() if value is not None}
    for name, option in (("recording", "recording"), ("vessel", "--vessel"), ("campaign", "--campaign")):
        if name not in known:
            raise SettingsError(f"{named}: expected a {name}, found none; add it, or state {option}.")
    paths = {name: known.pop(name) for name in ("recording", "vessel", "campaign")}
    return job_arguments(**paths, named=named, **known)
