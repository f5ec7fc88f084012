"""A request with whoever is behind it, and what an endpoint may answer."""

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final, TypeVar
from urllib.parse import parse_qsl, quote

from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException
from starlette.requests import Request

from shaftprint.store._nouns import Line, Ship
from shaftprint.web.access._person import Person, Role
from shaftprint.web.access._sessions import Session

if TYPE_CHECKING:
    from shaftprint.web._service import Service

API: Final = "/api/v1"
"""Where the twins of pages are, as JSON."""
LARGEST_FORM: Final = 64 * 1024
"""Bytes of the largest form."""
_MOST_FIELDS: Final = 1000
_T = TypeVar("_T")


class NotThere(HTTPException):
    """Nothing is there, or nothing that this person may know of: both look alike."""

    def __init__(self) -> None:
        super().__init__(404)


@dataclass(frozen=True, kw_only=True, slots=True)
class Shown:
    """What a page says, before it is set: the same for browsers and for programs."""

    template: str
    """Name of the template."""
    title: str
    """Heading."""
    data: Mapping[str, Any]
    """What it says, as JSON has it."""
    drawn: Mapping[str, Any] = field(default_factory=dict)
    """What only a browser needs beside it: charts, choices of forms."""
    status: int = 200
    """Status of the answer."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Moved:
    """Where a browser goes on after something was done, and what a program is told."""

    to: str
    """Address of the page."""
    data: Mapping[str, Any]
    """What was done, as JSON has it."""
    status: int = 200
    """Status for programs."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Asked:
    """A request of somebody who may ask for it."""

    request: Request
    """The request."""
    service: "Service"
    """What the server has."""
    session: Session
    """The browser."""
    person: Person
    """Who asks; nobody's name where it is no matter."""
    fields: dict[str, str] = field(default_factory=dict)
    """Fields of a form, once its token was found right."""

    @property
    def is_api(self) -> bool:
        """Whether a program asks."""
        return self.request.url.path.startswith(f"{API}/")

    @property
    def address(self) -> str:
        """Address from which it comes."""
        return self.request.client.host if self.request.client is not None else ""

    def named(self, name: str) -> str:
        """Return a part of the path."""
        return str(self.request.path_params[name])

    def query(self, name: str, default: str = "") -> str:
        """Return a value of the query."""
        return self.request.query_params.get(name, default)[:500]

    def expect(self, role: Role) -> None:
        """Refuse whoever has a lesser role."""
        if self.person.role < role:
            raise HTTPException(403, f"This needs the role {role.name.lower()}; ask whoever keeps the file of users.")

    async def read(self, work: Callable[..., _T], *arguments: Any, **named: Any) -> _T:
        """Return what a function gives that waits for a disk, without letting others wait."""
        return await run_in_threadpool(work, *arguments, **named)

    async def form(self) -> dict[str, str]:
        """Return the fields of a form, or of an object of JSON.

        Raises HTTPException if it is larger than a form, or none.
        """
        body = await body_of(self.request, most=LARGEST_FORM)
        try:
            if self.request.headers.get("content-type", "").partition(";")[0].strip() == "application/json":
                fields = json.loads(body)
            else:
                fields = dict(parse_qsl(body.decode(), keep_blank_values=True, max_num_fields=_MOST_FIELDS))
        except (ValueError, RecursionError):
            fields = None
        if not isinstance(fields, dict) or not all(isinstance(one, str) for one in fields.values()):
            raise HTTPException(400, "Expected the fields of a form, or an object of JSON with texts; found neither.")
        return fields

    async def expect_token(self) -> None:
        """Read the form of a request, and refuse it where it is not a form of this browser."""
        self.fields.update(await self.form())
        self.check_token(self.request.headers.get("x-csrf-token") or self.fields.pop("token", ""))

    def check_token(self, token: str) -> None:
        """Refuse a token that is not of this browser.

        Raises HTTPException if it is another one.
        """
        if not self.session.has(token):
            raise HTTPException(403, "The form is of an earlier visit, or of another page; load the page again.")

    def note(self, deed: str, line: Line | None = None, **about: Any) -> None:
        """Write down what was done."""
        ship = {} if line is None else {"ship": line.ship.name, "imo": line.ship.imo_number, "line": line.position}
        self.service.audit.note(
            deed, person=self.person.name, address=self.address, now=self.service.now(), **ship, **about
        )

    def refused(self, deed: str, **about: Any) -> None:
        """Count what somebody was refused: anybody can do it as often as he likes."""
        self.service.audit.refused(deed, address=self.address, now=self.service.now(), **about)


async def body_of(request: Request, *, most: int) -> bytes:
    """Return the body of a request.

    Raises HTTPException if it is longer than it may be.
    """
    parts, length = [], 0
    async for part in request.stream():
        length += len(part)
        if length > most:
            raise HTTPException(413, f"Expected at most {most} bytes, found more.")
        parts.append(part)
    return b"".join(parts)


def ship_word(ship: Ship, ship_id: int) -> str:
    """Return what a ship is called in an address: its IMO number, else its number in this store."""
    return str(ship.imo_number) if ship.imo_number is not None else f"id-{ship_id}"


def line_address(line: Line, ship_id: int) -> str:
    """Return the address of a line's page."""
    return f"/ships/{ship_word(line.ship, ship_id)}/{quote(line.position, safe='')}"


def ship_content(ship: Ship) -> dict[str, str | int | None]:
    """Return what tells a ship from all others, as processes beside the server are told it."""
    return {"name": ship.name, "imo_number": ship.imo_number}


def line_key(ship: Ship, position: str) -> str:
    """Return what a line is called in the server's own file."""
    return json.dumps([ship.imo_number or ship.name, position])
