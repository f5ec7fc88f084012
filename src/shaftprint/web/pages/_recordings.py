"""Recordings and settings files that come in, and the page of each: what is in it, and the form that identifies it."""

from collections.abc import AsyncIterator
from dataclasses import asdict
from datetime import datetime
from pathlib import Path
from typing import Any, Final
from urllib.parse import quote

from starlette.exceptions import HTTPException
from starlette.responses import Response

from shaftprint.file_kinds import kind_of_file
from shaftprint.store._nouns import Line, Ship
from shaftprint.store._overview import namesakes
from shaftprint.web._asked import Asked, Moved, NotThere, Shown, ship_word
from shaftprint.web._kept import Making, Upload
from shaftprint.web._multipart import MOST_FILES, form_with_file
from shaftprint.web._setting import answer_of
from shaftprint.web._upload import SETTINGS, Taken, checked_name, expect_room, is_number, take
from shaftprint.web.access._person import Role, is_like_a_number
from shaftprint.web.pages._line import records_called
from shaftprint.zones import possible

# as their rooms have them, which would load far more; a test holds both together
VESSELS: Final = (
    "e-ferry-ellen",
    "foss-carolyn-dorothy",
    "nifs-research-vessel",
    "nifs-research-vessel-combinator",
    "pt-may",
    "pt-may-underway",
    "stan-tug-1205",
    "stan-tug-1205-astern",
    "stan-tug-1205-ecu",
    "stan-tug-1205-service",
    "stan-tug-1205-service-underway",
    "stan-tug-1205-starboard",
    "stan-tug-1205-underway",
)
CAMPAIGNS: Final = (
    "12min",
    "5min",
    "combinator",
    "dither",
    "machine",
    "pitch",
    "short",
    "thesis",
    "transit",
    "two-speeds",
)
STRUCTURES: Final = (
    "GAUGE-CLOSED",
    "GAUGE-CORE",
    "GAUGE-OPEN",
    "GAUGE-INFLOW",
    "GAUGE-ELASTIC",
    "GAUGE-ELASTIC-ENGINE",
    "GAUGE-ECU",
    "GAUGE-MOTOR",
    "GAUGE-PITCH",
    "GAUGE-COMBINATOR",
    "GAUGE-HYBRID",
)
KINDS: Final = ("vessel", "campaign")
"""Kinds of settings files that a job takes."""
MOST_SHOWN: Final = 64 * 1024
"""Letters of a settings file that its page shows."""
_LONGEST_WORD: Final = 100
_MOST_CHOICES: Final = 500


async def upload_form(asked: Asked) -> Shown:
    """Return the page on which a file is uploaded, with what was uploaded before."""
    return await asked.read(_upload_form, asked)


def _upload_form(asked: Asked) -> Shown:
    uploads = [_content(one) for one in uploads_of(asked)]
    choices = [
        {"value": f"{ship_word(one.line.ship, one.ship_id)}/{one.line.position}", "words": _words(one.line)}
        for one in asked.service.lines.now()
        if asked.person.sees(one.line.ship)
    ]
    return Shown(
        template="upload.html.j2",
        title="Upload",
        data={"uploads": uploads, "most_bytes": asked.service.serving.most_upload},
        drawn={"lines": choices[:_MOST_CHOICES], "chosen": asked.query("line")},
    )


def uploads_of(asked: Asked) -> list[Upload]:
    """Return the uploads of ships that somebody sees, the newest first."""
    return [one for one in asked.service.kept.uploads() if asked.person.sees(_ship_of(one))]


def _ship_of(one: Upload) -> Ship:
    return Ship(name=one.ship, imo_number=one.imo)


def _words(line: Line) -> str:
    number = "" if line.ship.imo_number is None else f" (IMO {line.ship.imo_number})"
    return f"{line.ship.name}{number}, {line.position}"


def _is_settings(one: Upload) -> bool:
    return one.name.lower().endswith(SETTINGS)


def path_of(asked: Asked, one: Upload) -> Path:
    """Return where an upload lies."""
    return asked.service.recordings / one.id / one.name


def _kind(asked: Asked, one: Upload) -> str | None:
    return kind_of_file(path_of(asked, one))


def _content(one: Upload) -> dict[str, Any]:
    return asdict(one) | {"address": f"/recordings/{one.id}", "settings": _is_settings(one)}


