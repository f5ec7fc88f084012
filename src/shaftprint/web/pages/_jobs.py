"""Jobs: what was asked for, how far each is, and the sentence of each refusal; a form asks for one."""

import asyncio
import hashlib
import json
from collections.abc import AsyncIterator
from dataclasses import replace
from datetime import datetime
from typing import Any, Final

from starlette.exceptions import HTTPException
from starlette.responses import Response, StreamingResponse

from shaftprint.errors import StoreError
from shaftprint.store._job import Job
from shaftprint.store._ledger import job as job_called
from shaftprint.store._ledger import jobs as stored_jobs
from shaftprint.store._ledger import retry
from shaftprint.store._nouns import Line, Ship
from shaftprint.web._asked import Asked, Moved, NotThere, Shown
from shaftprint.web._kept import KeptJob
from shaftprint.web.access._person import Role
from shaftprint.web.pages._folders import place_of
from shaftprint.web.pages._recordings import (
    CAMPAIGNS,
    STRUCTURES,
    VESSELS,
    expect_own,
    line_of,
    moment_of,
    path_of,
    upload_called,
)

MOST: Final = 100
"""Jobs on one page."""
LONGEST_S: Final = 120.0
POLL_S: Final = 1.0
"""How often a page that is open looks whether its job is further [s]."""
MOST_STREAMS: Final = 64
_WORDS: Final = {"waiting": "waits", "running": "is being identified", "done": "done", "refused": "refused"}
_LOOKS: Final = {"waiting": "open", "running": "open", "done": "fine", "refused": "bad"}
_FACTS: Final = ("draught_m", "trim_m", "water_temperature_c", "water_density_kg_m3", "depth_m", "wind_m_s")
_streams: set[object] = set()


async def jobs(asked: Asked) -> Shown:
    """Return the newest jobs."""
    return await asked.read(_jobs, asked)


def _jobs(asked: Asked) -> Shown:
    kept = asked.service.kept.jobs()
    last = _last_number(asked)
    found: list[dict[str, Any]] = []
    # jobs are numbered in their order: the newest are behind the last numbers
    for one in reversed(stored_jobs(asked.service.store, after=max(0, last - 5 * MOST))):
        if _sees(asked, one, kept.get(one.id)) and len(found) < MOST:
            found.append(content_of(asked, one, kept.get(one.id)))
    open_ones = sum(one["state"] in {"waiting", "running"} for one in found)
    refused = sum(one["state"] == "refused" for one in found)
    counts = {"open": open_ones, "refused": refused, "done": len(found) - open_ones - refused}
    said = [f"{count} {word}" for word, count in counts.items() if count]
    headline = ", ".join(said) if found else "No job was asked for"
    return Shown(template="jobs.html.j2", title="Jobs", data={"headline": headline, "jobs": found})


def _last_number(asked: Asked) -> int:
    return max(asked.service.kept.jobs(), default=0) if not asked.person.sees_all else _last_of_all(asked)


def _last_of_all(asked: Asked) -> int:
    after, step = 0, 10_000
    while len(some := stored_jobs(asked.service.store, after=after, most=step)) == step:
        after = some[-1].id
    return some[-1].id if some else after


def _sees(asked: Asked, one: Job, kept: KeptJob | None) -> bool:
    """Return whether a job is of a ship that somebody sees; others than those asked for here, who sees all."""
    if asked.person.sees_all:
        return True
    return kept is not None and asked.person.sees(Ship(name=kept.ship, imo_number=kept.imo))


def content_of(asked: Asked, one: Job, kept: KeptJob | None) -> dict[str, Any]:
    """Return a job for JSON."""
    recording = str(one.args.get("recording", ""))
    return {
        "id": one.id,
        "address": f"/jobs/{one.id}",
        "state": one.state,
        "word": _WORDS[one.state],
        "look": _LOOKS[one.state],
        "progress": one.progress,
        "sentence": None if one.sentence is None else without_paths(asked, one.sentence),
        "result": one.result,
        "tries": one.tries,
        "asked_at": one.enqueued_at.isoformat(timespec="seconds"),
        "ended_at": None if one.ended_at is None else one.ended_at.isoformat(timespec="seconds"),
        "recording": recording.replace("\\", "/").rpartition("/")[2],
        "ship": kept.ship if kept is not None else one.args.get("ship"),
        "line": kept.line if kept is not None else one.args.get("line"),
        "person": None if kept is None else kept.person,
    }


def without_paths(asked: Asked, sentence: str) -> str:
    """Return a sentence without the folders of the server."""
    for folder in (asked.service.recordings, asked.service.serving.state, *asked.service.serving.folders):
        for text in {str(folder), str(folder.absolute()), str(folder.resolve())}:
            sentence = sentence.replace(f"{text}/", "")
    return sentence


async def job(asked: Asked) -> Shown:
    """Return how far a job is."""
    content = await asked.read(_job, asked)
    return Shown(
        template="job.html.j2",
        title=f"Job {content['id']}: {content['recording']}",
        data={"job": content},
        drawn={"events": f"/jobs/{content['id']}/events"},
    )


def _found(asked: Asked) -> tuple[Job, KeptJob | None]:
    number = asked.named("id")
    most_digits = 15
    if not number.isascii() or not number.isdecimal() or len(number) > most_digits:
        raise NotThere
    try:
        one = job_called(asked.service.store, int(number))
    except StoreError:
        raise NotThere from None
    kept = asked.service.kept.job(one.id)
    if not _sees(asked, one, kept):
        raise NotThere
    return one, kept


def _job(asked: Asked) -> dict[str, Any]:
    return content_of(asked, *_found(asked))


