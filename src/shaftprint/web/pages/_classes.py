"""Sister ships: which line of a class is not as the others are, and a number of the newest test of each."""

import json
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Final

from starlette.exceptions import HTTPException

from shaftprint import __version__
from shaftprint.digits import interval, unit_text, with_deviation
from shaftprint.errors import ServerError
from shaftprint.store._overview import LineNow
from shaftprint.web._asked import Asked, NotThere, Shown, line_address, ship_content

NUMBERS: Final = ("K_Q", "I_dn", "governor proportional action", "governor integral action")


# Each line brings the documents of its newest tests, which are read whenever one of the lines has something new.
MOST_LINES, LONGEST_S = 60, 60.0
_HEADLINES = {
    "changed": ("Not all ships are as their sisters are", "look"),
    "unchanged": ("No ship is other than its sisters", "fine"),
    "cannot be told": ("It cannot be told", "open"),
}


async def sister_class(asked: Asked) -> Shown:
    """Return which lines of a class are not as the others are, with a number of their newest test."""
    lines = await asked.read(_lines_of, asked)
    shown, judged = _shown(asked, lines), await _judged(asked, lines)
    headline, look = _HEADLINES[judged["word"]]
    return replace(shown, data={**shown.data, **judged, "headline": headline, "look": look})


async def _judged(asked: Asked, lines: Sequence[LineNow]) -> dict[str, Any]:
    """Return what the lines that this person sees say about each other, calculated where one of them has changed."""
    because = {"word": "cannot be told", "left_out": [], "tables": []}
    if len(lines) > MOST_LINES:
        return because | {"sentences": [f"This page judges up to {MOST_LINES} lines together; shaftprint sisters any."]}
    called = [[ship_content(one.line.ship), one.line.position] for one in lines]
    # another version of the program may find another answer
    key, state = json.dumps(called), json.dumps([__version__, *(one.state for one in lines)])
    kept = asked.service.kept
    found = await asked.read(kept.class_finding, key, state)
    if found is None:
        try:
            found = await asked.service.desk.ask({"kind": "class", "lines": called}, longest_s=LONGEST_S)
        except ServerError as refusal:
            return because | {"sentences": [str(refusal)]}
        await asked.read(kept.put_class_finding, key, state, found)
    return found


def _lines_of(asked: Asked) -> tuple[LineNow, ...]:
    """Return the lines of a class that this person sees, each with a number of its newest test.

    Raises HTTPException if it is another number; NotThere if there are none.
    """
    name, number = asked.named("name"), asked.query("number", NUMBERS[0])
    if number not in NUMBERS:
        raise HTTPException(400, f"Expected one of {', '.join(NUMBERS)}, found another number.")
    lines = tuple(
        one
        for one in asked.service.lines.now(number)
        if one.line.ship.class_name == name and asked.person.sees(one.line.ship)
    )
    if not lines:
        raise NotThere
    return lines


def _shown(asked: Asked, lines: Sequence[LineNow]) -> Shown:
    name, number = asked.named("name"), asked.query("number", NUMBERS[0])
    rows = [_content(one) for one in lines]
    known = [one["value"] for one in rows if one["value"] is not None and one["trusted"]]
    return Shown(
        template="class.html.j2",
        title=f"Sister ships: {name}",
        data={
            "class": name,
            "number": number,
            "lines": rows,
            "lowest": min(known, default=None),
            "highest": max(known, default=None),
        },
        drawn={"numbers": NUMBERS, "cells": [_cells(one) for one in lines]},
    )


def _content(one: LineNow) -> dict[str, Any]:
    number = one.number
    return {
        "ship": one.line.ship.name,
        "imo": one.line.ship.imo_number,
        "line": one.line.position,
        "address": line_address(one.line, one.ship_id),
        "tested_at": None if one.tested_at is None else one.tested_at.isoformat(),
        "trustworthy": one.trustworthy,
        "value": None if number is None else number.value,
        "std": None if number is None or number.std is None or number.std == float("inf") else number.std,
        "unit": None if number is None else number.unit,
        "trusted": number is not None and number.trusted,
    }


def _cells(one: LineNow) -> tuple[str, str, str]:
    number = one.number
    if number is None or number.value is None:
        return "–", "–", ""
    std, low, high = (float("nan") if part is None else part for part in (number.std, number.low, number.high))
    return with_deviation(number.value, std), interval(low, high, std), unit_text(number.unit)
