"""One way through all endpoints: who asks, may he, is the form his own, then the answer or a refusal."""

import logging
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from typing import Final, Literal, TypeAlias
from urllib.parse import quote, urlsplit

from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect, Request
from starlette.responses import RedirectResponse, Response

from shaftprint.errors import DatabaseError, ShaftprintError
from shaftprint.web._asked import API, Asked, Moved, Shown
from shaftprint.web._door import STREAMS
from shaftprint.web._service import Service
from shaftprint.web._setting import answer_of, refusal
from shaftprint.web.access._person import NOBODY, Role
from shaftprint.web.access._sessions import COOKIE, KNOWN_S

Answer: TypeAlias = Callable[[Asked], Awaitable[Shown | Moved | Response]]
TOKEN_HEAD: Final = "x-csrf-token"  # noqa: S105 - the name of a head
"""Head in which a program carries its token."""
NOT_THERE: Final = "There is no such page, ship or test, or it was not given to you."
_LOG = logging.getLogger("shaftprint.web")


@dataclass(frozen=True, kw_only=True, slots=True)
class Address:
    """An address of the server."""

    path: str
    """Its path, with parts in braces."""
    answer: Answer
    """What answers."""
    least: Role | None = Role.READER
    """The least role that may ask; None for everybody, signed in or not."""
    method: Literal["GET", "POST", "PUT"] = "GET"
    """What is done."""
    twin: bool = True
    """Whether a program finds the same below ``/api/v1``."""
    streams: bool = False
    """Whether the endpoint reads its body itself, and looks for the token in it."""


def endpoint(address: Address, service: Service) -> Callable[[Request], Awaitable[Response]]:
    """Return what Starlette calls for an address."""

    async def handle(request: Request) -> Response:
        session, cookie = service.sessions.read(request.cookies.get(COOKIE)), None
        if session is None:
            known = service.sessions.known(request.cookies.get(COOKIE))
            session, cookie = service.sessions.begin(known=known)
        if session.person is None and address.least is not None:
            response = _sign_in_first(request)
        else:
            asked = Asked(request=request, service=service, session=session, person=session.person or NOBODY)
            response = await _answered(address, asked)
        if cookie is not None and COOKIE not in response.headers.get("set-cookie", ""):
            keep(response, cookie, service)
        return response

    return handle


async def _answered(address: Address, asked: Asked) -> Response:
    try:
        if address.least is not None:
            asked.expect(address.least)
        if address.method != "GET":
            _expect_own_page(asked.request)
            if not address.streams:
                await asked.expect_token()
            else:
                # who may upload has more time than a few seconds
                asked.request.scope[STREAMS] = True
            if address.streams and TOKEN_HEAD in asked.request.headers:
                asked.check_token(asked.request.headers[TOKEN_HEAD])
        said = await address.answer(asked)
        # a long table is written beside what others ask
        return await asked.read(answer_of, asked, said) if asked.query("as") else answer_of(asked, said)
    except HTTPException as refused:
        sentence = NOT_THERE if refused.status_code == 404 else str(refused.detail)
        response = refusal(sentence, refused.status_code, api=asked.is_api, asked=asked)
        response.headers.update(refused.headers or {})
        return response
    except DatabaseError as refused:
        _LOG.error("%s", refused)
        sentence = "The store cannot be used at the moment; whoever keeps the server finds the reason in its log."
        return refusal(sentence, 503, api=asked.is_api, asked=asked)
    except ShaftprintError as refused:
        return refusal(str(refused), 400, api=asked.is_api, asked=asked)
    except ClientDisconnect:
        return Response(status_code=400)


def keep(response: Response, cookie: str, service: Service) -> None:
    """Let the browser keep a cookie."""
    response.set_cookie(
        COOKIE,
        cookie,
        # longer than somebody stays signed in: a browser that he used before is let through where others have to wait
        max_age=KNOWN_S,
        path="/",
        secure=service.serving.is_secure,
        httponly=True,
        samesite="strict",
    )


def _sign_in_first(request: Request) -> Response:
    if request.url.path.startswith(f"{API}/"):
        return refusal("Sign in first: POST /api/v1/session.", 401, api=True)
    if request.method not in {"GET", "HEAD"}:
        return RedirectResponse("/sign-in", status_code=303)
    return RedirectResponse(f"/sign-in?next={quote(request.url.path, safe='/')}", status_code=303)


def _expect_own_page(request: Request) -> None:
    """Refuse what a page of another host sends: browsers say where a request comes from."""
    site, origin = request.headers.get("sec-fetch-site", "same-origin"), request.headers.get("origin")
    host = request.headers.get("host", "").lower()
    foreign = origin is not None and urlsplit(_plain(origin)).netloc.lower() != host
    if site not in {"same-origin", "none"} or foreign:
        raise HTTPException(403, "This was sent by a page of another server.")


def _plain(origin: str) -> str:
    try:
        urlsplit(origin)
    except ValueError:
        return ""
    return origin


def twin_of(path: str) -> str:
    """Return the path of the twin of a page."""
    return f"{API}/ships" if path == "/" else f"{API}{path}"
