"""Alerts: whoever keeps the server is told of lines that have changed, by mail or by a hook of his own.

What is told is kept as hashes, so that each change is told once. No password and no address of a hook comes into the
server's own database or its log.
"""

import asyncio
import base64
import hashlib
import http.client
import json
import logging
import smtplib
import ssl
import threading
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from email.message import EmailMessage
from functools import partial
from typing import TYPE_CHECKING, Any, Final
from urllib.parse import unquote, urlsplit

from starlette.concurrency import run_in_threadpool

from shaftprint.escape import chat_text
from shaftprint.web._asked import line_address, line_key
from shaftprint.web._standing import Standing, standing_of

if TYPE_CHECKING:
    from shaftprint.store._overview import LineNow
    from shaftprint.web._alerts import Alerts, Mail
    from shaftprint.web._service import Service

PAUSE_S: Final = 600.0
"""Time from one alert to the next at least: what changes meanwhile is told together [s]."""
TIMEOUT_S: Final = 20.0
"""How long a mail server or a hook may take for each step [s]."""
MOST_TOLD: Final = 50
"""Lines that one alert names; of more it says how many."""
_LOG = logging.getLogger("shaftprint.web")


@dataclass(frozen=True, kw_only=True, slots=True)
class Told:
    """One line that an alert names."""

    line: "LineNow"
    """The line."""
    standing: Standing
    """How it stands."""
    mark: str
    """What tells this change from the next one of the line."""

    @property
    def key(self) -> str:
        """What the line is called in the server's own file."""
        return line_key(self.line.line.ship, self.line.line.position)

    @property
    def words(self) -> str:
        """The line and what has changed, in one line of text in which a chat finds no mention and no link."""
        ship = self.line.line.ship
        number = "" if ship.imo_number is None else f" (IMO {ship.imo_number})"
        return chat_text(f"{ship.name}{number}, {self.line.line.position}: {self.standing.word}; {self.standing.note}")

    def content(self, pages: str) -> dict[str, Any]:
        """Return it for JSON."""
        ship = self.line.line.ship
        return {
            "ship": ship.name,
            "imo": ship.imo_number,
            "line": self.line.line.position,
            "word": self.standing.word,
            "note": self.standing.note,
            "page": f"{pages}{line_address(self.line.line, self.line.ship_id)}",
        }


def new_changes(service: "Service", way: str) -> list[Told]:
    """Return the lines that have changed and were not told of in a way, the clearest change first.

    A line that is not changed any more is forgotten: when it changes again, that is told again.
    """
    found, told = service.kept.summaries(), service.kept.told(way)
    changes = []
    for one in service.lines.now():
        kept = found.get(line_key(one.line.ship, one.line.position))
        if kept is None or kept[0] != one.state:
            continue
        standing = standing_of(one, kept, now=service.now(), overdue_days=service.serving.overdue_days)
        causes = sorted(cause["name"] for cause in kept[1]["causes"] if not cause.get("expected"))
        change = Told(line=one, standing=standing, mark=hashlib.sha256(json.dumps(causes).encode()).hexdigest())
        if standing.kind != "changed":
            if change.key in told:
                service.kept.forget_told(change.key, way)
        elif told.get(change.key) != change.mark:
            changes.append(change)
    return sorted(changes, key=lambda one: -one.standing.clearness)


async def keep_alerting(service: "Service") -> None:
    """Tell of lines that change, as long as the server runs; where nobody wants to be told, nothing goes out."""
    if service.alerts is None:
        return
    while True:
        is_told = True
        try:
            is_told = await tell(service, service.alerts)
        except Exception:
            _LOG.exception("alerts")
        # what fails is not tried faster than what succeeds
        await (asyncio.sleep(PAUSE_S) if is_told else service.alerting.sleep(PAUSE_S))