async def job_events(asked: Asked) -> Response:
    """Return how far a job is, again whenever it is further (server-sent events).

    Each event holds all that is to be known, and is numbered by its content: who comes back with the last one that he
    saw gets the next that differs.
    """
    content = await asked.read(_job, asked)
    if len(_streams) >= MOST_STREAMS:
        raise HTTPException(503, "Too many pages are open; close some, or load this one again from time to time.")
    seen = asked.request.headers.get("last-event-id", "")
    heads = {"x-accel-buffering": "no"}
    return StreamingResponse(_told(asked, content, seen), media_type="text/event-stream", headers=heads)


async def _told(asked: Asked, content: dict[str, Any], seen: str) -> AsyncIterator[str]:
    mark, silent_s = object(), 0.0
    _streams.add(mark)
    try:
        yield "retry: 2000\n\n"
        while True:
            text = json.dumps(content, ensure_ascii=True)
            number = hashlib.sha256(text.encode()).hexdigest()[:16]
            if number != seen:
                seen, silent_s = number, 0.0
                yield f"id: {number}\nevent: job\ndata: {text}\n\n"
            elif silent_s > 15.0:
                # a line that nobody reads shows whether somebody is there
                silent_s = 0.0
                yield ": still here\n\n"
            if content["state"] in {"done", "refused"}:
                asked.service.judging.wake()
                return
            await asyncio.sleep(POLL_S)
            silent_s += POLL_S
            content = await asked.read(_job, asked)
    finally:
        _streams.discard(mark)


async def new_job(asked: Asked) -> Moved:
    """Ask for the fingerprint of a recording."""
    fields = asked.fields
    recording, line = await asked.read(_source, asked, fields)
    vessel = await asked.read(settings_file, asked, fields.get("vessel", ""), VESSELS)
    campaign = await asked.read(settings_file, asked, fields.get("campaign", ""), CAMPAIGNS)
    # none is that of vessel and campaign
    structure = fields.get("structure") or None
    if structure is not None and structure not in STRUCTURES:
        raise HTTPException(400, f"Expected one of the structures {', '.join(STRUCTURES)}, found another one.")
    question = {
        "kind": "submit",
        "recording": recording,
        "vessel": vessel,
        "campaign": campaign,
        "structure": structure,
        "ship": line.ship.name,
        "imo": line.ship.imo_number,
        "line": line.position,
        "facts": _facts(fields, asked.service.now()),
    }
    answer = await asked.service.desk.ask(question, longest_s=LONGEST_S)
    kept = KeptJob(
        id=answer["job"],
        imo=line.ship.imo_number,
        ship=line.ship.name,
        line=line.position,
        name=recording.replace("\\", "/").rpartition("/")[2],
        person=asked.person.name,
        at=asked.service.now().isoformat(),
        args=answer["args"],
    )
    await asked.read(asked.service.kept.put_job, kept)
    asked.note("asked for a job", line, job=kept.id, name=kept.name)
    return Moved(to=f"/jobs/{kept.id}", data={"job": kept.id}, status=201)


def _source(asked: Asked, fields: dict[str, str]) -> tuple[str, Line]:
    """Return the path of a recording, and the line that it is of."""
    kind, _, rest = fields.get("source", "").partition(":")
    if kind == "upload":
        one = upload_called(asked, rest)
        line = Line(ship=Ship(name=one.ship, imo_number=one.imo), position=one.line)
        # what it was called when it was uploaded may be another ship's name by now
        expect_own(asked, line.ship)
        return str(path_of(asked, one).absolute()), line
    if kind == "folder":
        number, _, inside = rest.partition(":")
        place = place_of(asked, number, inside)
        if not place.path.is_file():
            raise NotThere
        return str(place.path), line_of(asked, fields)
    raise HTTPException(400, "Expected a recording that was uploaded, or one of an allowed folder, found none.")


def settings_file(asked: Asked, chosen: str, shipped: tuple[str, ...]) -> str:
    """Return the path of a settings file, or the name of one that comes with the program."""
    if chosen in shipped:
        return chosen
    if chosen.startswith("folder:"):
        # as the pages of the folders
        asked.expect(Role.TESTER)
        _, number, inside = (*chosen.split(":", 2), "", "")[:3]
        return str(place_of(asked, number, inside).path)
    one = upload_called(asked, chosen)
    return str(path_of(asked, one).absolute())


def _facts(fields: dict[str, str], now: datetime) -> dict[str, Any]:
    """Return what a form says of a test.

    Raises HTTPException if a number is none, or nothing can have been tested then.
    """
    facts: dict[str, Any] = {"tested_at": moment_of(fields.get("tested_at", ""), now=now)}
    facts |= {name: fields[name].strip() for name in ("place", "time_zone") if fields.get(name, "").strip()}
    for name in _FACTS:
        text = fields.get(name, "").strip()
        if text:
            try:
                facts[name] = float(text)
            except ValueError:
                raise HTTPException(400, f"{name}: expected a number, found {text[:40]!r}.") from None
    return {name: one for name, one in facts.items() if one is not None}


async def retry_job(asked: Asked) -> Moved:
    """Let a refused job wait again."""
    one, kept = await asked.read(_found, asked)
    if one.state != "refused":
        raise HTTPException(409, "Only a refused job can be tried again.")
    line = None
    if kept is not None:
        line = Line(ship=Ship(name=kept.ship, imo_number=kept.imo), position=kept.line)
        await asked.read(expect_own, asked, line.ship)
        # whose rights count when it ends
        await asked.read(asked.service.kept.put_job, replace(kept, person=asked.person.name))
    await asked.read(retry, asked.service.store, [one])
    asked.note("tried a job again", line, job=one.id)
    return Moved(to=f"/jobs/{one.id}", data={"job": one.id}, status=202)
