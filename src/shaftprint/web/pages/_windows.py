"""Choosing by eye: a recording with its windows, legs and repairs before the fit, and the campaign that results."""

import math
from collections.abc import AsyncIterator
from dataclasses import replace
from pathlib import PurePath
from typing import Any, Final
from urllib.parse import urlencode

from starlette.exceptions import HTTPException

from shaftprint.store._nouns import Line, Ship
from shaftprint.web._asked import Asked, Moved, NotThere, Shown
from shaftprint.web._kept import Making, Upload
from shaftprint.web._recorded import drawn_recording
from shaftprint.web._upload import SETTINGS
from shaftprint.web.pages._jobs import settings_file, without_paths
from shaftprint.web.pages._recordings import CAMPAIGNS, VESSELS, path_of, taken, upload_called

AS_SEEN: Final = "as-recorded"
"""In the place of a campaign: the tests that the set point shows."""
LONGEST_S: Final = 60.0
_MOST_S: Final = 1e6
_TEMPLATE: Final = "windows.html.j2"
_DIGITS: Final = 3


async def windows(asked: Asked) -> Shown:
    """Return a recording with its windows, legs and repairs."""
    return await asked.read(_windows, asked, asked.query("vessel"), asked.query("campaign"))


async def look_at_windows(asked: Asked) -> Moved:
    """Ask for the windows of a recording."""
    vessel, campaign = asked.fields.get("vessel", ""), asked.fields.get("campaign", "")
    one, making = await asked.read(_making, asked, vessel, campaign)
    if making is None or making.state == "refused":
        files = await asked.read(_files, asked, vessel, campaign)
        args = {"path": str(path_of(asked, one))} | files
        waiting = Making(key=_key(one, vessel, campaign), kind="windows", args=args, state="waiting", sentence="")
        await asked.read(asked.service.kept.put_making, waiting)
        asked.service.making.wake()
    return Moved(to=_address(one, vessel, campaign), data={"windows": "waiting"}, status=202)


async def choose(asked: Asked) -> Shown | Moved:
    """Return the campaign that was chosen by eye; keep it as a file of the line where that is asked for."""
    fields = asked.fields
    vessel, campaign = fields.get("vessel", ""), fields.get("campaign", "")
    one, making = await asked.read(_making, asked, vessel, campaign)
    if making is None or making.state != "done":
        raise HTTPException(409, "The windows of this recording were not looked at yet.")
    found = making.args["answer"]
    choices = choices_in(fields, found["tests"])
    question = {
        "kind": "chosen",
        "campaign": found["campaign"],
        "choices": choices,
        "remarks": f"Windows chosen by eye on the recording {one.name}, SHA-256 {one.sha256}.",
    }
    answer = await asked.service.desk.ask(question, longest_s=LONGEST_S)
    if fields.get("do") != "save":
        if asked.is_api:
            # a program knows the rest, and asks with every move of a window
            return Shown(template=_TEMPLATE, title=one.name, data={"file": answer["text"]})
        shown = await asked.read(_shown, asked, one, making, vessel, campaign)
        return replace(shown, data={**shown.data, "chosen": choices, "file": answer["text"]})
    line = Line(ship=Ship(name=one.ship, imo_number=one.imo), position=one.line)
    kept = await taken(asked, _pieces(answer["text"]), f"{PurePath(one.name).stem[:80]}-by-eye{SETTINGS}", line)
    chosen = urlencode({"vessel": vessel, "campaign": kept.data["id"]})
    return Moved(to=f"/recordings/{one.id}?{chosen}#identify", data=kept.data, status=201)


def choices_in(fields: dict[str, str], tests: list[dict[str, Any]]) -> dict[str, dict[str, Any]]:
    """Return what a form chooses of each test, by its name.

    Raises HTTPException if a number is none.
    """
    return {
        one["name"]: {
            "is_used": f"use.{at}" in fields,
            "later_s": _seconds(fields, f"later.{at}", one),
            "from_later_s": _seconds(fields, f"from.{at}", one) if one["has_window"] else 0.0,
            "to_later_s": _seconds(fields, f"to.{at}", one) if one["has_window"] else 0.0,
        }
        for at, one in enumerate(tests)
    }


def _seconds(fields: dict[str, str], name: str, test: dict[str, Any]) -> float:
    text = fields.get(name, "").strip() or "0"
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not abs(value) < _MOST_S:
        raise HTTPException(400, f"{test['name']}: expected a number of seconds, found {text[:20]!r}.")
    return round(value, _DIGITS)


async def _pieces(text: str) -> AsyncIterator[bytes]:
    yield text.encode()


def _key(one: Upload, vessel: str, campaign: str) -> str:
    return f"windows {one.id} {vessel} {campaign}"


def _address(one: Upload, vessel: str, campaign: str) -> str:
    return f"/recordings/{one.id}/windows?{urlencode({'vessel': vessel, 'campaign': campaign})}"


def _files(asked: Asked, vessel: str, campaign: str) -> dict[str, str | None]:
    """Return the files of a form, if somebody sees them.

    Raises NotThere if one is not there, or was not given to him.
    """
    seen = None if campaign == AS_SEEN else settings_file(asked, campaign, CAMPAIGNS)
    return {"vessel": settings_file(asked, vessel, VESSELS), "campaign": seen}


def _making(asked: Asked, vessel: str, campaign: str) -> tuple[Upload, Making | None]:
    one = upload_called(asked, asked.named("id"))
    if one.name.lower().endswith(SETTINGS):
        raise NotThere
    _files(asked, vessel, campaign)
    return one, asked.service.kept.making(_key(one, vessel, campaign))


def _windows(asked: Asked, vessel: str, campaign: str) -> Shown:
    return _shown(asked, *_making(asked, vessel, campaign), vessel, campaign)


def _shown(asked: Asked, one: Upload, making: Making | None, vessel: str, campaign: str) -> Shown:
    data: dict[str, Any] = {
        "recording": {"id": one.id, "name": one.name, "ship": one.ship, "line": one.line},
        "vessel": vessel,
        "campaign": campaign,
        "state": "none" if making is None else making.state,
        "sentence": "" if making is None else without_paths(asked, making.sentence),
        "file": "",
        "chosen": {},
        "seen": None,
    }
    drawn: dict[str, Any] = {}
    if making is not None and making.state == "done":
        found = making.args["answer"]
        data["seen"] = found | {"refusal": without_paths(asked, found["refusal"])}
        drawn = drawn_recording(found)
    return Shown(template=_TEMPLATE, title=f"Windows of {one.name}", data=data, drawn=drawn)
