"""The page of a test: can it be used, what was found, under which conditions, and its report."""

from typing import Any

from starlette.responses import Response

from shaftprint.digits import interval, unit_text, with_deviation
from shaftprint.store._history import document
from shaftprint.store._nouns import HistoryEntry, StoredFingerprint, StoredNumber
from shaftprint.store._overview import LineRecords
from shaftprint.web._asked import Asked, NotThere, Shown, line_address, ship_word
from shaftprint.web.pages._fingerprint import fingerprint_of
from shaftprint.web.pages._line import records_called
from shaftprint.web.pages._reports import report_state
from shaftprint.zones import utc_text

_TITLES = {
    "physical value": "Physical values",
    "parameter": "Parameters",
    "combination": "Combinations of parameters",
    "margin": "Stability margins",
    "calibration": "Calibration",
}


async def trial(asked: Asked) -> Shown:
    """Return what is known of a test."""
    return await asked.read(_trial, asked)


async def fingerprint_document(asked: Asked) -> Response:
    """Return the file of a fingerprint, byte by byte."""
    one = await asked.read(fingerprint_of, asked, asked.named("sha256"))
    content = await asked.read(document, asked.service.store, one.sha256)
    name = f"fingerprint-{one.trial.tested_at:%Y-%m-%d}-{one.sha256[:12]}.json"
    heads = {"content-disposition": f'attachment; filename="{name}"'}
    return Response(content, media_type="application/json", headers=heads)


def _trial(asked: Asked) -> Shown:
    one = fingerprint_of(asked, asked.named("sha256"))
    records = _records(asked, one)
    entries = [entry for entry in records.entries if entry.fingerprint.sha256 == one.sha256]
    place = next((at for at, entry in enumerate(records.entries) if entry in entries), None)
    before = None if not place else records.entries[place - 1].fingerprint
    first = records.entries[0].fingerprint if records.entries else None
    when = utc_text(one.trial.tested_at)
    data = {
        "ship": {"name": one.line.ship.name, "imo": one.line.ship.imo_number, "class": one.line.ship.class_name},
        "line": one.line.position,
        "tested_at": one.trial.tested_at.isoformat(),
        "trustworthy": one.trustworthy,
        "superseded": one.superseded,
        "sha256": one.sha256,
        "made_at": one.made_at.isoformat(),
        "version": one.version,
        "structure": one.structure,
        "recording_sha256": one.trial.recording_sha256,
        "vessel_sha256": one.vessel_sha256,
        "conditions": dict(_conditions(one)),
        "numbers": _tables(entries[0] if entries else None),
        "previous": None if before is None else before.sha256,
        "first": None if first is None or first.sha256 == one.sha256 else first.sha256,
        "report": report_state(asked, one),
    }
    return Shown(
        template="trial.html.j2",
        title=f"Test of {when[:10]}, {one.line.ship.name}, {one.line.position}",
        data=data,
        drawn={"when": when, "line_address": line_address(one.line, records.ship_id)},
    )


def _records(asked: Asked, one: StoredFingerprint) -> LineRecords:
    ship = one.line.ship
    if ship.imo_number is not None:
        found = records_called(asked, str(ship.imo_number), one.line.position)
    else:
        known = [row.ship_id for row in asked.service.lines.now() if row.line == one.line]
        found = records_called(asked, ship_word(ship, known[0]), one.line.position) if known else None
    if found is None:
        raise NotThere
    return found


def _conditions(one: StoredFingerprint) -> list[tuple[str, str]]:
    test = one.trial
    facts = {
        "place": test.place,
        "draught": _with(test.draught_m, "m"),
        "trim": _with(test.trim_m, "m"),
        "water": _with(test.water_temperature_c, "°C"),
        "density": _with(test.water_density_kg_m3, "kg/m³"),
        "depth": _with(test.depth_m, "m"),
        "wind": _with(test.wind_m_s, "m/s"),
    }
    return [(name, text) for name, text in facts.items() if text]


def _with(value: float | None, unit: str) -> str:
    return "" if value is None else f"{value:g} {unit}"


def _tables(entry: HistoryEntry | None) -> list[dict[str, Any]]:
    """Return the numbers of a test as tables, a kind each."""
    numbers = () if entry is None else entry.numbers
    columns = [
        {"heading": "number", "number": False},
        {"heading": "value", "number": True},
        {"heading": "95 % interval", "number": True},
        {"heading": "unit", "number": False},
        {"heading": "may be used", "number": False},
    ]
    tables = []
    for kind in [*_TITLES, *sorted({one.kind for one in numbers} - set(_TITLES))]:
        rows = [_row(one) for one in numbers if one.kind == kind]
        if rows:
            title = _TITLES.get(kind, kind)
            tables.append({"title": title, "columns": columns, "rows": rows, "symbols": [True] * len(rows), "note": ""})
    return tables


def _row(number: StoredNumber) -> list[str]:
    value, std, low, high = (
        float("nan") if one is None else one for one in (number.value, number.std, number.low, number.high)
    )
    # the verdict does not speak of what was calibrated
    usable = "–" if number.kind == "calibration" else "yes" if number.trusted else "no"
    return [number.name, with_deviation(value, std), interval(low, high, std), unit_text(number.unit) or "–", usable]