async def upload(asked: Asked) -> Moved:
    """Take the files of a form."""
    form = form_with_file(asked.request.headers.get("content-type", ""), aiter(asked.request.stream()))
    await form.read_fields()
    asked.check_token(asked.request.headers.get("x-csrf-token") or form.fields.get("token", ""))
    line = await asked.read(line_of, asked, form.fields)
    kept: list[Moved] = []
    try:
        async for name, pieces in form.files():
            there = sum(one.data["size"] for one in kept)
            kept.append(await taken(asked, pieces, name, line, of=MOST_FILES, there=there))
    except HTTPException as refused:
        names = ", ".join(one.data["name"] for one in kept)
        detail = f"{refused.detail} Kept before it: {names}." if names else refused.detail
        raise HTTPException(refused.status_code, detail) from None
    if len(kept) == 1:
        return kept[0]
    chosen = quote(form.fields.get("line", ""), safe="")
    return Moved(to=f"/upload?line={chosen}#there", data={"uploads": [one.data for one in kept]}, status=201)


async def put_recording(asked: Asked) -> Moved:
    """Take a file that is the whole body of a request."""
    asked.check_token(asked.request.headers.get("x-csrf-token", ""))
    line = await asked.read(line_of, asked, dict(asked.request.query_params))
    return await taken(asked, aiter(asked.request.stream()), asked.named("name"), line)


def line_of(asked: Asked, fields: dict[str, str]) -> Line:
    """Return the line that a file is of: one that is there, or a new one of a ship that somebody sees.

    Raises HTTPException if it is not said which; NotThere if the ship was not given to him.
    """
    chosen = fields.get("line", "").strip()
    if chosen and "/" in chosen:
        word, _, position = chosen.partition("/")
        found = records_called(asked, word, position)
        if found is None:
            raise NotThere
        return found.line
    name, number = fields.get("ship", "").strip(), fields.get("imo", "").strip().upper().removeprefix("IMO").strip()
    if not name or not chosen or max(len(name), len(chosen)) > _LONGEST_WORD or not (name + chosen).isprintable():
        raise HTTPException(400, "Expected a line from the list, or the name of a ship and of its shaft line.")
    if number and not is_imo_number(number):
        raise HTTPException(
            400, f"Expected an IMO number, seven digits of which the last checks the others, found {number[:20]!r}."
        )
    if is_like_a_number(name):
        raise HTTPException(
            400, f"Expected the name of a ship, found a number, {name[:20]!r}: state it as its IMO number."
        )
    return Line(ship=_ship_stated(asked, name, int(number) if number else None), position=chosen)


def _ship_stated(asked: Asked, name: str, number: int | None) -> Ship:
    """Return the ship that was typed: one that somebody sees, or a new one; a name leads to none that he does not see.

    Raises HTTPException if several ships that he sees have the name; NotThere if the ship was not given to him.
    """
    alike = namesakes(asked.service.store, name) if number is None else ()
    seen = [one for one in alike if asked.person.sees(one)]
    if len(seen) > 1:
        raise HTTPException(400, "Several ships have that name: state the IMO number, or take the line from the list.")
    ship = seen[0] if seen else Ship(name=name, imo_number=number)
    if not asked.person.sees(ship):
        raise NotThere
    expect_own(asked, ship)
    return ship


def expect_own(asked: Asked, ship: Ship) -> None:
    """Refuse a ship that the store would not tell from another one of its name.

    Raises HTTPException if it is so, and somebody sees the other one too; NotThere if he does not.
    """
    alike = namesakes(asked.service.store, ship.name, imo_number=ship.imo_number)
    if any(one.imo_number == ship.imo_number for one in alike):
        return
    others = [one for one in alike if ship.imo_number is None or one.imo_number is None]
    if not all(map(asked.person.sees, others)):
        raise NotThere
    if others:
        raise HTTPException(
            409,
            f"{ship.name} is in the store without an IMO number: an owner gives it its number on its page first."
            if ship.imo_number is not None
            else f"{ship.name} has an IMO number by now: take its line from the list.",
        )


def is_imo_number(text: str) -> bool:
    """Return whether a text can be the IMO number of a ship."""
    # as vessel.is_imo_number, which would load far more (IMO resolution A.1117(30)); a test holds both together
    digits = 7
    if not (text.isascii() and text.isdecimal() and len(text) == digits) or text[0] == "0":
        return False
    return sum(factor * int(digit) for factor, digit in zip(range(7, 1, -1), text, strict=False)) % 10 == int(text[-1])