async def tell(service: "Service", alerts: "Alerts") -> bool:
    """Tell of the lines that have changed since the last time; return whether anything was sent, or tried.

    A change counts as told in a way once that way has taken it: what fails is tried again with the next alert.
    """
    ways: dict[str, Callable[[Sequence[Told]], None]] = {}
    if alerts.mail is not None:
        ways["mail"] = partial(send_mail, alerts.mail, alerts.pages)
    if alerts.hook is not None:
        ways["webhook"] = partial(post, alerts.hook, alerts.pages)
    is_tried = False
    for way, send in ways.items():
        changes = await run_in_threadpool(new_changes, service, way)
        if not changes:
            continue
        is_tried = True
        try:
            await _sent(partial(send, changes))
        except (OSError, smtplib.SMTPException, http.client.HTTPException, ValueError) as fault:
            # what a server answers may repeat what it was sent
            _LOG.warning("alert: the %s could not be sent (%s)", way, type(fault).__name__)
            continue
        for one in changes:
            service.kept.put_told(one.key, way, one.mark, service.now().isoformat())
        service.audit.note(f"sent an alert by {way}", person="", address="", now=service.now(), lines=len(changes))
    return is_tried


async def _sent(send: Callable[[], None]) -> None:
    """Wait until something is sent, in a thread that no end of the server waits for.

    What was under way then may arrive, and is told again by the next server: once too often, not once too little.
    """
    loop = asyncio.get_running_loop()
    ended: asyncio.Future[None] = loop.create_future()

    def end(fault: Exception | None) -> None:
        if not ended.done():
            ended.set_result(None) if fault is None else ended.set_exception(fault)

    def work() -> None:
        fault: Exception | None = None
        try:
            send()
        except Exception as error:
            fault = error
        with suppress(RuntimeError):
            # a loop that has ended takes nothing more
            loop.call_soon_threadsafe(end, fault)

    threading.Thread(target=work, name="alert", daemon=True).start()
    await ended


def subject_of(changes: Sequence[Told]) -> str:
    """Return what stands above an alert."""
    return f"shaftprint: {len(changes)} shaft line{'' if len(changes) == 1 else 's'} changed"


def _words(pages: str, changes: Sequence[Told]) -> str:
    lines = [f"{one.words}\n  {one.content(pages)['page']}" for one in changes[:MOST_TOLD]]
    more = [f"And {len(changes) - MOST_TOLD} more."] if len(changes) > MOST_TOLD else []
    return "\n\n".join([*lines, *more])


def send_mail(mail: "Mail", pages: str, changes: Sequence[Told]) -> None:
    """Send an alert as a mail of plain text."""
    message = EmailMessage()
    message["Subject"], message["From"], message["To"] = subject_of(changes), mail.sender, mail.to
    message.set_content(_words(pages, changes))
    safe = ssl.create_default_context()
    if mail.tls == "tls":
        server: smtplib.SMTP = smtplib.SMTP_SSL(mail.host, mail.port, timeout=TIMEOUT_S, context=safe)
    else:
        server = smtplib.SMTP(mail.host, mail.port, timeout=TIMEOUT_S)
    with server:
        if mail.tls == "starttls":
            server.starttls(context=safe)
        if mail.user:
            server.login(mail.user, mail.password)
        server.send_message(message)


def post(url: str, pages: str, changes: Sequence[Told]) -> None:
    """Post an alert to a hook; where it sends somebody elsewhere, nobody goes."""
    place = urlsplit(url)
    host, target = place.hostname or "", (place.path or "/") + (f"?{place.query}" if place.query else "")
    content = {
        "text": f"{subject_of(changes)}\n{_words(pages, changes)}",
        "lines": [one.content(pages) for one in changes[:MOST_TOLD]],
        "changed": len(changes),
    }
    connection: http.client.HTTPConnection
    if place.scheme == "https":
        safe = ssl.create_default_context()
        connection = http.client.HTTPSConnection(host, place.port, timeout=TIMEOUT_S, context=safe)
    else:
        connection = http.client.HTTPConnection(host, place.port, timeout=TIMEOUT_S)
    try:
        heads = {"content-type": "application/json", "user-agent": "shaftprint"}
        if place.username is not None:
            said = f"{unquote(place.username)}:{unquote(place.password or '')}"
            heads["authorization"] = f"Basic {base64.b64encode(said.encode()).decode()}"
        connection.request("POST", target, json.dumps(content).encode(), heads)
        status = connection.getresponse().status
    finally:
        connection.close()
    if not 200 <= status < 300:
        raise http.client.HTTPException(status)
