"""What a server does beside its pages: it judges lines that have something new, and makes what was asked for."""

import logging
import shutil
from collections.abc import Awaitable, Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from starlette.concurrency import run_in_threadpool

from shaftprint.errors import ShaftprintError
from shaftprint.store._overview import LineNow
from shaftprint.web._asked import line_key, ship_content
from shaftprint.web._kept import Making
from shaftprint.web._waking import Waking
from shaftprint.web.calculator._client import Calculator

if TYPE_CHECKING:
    from shaftprint.web._service import Service

PAUSE_S: Final = 30.0
"""How often the store is looked at for what others have put in [s]."""
_SUMMARY: Final = ("word", "causes", "because", "since", "nearest")
_LOG = logging.getLogger("shaftprint.web")


async def keep_judging(service: "Service") -> None:
    """Judge every line that has something new, one after the other, as long as the server runs."""
    await _keep_on(service, service.judging, _judge_new)


async def keep_making(service: "Service") -> None:
    """Make what was asked for, one after the other, as long as the server runs."""
    await _keep_on(service, service.making, _make_all)


async def _keep_on(service: "Service", bell: Waking, work: Callable[["Service"], Awaitable[None]]) -> None:
    while True:
        try:
            await work(service)
        except ShaftprintError as refused:
            # a store that is busy now will not be later
            _LOG.warning("%s", refused)
        except Exception:
            _LOG.exception("beside the pages")
        await service.bench.rest()
        await service.desk.rest()
        await bell.sleep(PAUSE_S)


async def _judge_new(service: "Service") -> None:
    lines = await run_in_threadpool(service.lines.now)
    states = {line: state for line, (state, _) in service.kept.summaries().items()}
    new = [one for one in lines if one.tests and states.get(_key(one)) != one.state]
    # the line that was tested last first: somebody waits for it
    for one in sorted(new, key=lambda line: line.tested_at or service.now(), reverse=True):
        ship = one.line.ship
        question = {"kind": "line", "ship": ship_content(ship), "line": one.line.position}
        try:
            found = await service.bench.ask(question, longest_s=service.serving.longest_s)
        except ShaftprintError as refused:
            found = _nothing(str(refused))
        summary = {name: found[name] for name in _SUMMARY}
        service.kept.put_finding(_key(one), one.state, summary, found)
        service.alerting.wake()


def _key(one: LineNow) -> str:
    return line_key(one.line.ship, one.line.position)


def _nothing(because: str) -> dict[str, Any]:
    return {
        "word": "cannot be told",
        "causes": [],
        "because": because,
        "since": None,
        "nearest": None,
        "sentences": [f"It cannot be told: {because.rstrip('.')}."],
        "left_out": {},
        "earlier": 0,
        "courses": None,
        "strips": [],
    }


async def _make_all(service: "Service") -> None:
    for one in service.kept.makings("waiting"):
        service.kept.put_making(await _made(service, one))


async def _made(service: "Service", one: Making) -> Making:
    """Return where something stands once it was made, in a process of its own that ends with it."""
    serving = service.serving
    calculator = Calculator(
        store=serving.store,
        most_memory=serving.most_memory,
        scratch=service.scratch / "made",
        most_file=serving.most_file,
    )
    try:
        answer = await calculator.ask({"kind": one.kind, **one.args}, longest_s=service.serving.longest_s)
    except ShaftprintError as refused:
        if one.kind == "report":
            shutil.rmtree(Path(one.args["folder"]), ignore_errors=True)
        return replace(one, state="refused", sentence=str(refused))
    finally:
        await calculator.close()
    return replace(one, state="done", args=one.args | {"answer": answer})
