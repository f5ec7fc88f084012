"""Pages are set: templates filled, heads of answers written. What a program asks for is JSON of the same content."""

import json
import re
from functools import cache
from html import unescape
from typing import Any, Final
from urllib.parse import urlencode

from jinja2 import Environment
from starlette.responses import RedirectResponse, Response

from shaftprint.markup._environment import environment, shown_table, template_text
from shaftprint.plain_table import Column, Symbol, Table
from shaftprint.web._asked import Asked, Moved, Shown
from shaftprint.web._page_tables import file_of_tables
from shaftprint.web.access._person import Role

TEMPLATES = (
    "frame.html.j2",
    "strip.html.j2",
    "parts.html.j2",
    "ships.html.j2",
    "line.html.j2",
    "trial.html.j2",
    "compare.html.j2",
    "class.html.j2",
    "jobs.html.j2",
    "job.html.j2",
    "upload.html.j2",
    "files.html.j2",
    "kiosk.html.j2",
    "recording.html.j2",
    "windows.html.j2",
    "folder.html.j2",
    "audit.html.j2",
    "sign-in.html.j2",
    "refused.html.j2",
)
_ROOM = "shaftprint.web"
_CAPTION: Final = re.compile(r"<caption>(.*?)</caption>", re.DOTALL)
_TAG: Final = re.compile(r"<[^>]*>")


@cache
def _environment() -> Environment:
    made = environment({name: template_text(_ROOM, name) for name in TEMPLATES})
    made.globals["table"] = lambda content: shown_table(made, table_of(content))
    return made


def table_of(content: dict[str, Any]) -> Table:
    """Return the table of JSON content."""
    symbols = content.get("symbols") or [False] * len(content["rows"])
    columns = tuple(
        Column(Symbol(one["heading"]) if one.get("symbol") else one["heading"], number=one.get("number", False))
        for one in content["columns"]
    )
    rows = tuple(
        (Symbol(row[0]) if is_symbol else row[0], *row[1:])
        for row, is_symbol in zip(content["rows"], symbols, strict=True)
    )
    return Table(title=content["title"], columns=columns, rows=rows, note=content.get("note", ""))


def answer_of(asked: Asked, said: Shown | Moved | Response) -> Response:
    """Return the answer to a request: a page, or JSON for a program."""
    if isinstance(said, Response):
        return said
    if asked.is_api:
        return _json(said.data, said.status)
    if isinstance(said, Moved):
        return RedirectResponse(said.to, status_code=303)
    if asked.query("as") and asked.request.method == "GET":
        kind, number = asked.query("as"), asked.query("table")
        return file_of_tables(page_of(asked, said), kind=kind, number=number, name=said.title)
    return Response(page_of(asked, said), status_code=said.status, media_type="text/html")


def page_of(asked: Asked | None, said: Shown) -> str:
    """Return a page as HTML.

    ``asked``: the request; None where nobody signed in. ``said``: what it says.
    """
    person = None if asked is None else asked.person
    page = (
        _environment()
        .get_template(said.template)
        .render(
            title=said.title,
            data=said.data,
            drawn=said.drawn,
            person=person,
            may_test=person is not None and person.role >= Role.TESTER,
            may_audit=person is not None and person.role >= Role.OWNER,
            signs_in=asked is not None and asked.service.sessions.users is not None,
            folders=asked is not None
            and person is not None
            and person.sees_all
            and bool(asked.service.serving.folders),
            token="" if asked is None else asked.session.token,
            path="" if asked is None else asked.request.url.path,
        )
    )
    return page if asked is None or asked.request.method != "GET" else _with_files(page, asked)


def _with_files(page: str, asked: Asked) -> str:
    """Return a page with links to its tables as files, where it has any."""
    titles = [unescape(_TAG.sub("", one)) for one in _CAPTION.findall(page)]
    if not titles:
        return page
    query = [(name, value) for name, value in asked.request.query_params.items() if name not in ("as", "table")]
    links = [urlencode([*query, ("as", "csv"), ("table", str(at))]) for at in range(1, len(titles) + 1)]
    said = {"tables": list(zip(titles, links, strict=True)), "book": urlencode([*query, ("as", "xlsx")])}
    head, end, tail = page.rpartition("</main>")
    return head + _environment().get_template("files.html.j2").render(**said) + end + tail


def refusal(sentence: str, status: int, *, api: bool, asked: Asked | None = None) -> Response:
    """Return a refusal in one sentence."""
    if api:
        return _json({"refused": sentence}, status)
    shown = Shown(template="refused.html.j2", title=_HEADINGS.get(status, "Not possible"), data={"sentence": sentence})
    return Response(page_of(asked, shown), status_code=status, media_type="text/html")


_HEADINGS = {404: "Nothing is here", 403: "Not allowed", 413: "Too large", 421: "Unknown name", 429: "Wait a moment"}


def _json(data: Any, status: int) -> Response:
    text = json.dumps(data, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    return Response(text.encode("utf-8", "replace"), status_code=status, media_type="application/json")
