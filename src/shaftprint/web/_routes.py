"""All addresses of the server, in one list: a test walks through it with every role."""

from typing import Final

from starlette.applications import Starlette
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from shaftprint.web import pages
from shaftprint.web._asked import API
from shaftprint.web._endpoint import NOT_THERE, Address, endpoint, twin_of
from shaftprint.web._service import Service
from shaftprint.web._setting import refusal
from shaftprint.web.access import Role

ADDRESSES: Final = (
    Address(path="/", answer=pages.ships),
    Address(path="/ships/{ship}/{line}", answer=pages.line),
    Address(path="/ships/{ship}/{line}/events", answer=pages.new_event, method="POST", least=Role.TESTER),
    Address(path="/ships/{ship}/{line}/events/withdrawn", answer=pages.withdraw, method="POST", least=Role.OWNER),
    Address(path="/ships/{ship}/{line}/number", answer=pages.give_number, method="POST", least=Role.OWNER),
    Address(path="/trials/{sha256}", answer=pages.trial),
    Address(path="/trials/{sha256}/report", answer=pages.make_report, method="POST", least=Role.TESTER),
    Address(path="/trials/{sha256}/report/{path:path}", answer=pages.report_file, twin=False),
    Address(path="/fingerprints/{sha256}", answer=pages.fingerprint_document),
    Address(path="/compare", answer=pages.compare),
    Address(path="/classes/{name}", answer=pages.sister_class),
    Address(path="/jobs", answer=pages.jobs),
    Address(path="/jobs", answer=pages.new_job, method="POST", least=Role.TESTER),
    Address(path="/jobs/{id}", answer=pages.job),
    Address(path="/jobs/{id}/events", answer=pages.job_events),
    Address(path="/jobs/{id}/retry", answer=pages.retry_job, method="POST", least=Role.TESTER),
    Address(path="/upload", answer=pages.upload_form, least=Role.TESTER),
    Address(path="/upload", answer=pages.upload, method="POST", least=Role.TESTER, streams=True, twin=False),
    Address(path=f"{API}/recordings/{{name}}", answer=pages.put_recording, method="PUT", least=Role.TESTER,
            streams=True, twin=False),
    Address(path="/recordings/{id}", answer=pages.recording),
    Address(path="/recordings/{id}/look", answer=pages.look, method="POST", least=Role.TESTER),
    Address(path="/folders", answer=pages.folder, least=Role.TESTER),
    Address(path="/folders/{number}/{inside:path}", answer=pages.folder, least=Role.TESTER),
    Address(path="/audit", answer=pages.audit, least=Role.OWNER),
    Address(path="/sign-in", answer=pages.sign_in_form, least=None, twin=False),
    Address(path="/sign-in", answer=pages.sign_in, method="POST", least=None, twin=False),
    Address(path="/sign-out", answer=pages.sign_out, method="POST", least=None),
    Address(path=f"{API}/session", answer=pages.session, least=None, twin=False),
    Address(path=f"{API}/session", answer=pages.sign_in, method="POST", least=None, twin=False),
    Address(path="/static/{name}", answer=pages.static, least=None, twin=False),
)  # fmt: skip
"""Every address with what answers, and the least role that may ask."""


def routes_of(service: Service) -> list[Route]:
    """Return every route of a server: each address, and its twin for programs."""
    return [
        Route(path, endpoint(one, service), methods=[one.method])
        for one in ADDRESSES
        for path in (one.path, *((twin_of(one.path),) if one.twin else ()))
    ]


def application(service: Service) -> Starlette:
    """Return the server's application, without what stands before it."""
    return Starlette(routes=routes_of(service), exception_handlers={404: _not_there, 405: _not_there})


async def _not_there(request: Request, refused: Exception) -> Response:
    status = refused.status_code if isinstance(refused, HTTPException) else 404
    return refusal(NOT_THERE, status, api=request.url.path.startswith(f"{API}/"))
