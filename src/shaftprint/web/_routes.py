"""All addresses of the server, in one list: a test walks through it with every role."""

from typing import Final

from starlette.applications import Starlette
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Route

from shaftprint.web._asked import API, Asked
from shaftprint.web._endpoint import NOT_THERE, Address, endpoint, twin_of
from shaftprint.web._openapi import openapi_of
from shaftprint.web._service import Service
from shaftprint.web._setting import refusal
from shaftprint.web.access._person import Role
from shaftprint.web.pages._audit import audit
from shaftprint.web.pages._classes import sister_class
from shaftprint.web.pages._compare import compare
from shaftprint.web.pages._folders import folder
from shaftprint.web.pages._jobs import job, job_events, jobs, new_job, retry_job
from shaftprint.web.pages._kiosk import kiosk
from shaftprint.web.pages._line import line, new_event, withdraw
from shaftprint.web.pages._number import give_number
from shaftprint.web.pages._recordings import look, put_recording, recording, upload, upload_form
from shaftprint.web.pages._reports import make_report, report_file
from shaftprint.web.pages._ships import ships
from shaftprint.web.pages._sign_in import session, sign_in, sign_in_form, sign_out
from shaftprint.web.pages._static import static
from shaftprint.web.pages._trial import fingerprint_document, trial
from shaftprint.web.pages._windows import choose, look_at_windows, windows


async def openapi(asked: Asked) -> Response:
    """Return this description."""
    return JSONResponse(openapi_of(ADDRESSES))


ADDRESSES: Final = (
    Address(path="/", answer=ships),
    Address(path="/kiosk", answer=kiosk),
    Address(path="/ships/{ship}/{line}", answer=line),
    Address(path="/ships/{ship}/{line}/events", answer=new_event, method="POST", least=Role.TESTER),
    Address(path="/ships/{ship}/{line}/events/withdrawn", answer=withdraw, method="POST", least=Role.OWNER),
    Address(path="/ships/{ship}/{line}/number", answer=give_number, method="POST", least=Role.OWNER),
    Address(path="/trials/{sha256}", answer=trial),
    Address(path="/trials/{sha256}/report", answer=make_report, method="POST", least=Role.TESTER),
    Address(path="/trials/{sha256}/report/{path:path}", answer=report_file, twin=False),
    Address(path="/fingerprints/{sha256}", answer=fingerprint_document),
    Address(path="/compare", answer=compare),
    Address(path="/classes/{name}", answer=sister_class),
    Address(path="/jobs", answer=jobs),
    Address(path="/jobs", answer=new_job, method="POST", least=Role.TESTER),
    Address(path="/jobs/{id}", answer=job),
    Address(path="/jobs/{id}/events", answer=job_events),
    Address(path="/jobs/{id}/retry", answer=retry_job, method="POST", least=Role.TESTER),
    Address(path="/upload", answer=upload_form, least=Role.TESTER),
    Address(path="/upload", answer=upload, method="POST", least=Role.TESTER, streams=True, twin=False),
    Address(path=f"{API}/recordings/{{name}}", answer=put_recording, method="PUT", least=Role.TESTER,
            streams=True, twin=False),
    Address(path="/recordings/{id}", answer=recording),
    Address(path="/recordings/{id}/look", answer=look, method="POST", least=Role.TESTER),
    Address(path="/recordings/{id}/windows", answer=windows),
    Address(path="/recordings/{id}/windows", answer=look_at_windows, method="POST", least=Role.TESTER),
    Address(path="/recordings/{id}/windows/campaign", answer=choose, method="POST", least=Role.TESTER),
    Address(path="/folders", answer=folder, least=Role.TESTER),
    Address(path="/folders/{number}/{inside:path}", answer=folder, least=Role.TESTER),
    Address(path="/audit", answer=audit, least=Role.OWNER),
    Address(path="/sign-in", answer=sign_in_form, least=None, twin=False),
    Address(path="/sign-in", answer=sign_in, method="POST", least=None, twin=False),
    Address(path="/sign-out", answer=sign_out, method="POST", least=None),
    Address(path=f"{API}/openapi.json", answer=openapi, twin=False),
    Address(path=f"{API}/session", answer=session, least=None, twin=False),
    Address(path=f"{API}/session", answer=sign_in, method="POST", least=None, twin=False),
    Address(path="/static/{name}", answer=static, least=None, twin=False),
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
