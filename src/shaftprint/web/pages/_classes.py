"""Sister ships: a number of the newest test of every line of a class."""

from typing import Any, Final

from starlette.exceptions import HTTPException

from shaftprint.digits import interval, unit_text, with_deviation
from shaftprint.store import LineNow
from shaftprint.web._asked import Asked, NotThere, Shown, line_address

NUMBERS: Final = ("K_Q", "I_dn", "governor proportional action", "governor integral action")


async def sister_class(asked: Asked) -> Shown:
    """Return the lines of a class with a number of their newest test."""
    return await asked.read(_class, asked)


def _class(asked: Asked) -> Shown:
    name, number = asked.named("name"), asked.query("number", NUMBERS[0])
    if number not in NUMBERS:
        raise HTTPException(400, f"Expected one of {', '.join(NUMBERS)}, found another number.")
    lines = [
        one
        for one in asked.service.lines.now(number)
        if one.line.ship.class_name == name and asked.person.sees(one.line.ship)
    ]
    if not lines:
        raise NotThere
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
