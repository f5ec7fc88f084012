"""Rows of the tables as nouns; what a damaged file holds in their place is refused."""

import json
from typing import Any

from shaftprint.errors import StoreError
from shaftprint.store._nouns import Event, Line, Ship, StoredFingerprint, StoredNumber, Trial
from shaftprint.store.database._tables import TRIAL

WATER_COLUMNS = {
    "draught_m": "draught_m",
    "trim_m": "trim_m",
    "water_temperature_c": "water_c",
    "water_density_kg_m3": "density_kg_m3",
    "depth_m": "depth_m",
    "wind_m_s": "wind_m_s",
}
"""Column of each field of a trial that says something on ship and water."""


def ship_of_row(row: Any) -> Ship:
    """Return the ship of a row."""
    return Ship(name=_text(row.name), imo_number=row.imo, class_name=row.class_of)


def trial_of_row(row: Any) -> Trial:
    """Return the trial of a row."""
    return Trial(
        tested_at=row.tested_at,
        place=row.place,
        recording_sha256=row.recording_sha256,
        **{field: _number(getattr(row, column)) for field, column in WATER_COLUMNS.items()},
    )


def trial_columns(trial: Trial) -> dict[str, Any]:
    """Return the columns of a trial."""
    water = {column: getattr(trial, field) for field, column in WATER_COLUMNS.items()}
    others = {"tested_at": trial.tested_at, "place": trial.place, "recording_sha256": trial.recording_sha256}
    return others | water


TRIAL_COLUMNS = tuple(TRIAL.c[name] for name in ("tested_at", "place", "recording_sha256", *WATER_COLUMNS.values()))
"""The columns that ``trial_of_row`` reads."""


def fingerprint_of_row(row: Any, line: Line) -> StoredFingerprint:
    """Return the fingerprint of a row that holds its trial too."""
    return StoredFingerprint(
        line=line,
        trial=trial_of_row(row),
        sha256=_text(row.sha256),
        made_at=row.made_at,
        added_at=row.added_at,
        structure=_text(row.structure),
        version=_text(row.version),
        vessel_sha256=row.vessel_sha256,
        trustworthy=bool(row.trustworthy),
        supersedes=row.supersedes_sha256,
        superseded=row.successor is not None,
    )


def number_of_row(quantity: Any, row: Any) -> StoredNumber:
    """Return the number of a row, from kind, name and unit of its quantity, and its value with what belongs to it."""
    if quantity is None:
        raise _damaged("a number that is known", "none")
    kind, name, unit = quantity
    value, std, low, high, trusted = row
    for one in (value, std, low, high):
        # SQLite keeps anything anywhere
        if one.__class__ is not float and one is not None and not isinstance(one, int):
            raise _damaged("a number", one)
    return StoredNumber(
        kind=kind, name=name, unit=unit, value=value, std=std, low=low, high=high, trusted=bool(trusted)
    )


def quantity_of_row(row: Any) -> tuple[str, str, str]:
    """Return kind, name and unit of a quantity."""
    return _text(row.kind), _text(row.name), _text(row.unit)


WITHDRAWN = "withdrawn "
"""Begins the kind of the row that withdraws an event: of the same time, with the reason as its note.

Rows are added and never changed, so that the record shows both."""


def event_of_row(row: Any, line: Line, *, withdrawn: str | None = None) -> Event:
    """Return the event of a row, with why it was withdrawn."""
    try:
        numbers = tuple(str(name) for name in json.loads(row.numbers_affected))
    except (TypeError, ValueError):
        raise _damaged("names of numbers", row.numbers_affected) from None
    return Event(line=line, at=row.at, kind=_text(row.kind), numbers=numbers, note=_text(row.note), withdrawn=withdrawn)


def _text(value: Any) -> str:
    if not isinstance(value, str):
        raise _damaged("a text", value)
    return value


def _number(value: Any) -> float | None:
    # SQLite keeps anything anywhere
    if value is not None and not isinstance(value, float | int):
        raise _damaged("a number", value)
    return value


def _damaged(expected: str, found: object) -> StoreError:
    return StoreError(f"expected {expected}, found {str(found)[:40]!r}; the store is damaged: shaftprint store check.")
