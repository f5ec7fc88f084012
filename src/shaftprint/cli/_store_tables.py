"""Tables of a store: lines with their newest test, tests of a ship, their numbers, what was done."""

from __future__ import annotations

import math
from collections.abc import Sequence
from datetime import tzinfo

from shaftprint.cli._terminal import print_document, print_findings
from shaftprint.digits import interval, with_deviation
from shaftprint.late import late
from shaftprint.plain_table import Column, Symbol, Table
from shaftprint.zones import utc_text

with late():
    from shaftprint.store._nouns import Event, Fault, HistoryEntry, LineSummary, StoredNumber


SHOWN_HASH = 12
DAMAGED = 1
"""How a command ends that has found records which are not as they were written."""
PHYSICAL = "physical value"
NOT_TRUSTED = "* The verdict of its test does not let this number be used."


def line_table(lines: Sequence[LineSummary], zone: tzinfo, number: str | None) -> Table:
    """Return every line with its newest test, and a number of it."""
    headings = ("ship", "IMO", "class", "line", "tests", "newest test", "verdict", *([number] if number else []))
    rows = tuple(
        (
            one.line.ship.name,
            str(one.line.ship.imo_number or "–"),
            one.line.ship.class_name or "–",
            one.line.position,
            str(one.tests),
            "–" if one.tested_at is None else utc_text(one.tested_at, zone),
            "–" if one.trustworthy is None else _verdict(trustworthy=one.trustworthy),
            *([_value(one.number, with_unit=True)] if number else []),
        )
        for one in lines
    )
    note = NOT_TRUSTED if any(one.number is not None and not one.number.trusted for one in lines) else ""
    return Table(title="Shaft lines", columns=_columns(headings, numbers=("tests",)), rows=rows, note=note)


def test_table(entries: Sequence[HistoryEntry], zone: tzinfo) -> Table:
    """Return the tests of a ship with what made their fingerprints."""
    rows = tuple(
        (
            utc_text(one.trial.tested_at, zone),
            one.line.position,
            one.trial.place or "–",
            one.structure,
            _verdict(trustworthy=one.trustworthy) + (", superseded" if one.superseded else ""),
            f"{utc_text(one.made_at, zone)[:10]}, {one.version}",
            one.sha256[:SHOWN_HASH],
        )
        for one in (entry.fingerprint for entry in entries)
    )
    columns = _columns(("tested", "line", "place", "structure", "verdict", "made, version", "fingerprint"))
    return Table(title="Tests", columns=columns, rows=rows)


def physical_history_table(entries: Sequence[HistoryEntry], zone: tzinfo) -> Table:
    """Return the physical values of every test, a column each."""
    found = [{_heading(number): number for number in entry.numbers if number.kind == PHYSICAL} for entry in entries]
    headings = list(dict.fromkeys(heading for numbers in found for heading in numbers))
    rows = tuple(
        (_when(entry, zone), entry.fingerprint.line.position, *(_value(numbers.get(heading)) for heading in headings))
        for entry, numbers in zip(entries, found, strict=True)
    )
    starred = any(not number.trusted for numbers in found for number in numbers.values())
    return Table(
        title="Physical values",
        columns=_columns(("tested", "line", *headings), numbers=headings),
        rows=rows if headings else (),
        note=NOT_TRUSTED if starred else "",
    )


def number_table(entries: Sequence[HistoryEntry], zone: tzinfo, name: str) -> Table:
    """Return one number of every test, with its interval."""
    rows = tuple(
        (
            _when(entry, zone),
            entry.fingerprint.line.position,
            number.kind,
            _value(number),
            interval(_float(number.low), _float(number.high), _float(number.std)),
            number.unit,
        )
        for entry in entries
        for number in entry.numbers
    )
    starred = any(not number.trusted for entry in entries for number in entry.numbers)
    headings = ("tested", "line", "what it is", name, "95 % interval", "unit")
    return Table(
        title=f"{name} over time",
        columns=_columns(headings, numbers=(name, "95 % interval")),
        rows=rows,
        note=NOT_TRUSTED if starred else "",
    )


def event_table(events: Sequence[Event], zone: tzinfo) -> Table:
    """Return what was done to the lines of a ship."""
    rows = tuple(
        (utc_text(one.at, zone), one.line.position, one.kind, ", ".join(one.numbers) or "–", _note(one))
        for one in events
    )
    return Table(title="What was done", columns=_columns(("when", "line", "what", "numbers", "note")), rows=rows)


def _note(event: Event) -> str:
    withdrawn = [] if event.withdrawn is None else [f"withdrawn: {event.withdrawn}"]
    return "; ".join(filter(None, (event.note, *withdrawn))) or "–"


def print_damage(faults: Sequence[Fault]) -> None:
    """Say which records are not as they were written."""
    title = "Not as it was written; put a backup in its place, and see with shaftprint store check what else is"
    print_findings(title, [f"{fault.record}: {fault.found}" for fault in faults], is_answer=True)
    print_document()


def _columns(headings: Sequence[str], *, numbers: Sequence[str] = ()) -> tuple[Column, ...]:
    return tuple(Column(Symbol(heading) if heading in numbers else heading, heading in numbers) for heading in headings)


def _when(entry: HistoryEntry, zone: tzinfo) -> str:
    return utc_text(entry.fingerprint.trial.tested_at, zone) + (" (superseded)" if entry.fingerprint.superseded else "")


def _verdict(*, trustworthy: bool) -> str:
    return "trustworthy" if trustworthy else "not trustworthy"


def _heading(number: StoredNumber) -> str:
    return number.name if number.unit == "-" else f"{number.name} [{number.unit}]"


def _value(number: StoredNumber | None, *, with_unit: bool = False) -> str:
    if number is None:
        return "–"
    unit = f" {number.unit}" if with_unit and number.unit != "-" else ""
    return f"{with_deviation(_float(number.value), _float(number.std))}{unit}{'' if number.trusted else ' *'}"


def _float(value: float | None) -> float:
    return math.nan if value is None else value