async def taken(
    asked: Asked, pieces: AsyncIterator[bytes], name: str, line: Line, *, of: int = 1, there: int = 0
) -> Moved:
    """Take a file for a line, and say where its page is.

    ``of``: how many files its request may have. ``there``: how much of the request is on the disk already [bytes].
    """
    plain, most = checked_name(name), asked.service.serving.most_upload
    announced = asked.request.headers.get("content-length", "")
    length = int(announced) - there if announced.isascii() and announced.isdecimal() and len(announced) < 19 else None
    expect_room(asked.service.recordings, most=of * most + 64 * 1024, length=length)
    found: Taken = await take(pieces, asked.service.recordings, plain, most=most, length=None)
    one = Upload(
        id=found.id,
        imo=line.ship.imo_number,
        ship=line.ship.name,
        line=line.position,
        name=plain,
        size=found.size,
        sha256=found.sha256,
        person=asked.person.name,
        at=asked.service.now().isoformat(),
    )
    await asked.read(asked.service.kept.put_upload, one)
    asked.note("uploaded", line, name=plain, sha256=found.sha256, size=found.size)
    return Moved(to=f"/recordings/{one.id}", data=_content(one), status=201)


def upload_called(asked: Asked, number: str) -> Upload:
    """Return an upload, if somebody sees its ship.

    Raises NotThere if there is none, or it was not given to him.
    """
    found = asked.service.kept.upload(number) if is_number(number) else None
    if found is None or not asked.person.sees(_ship_of(found)):
        raise NotThere
    return found


async def recording(asked: Asked) -> Shown:
    """Return the page of a file that was uploaded."""
    return await asked.read(_recording, asked)


def _recording(asked: Asked) -> Shown:
    one = upload_called(asked, asked.named("id"))
    making = asked.service.kept.making(f"inspect {one.id}")
    inside: dict[str, Any] = (
        {"state": "none"} if making is None else {"state": making.state, "sentence": making.sentence}
    )
    if making is not None and making.state == "done":
        inside |= making.args["answer"]
    same = [
        other for other in uploads_of(asked) if (other.imo or other.ship, other.line) == (one.imo or one.ship, one.line)
    ]
    settings = [
        {"value": other.id, "words": f"{other.name}, uploaded {other.at[:10]}", "kind": _kind(asked, other)}
        for other in same
        if _is_settings(other)
    ]
    text = path_of(asked, one).read_text(encoding="utf-8", errors="replace") if _is_settings(one) else None
    return Shown(
        template="recording.html.j2",
        title=one.name,
        data={
            "upload": _content(one),
            "inspection": inside,
            "file": None if text is None else {"kind": _kind(asked, one), "text": text[:MOST_SHOWN]},
        },
        drawn={
            "choices": choices_of(settings, {kind: asked.query(kind) for kind in KINDS}),
            "source": f"upload:{one.id}",
            "back": f"/recordings/{one.id}",
        },
    )


def choices_of(settings: list[dict[str, str | None]], chosen: dict[str, str] | None = None) -> dict[str, Any]:
    """Return what may be chosen in the form of a job.

    ``settings``: files, each with what kind it is; one of no known kind stands in both lists. ``chosen``: what is
    chosen already.
    """
    shipped = {"vessel": VESSELS, "campaign": CAMPAIGNS}
    offered: dict[str, Any] = {
        kind: [
            # the newest first; a damaged one is offered for both, and its refusal says what is wrong
            *(one for one in settings if one["kind"] in (kind, None)),
            *({"value": one, "words": f"{one} (comes with shaftprint)"} for one in names),
        ]
        for kind, names in shipped.items()
    }
    return offered | {"structures": STRUCTURES, "chosen": dict.fromkeys(KINDS, "") | (chosen or {})}


async def look(asked: Asked) -> Moved | Response:
    """Ask for a look into a recording."""
    asked.expect(Role.TESTER)
    one = await asked.read(upload_called, asked, asked.named("id"))
    key = f"inspect {one.id}"
    there = asked.service.kept.making(key)
    if there is None or there.state == "refused":
        path = str(path_of(asked, one))
        asked.service.kept.put_making(
            Making(key=key, kind="inspect", args={"path": path}, state="waiting", sentence="")
        )
        asked.service.making.wake()
    return answer_of(asked, Moved(to=f"/recordings/{one.id}", data={"inspection": "waiting"}, status=202))


def moment_of(text: str, *, now: datetime) -> str | None:
    """Return a time of a form as a job takes it; None where none was typed.

    Raises HTTPException if it is none, or nothing can have been tested then.
    """
    if not text.strip():
        return None
    try:
        shown = datetime.fromisoformat(text.strip())
    except ValueError:
        raise HTTPException(400, f"Expected a time such as 2026-03-31T09:30+02:00, found {text[:40]!r}.") from None
    try:
        return possible(shown, now=now).isoformat()
    except ValueError as error:
        raise HTTPException(400, f"tested_at: {error}.") from None
