"""The page of a line: has it changed, since when, what was done to it, and its numbers test by test."""

from datetime import datetime, timedelta
from typing import Any, Final

from starlette.exceptions import HTTPException

from shaftprint.digits import unit_text, with_deviation
from shaftprint.store._event import record_event, withdraw_event
from shaftprint.store._nouns import KINDS, Event, HistoryEntry, StoredNumber
from shaftprint.store._overview import LineNow, LineRecords, line_records
from shaftprint.web._asked import Asked, Moved, NotThere, Shown, line_address, line_key
from shaftprint.web._standing import Standing, standing_of
from shaftprint.web._strip import TimeAxis, strip
from shaftprint.web.access._person import Role
from shaftprint.zones import in_zone, time_zone

PHYSICAL: Final = "physical value"
MOST_STRIPS: Final = 12
_NAMED: Final = "id-"


async def line(asked: Asked) -> Shown:
    """Return the history of a line."""
    return await asked.read(_line, asked)


def records_of(asked: Asked) -> LineRecords:
    """Return what is kept of the line of an address, if somebody sees it.

    Raises NotThere if there is no such line, or it was not given to him.
    """
    found = records_called(asked, asked.named("ship"), asked.named("line"))
    if found is None:
        raise NotThere
    return found


def records_called(asked: Asked, ship: str, position: str) -> LineRecords | None:
    """Return what is kept of a line by the words of its address; None where somebody sees none."""
    number = ship.removeprefix(_NAMED)
    most_digits = 15
    if not number.isascii() or not number.isdecimal() or len(number) > most_digits or "\0" in position:
        return None
    where = {"ship_id": int(number)} if ship.startswith(_NAMED) else {"imo_number": int(number)}
    if where.get("imo_number", 0) >= 2**31:
        return None
    found = line_records(asked.service.store, position=position, **where)
    return found if found is not None and asked.person.sees(found.line.ship) else None


def _line(asked: Asked) -> Shown:
    records = records_of(asked)
    ship, position = records.line.ship, records.line.position
    kept = asked.service.kept.finding(line_key(ship, position))
    standing = standing_of(
        _now_of(records), kept, now=asked.service.now(), overdue_days=asked.service.serving.overdue_days
    )
    events = [_event(one, place) for place, one in enumerate(records.events, start=1)]
    found = None if kept is None else kept[1]
    data = {
        "ship": {"name": ship.name, "imo": ship.imo_number, "class": ship.class_name},
        "line": position,
        "address": line_address(records.line, records.ship_id),
        "kind": standing.kind,
        "word": standing.word,
        "look": standing.look,
        "note": standing.note,
        "sentences": [] if found is None else found["sentences"],
        "next_test": _next_test(records, standing, asked),
        "finding": found,
        "events": events,
        "tests": [_test(one) for one in reversed(records.entries)],
    }
    return Shown(
        template="line.html.j2",
        title=f"{ship.name}, {position}",
        data=data,
        drawn={"counted": [one for one in events if one["withdrawn"] is None]}
        | _drawn(records, found, kept is None or kept[0] != records.state),
    )


def _now_of(records: LineRecords) -> LineNow:
    newest = records.entries[-1].fingerprint if records.entries else None
    return LineNow(
        ship_id=records.ship_id,
        line=records.line,
        tests=len(records.entries),
        tested_at=None if newest is None else newest.trial.tested_at,
        trustworthy=None if newest is None else newest.trustworthy,
        number=None,
        state=records.state,
    )


def _next_test(records: LineRecords, standing: Standing, asked: Asked) -> str:
    if not records.entries:
        return "Next test: as soon as you can; nothing is known of this line yet."
    newest = records.entries[-1].fingerprint.trial.tested_at
    due = newest + timedelta(days=asked.service.serving.overdue_days)
    if standing.kind == "not trustworthy":
        return "Next test: now; the newest one cannot be used."
    if standing.kind == "changed":
        return "Next test: soon, to see whether it goes on."
    if standing.overdue:
        return f"Next test: now; it was due on {due:%Y-%m-%d}."
    if len(records.entries) == 1:
        return f"Next test: by {due:%Y-%m-%d}; from two tests on a change can be seen."
    return f"Next test: by {due:%Y-%m-%d}."


def _event(event: Event, number: int) -> dict[str, Any]:
    return {
        "number": number,
        "at": event.at.isoformat(),
        "kind": event.kind,
        "numbers": list(event.numbers),
        "note": event.note,
        "withdrawn": event.withdrawn,
    }


def _test(entry: HistoryEntry) -> dict[str, Any]:
    one = entry.fingerprint
    return {
        "at": one.trial.tested_at.isoformat(),
        "place": one.trial.place,
        "structure": one.structure,
        "trustworthy": one.trustworthy,
        "sha256": one.sha256,
        "numbers": [_number(number) for number in entry.numbers if number.kind == PHYSICAL],
    }


def _number(number: StoredNumber) -> dict[str, Any]:
    return {
        "name": number.name,
        "unit": number.unit,
        "value": number.value,
        "std": number.std if number.std is None or number.std < float("inf") else None,
        "low": number.low,
        "high": number.high,
        "trusted": number.trusted,
    }


