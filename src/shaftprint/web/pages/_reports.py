"""The report of a test: made when somebody asks for it, in a process of its own, and then a folder of files."""

import re
from pathlib import Path
from typing import Any, Final

from starlette.exceptions import HTTPException
from starlette.responses import FileResponse, Response

from shaftprint.store._job import JobState
from shaftprint.store._ledger import jobs
from shaftprint.store._nouns import StoredFingerprint
from shaftprint.web._asked import Asked, Moved, NotThere
from shaftprint.web._kept import Making
from shaftprint.web.access._person import Role
from shaftprint.web.pages._fingerprint import fingerprint_of

# the page has a policy of its own too; both hold
REPORT_POLICY: Final = (
    "default-src 'none'; script-src 'self'; img-src 'self' data:; style-src 'self' 'unsafe-inline'; base-uri 'none'; "
    "form-action 'none'; frame-ancestors 'none'"
)
_PART: Final = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.-]{0,120}")
_DONE: Final[tuple[JobState, ...]] = ("done",)
_KINDS: Final = {
    ".html": "text/html",
    ".js": "text/javascript",
    ".svg": "image/svg+xml",
    ".png": "image/png",
    ".pdf": "application/pdf",
}


def report_state(asked: Asked, one: StoredFingerprint) -> dict[str, Any]:
    """Return whether there is a report of a test, or may be."""
    making = asked.service.kept.making(f"report {one.sha256}")
    address = f"/trials/{one.sha256}/report"
    if making is not None:
        words = {"waiting": "is being made", "done": "is made", "refused": "was refused"}
        sentence = making.sentence if making.state == "refused" else ""
        return {
            "state": making.state,
            "word": words[making.state],
            "sentence": sentence,
            "address": f"{address}/index.html",
        }
    can = _job_of(asked, one.sha256) is not None
    return {"state": "none" if can else "impossible", "word": "", "sentence": "", "address": f"{address}/index.html"}


def _job_of(asked: Asked, sha256: str) -> dict[str, Any] | None:
    """Return what the job worked on that gave a fingerprint, if its recording is still there."""
    kept = asked.service.kept.jobs()
    if not kept:
        return None
    for one in jobs(asked.service.store, states=_DONE):
        if one.result == sha256 and one.id in kept:
            args = dict(one.args)
            return args if Path(str(args.get("recording", ""))).is_file() else None
    return None


async def make_report(asked: Asked) -> Moved:
    """Ask for the report of a test."""
    asked.expect(Role.TESTER)
    one = await asked.read(fingerprint_of, asked, asked.named("sha256"))
    args = await asked.read(_job_of, asked, one.sha256)
    if args is None:
        raise HTTPException(409, "The recording of this test is not on this server, so that no report can be made.")
    key = f"report {one.sha256}"
    there = asked.service.kept.making(key)
    if there is None or there.state == "refused":
        folder = asked.service.reports / one.sha256
        asked.service.kept.put_making(
            Making(
                key=key, kind="report", args={"arguments": args, "folder": str(folder)}, state="waiting", sentence=""
            )
        )
        asked.note("asked for a report", one.line, sha256=one.sha256)
        asked.service.making.wake()
    return Moved(to=f"/trials/{one.sha256}", data={"report": "waiting"}, status=202)


async def report_file(asked: Asked) -> Response:
    """Return a file of a report."""
    one = await asked.read(fingerprint_of, asked, asked.named("sha256"))
    making = asked.service.kept.making(f"report {one.sha256}")
    parts = asked.named("path").split("/")
    most = 3
    if making is None or making.state != "done" or len(parts) > most or not all(map(_PART.fullmatch, parts)):
        raise NotThere
    path = asked.service.reports.joinpath(one.sha256, *parts)
    kind = _KINDS.get(path.suffix)
    if kind is None or path.is_symlink() or not path.is_file():
        raise NotThere
    return FileResponse(path, media_type=kind, headers={"content-security-policy": REPORT_POLICY})