def _drawn(records: LineRecords, found: dict[str, Any] | None, stale: bool) -> dict[str, Any]:
    counted = [(place, one) for place, one in enumerate(records.events, start=1) if one.withdrawn is None]
    moments = [one.fingerprint.trial.tested_at for one in records.entries] + [one.at for _, one in counted]
    axis = TimeAxis.over(moments)
    events = [{"at": one.at, "number": place} for place, one in counted]
    seen = {} if found is None else {one["name"]: one["words"] for one in found["causes"]}
    causes, numbers = [], []
    if axis is not None and found is not None:
        # what was seen first
        causes = [
            {
                "title": one["name"],
                "unit": one["unit"],
                "seen": one["name"] in seen,
                "drawn": strip(one["points"], axis, events, zero=True),
            }
            for one in sorted(found["strips"], key=lambda one: one["name"] not in seen)
        ]
    if axis is not None:
        numbers = [
            {"title": name, "unit": unit_text(unit), "drawn": strip(points, axis, events, zero=False)}
            for name, unit, points in _series(records)
        ]
    headings, rows = _number_rows(records)
    return {
        "stale": stale and bool(records.entries),
        "causes": causes,
        "numbers": numbers[:MOST_STRIPS],
        "headings_text": [f"{name} [{unit}]" if unit else name for name, unit in headings],
        "rows": rows,
        "kinds": KINDS,
        "api": f"/api/v1{line_address(records.line, records.ship_id)}",
    }


def _series(records: LineRecords) -> list[tuple[str, str, list[dict[str, Any]]]]:
    """Return the physical values over time, by name and unit."""
    found: dict[tuple[str, str], list[dict[str, Any]]] = {}
    for entry in records.entries:
        at = entry.fingerprint.trial.tested_at.isoformat()
        for number in entry.numbers:
            if number.kind == PHYSICAL:
                found.setdefault((number.name, number.unit), []).append(_number(number) | {"at": at})
    return [(name, unit, points) for (name, unit), points in found.items()]


def _number_rows(records: LineRecords) -> tuple[list[tuple[str, str]], list[dict[str, Any]]]:
    headings = list(dict.fromkeys(key for key in ((name, unit) for name, unit, _ in _series(records))))
    rows = []
    for entry in reversed(records.entries):
        by_key = {(one.name, one.unit): one for one in entry.numbers if one.kind == PHYSICAL}
        one = entry.fingerprint
        rows.append(
            {
                "at": f"{one.trial.tested_at:%Y-%m-%d}",
                "sha256": one.sha256,
                "trustworthy": one.trustworthy,
                "place": one.trial.place or "–",
                "cells": [_cell(by_key.get(key)) for key in headings],
            }
        )
    return [(name, unit_text(unit)) for name, unit in headings], rows


def _cell(number: StoredNumber | None) -> str:
    if number is None or number.value is None:
        return "–"
    std = float("nan") if number.std is None else number.std
    return with_deviation(number.value, std) + ("" if number.trusted else " *")


async def new_event(asked: Asked) -> Moved:
    """Note what was done to a line."""
    asked.expect(Role.TESTER)
    records = await asked.read(records_of, asked)
    at = _moment(asked.fields.get("at", ""), asked.fields.get("zone", ""))
    numbers = [one.strip() for one in asked.fields.get("numbers", "").split(",") if one.strip()]
    ship = records.line.ship
    kind = asked.fields.get("what", "")
    ((_, is_new),) = await asked.read(
        record_event,
        asked.service.store,
        ship,
        kind,
        at=at,
        lines=(records.line.position,),
        numbers=numbers,
        note=asked.fields.get("note", "").strip(),
        now=asked.service.now(),
    )
    asked.note("noted an event", records.line, kind=kind, when=at.isoformat())
    asked.service.judging.wake()
    to = line_address(records.line, records.ship_id)
    return Moved(to=f"{to}#events", data={"kind": kind, "at": at.isoformat(), "new": is_new}, status=201)


async def withdraw(asked: Asked) -> Moved:
    """Let what was noted of a line count no more; it stays in the record."""
    asked.expect(Role.OWNER)
    records = await asked.read(records_of, asked)
    kind, at = asked.fields.get("what", ""), _moment(asked.fields.get("at", ""), asked.fields.get("zone", ""))
    ship, why = records.line.ship, asked.fields.get("why", "").strip()
    await asked.read(withdraw_event, asked.service.store, ship, kind, at=at, lines=(records.line.position,), why=why)
    asked.note("withdrew an event", records.line, kind=kind, when=at.isoformat())
    asked.service.judging.wake()
    to = line_address(records.line, records.ship_id)
    return Moved(to=f"{to}#events", data={"kind": kind, "at": at.isoformat(), "withdrawn": why})


def _moment(text: str, zone: str) -> datetime:
    """Return the instant of a form's date.

    Raises HTTPException if it is none, or has neither an offset nor a zone.
    """
    try:
        shown = datetime.fromisoformat(text)
        return in_zone(shown, time_zone(zone or "UTC"))
    except (ValueError, OverflowError) as fault:
        what = f"Expected a date, such as 2026-05-01 or 2026-05-01T08:00, and a zone: {fault}."
        raise HTTPException(400, what) from None
