"""What programs may ask, as a description that tools read (OpenAPI 3.1): made of the addresses of the server."""

import re
from collections.abc import Mapping, Sequence
from typing import Any, Final

from shaftprint import __version__
from shaftprint.web._asked import API
from shaftprint.web._endpoint import TOKEN_HEAD, Address, twin_of
from shaftprint.web.access._sessions import COOKIE

_PART: Final = re.compile(r"\{(\w+)(?::path)?\}")
_QUERY: Final[Mapping[str, tuple[str, ...]]] = {
    "/": ("q", "kind", "page"),
    "/compare": ("a", "b"),
    "/classes/{name}": ("number",),
    "/recordings/{id}": ("vessel", "campaign"),
    "/recordings/{id}/windows": ("vessel", "campaign"),
    "/audit": ("kind",),
    f"{API}/recordings/{{name}}": ("line", "ship", "imo"),
}
FIELDS: Final[Mapping[str, tuple[str, ...]]] = {
    "/ships/{ship}/{line}/events": ("what", "at", "zone", "numbers", "note"),
    "/ships/{ship}/{line}/events/withdrawn": ("what", "at", "zone", "why"),
    "/ships/{ship}/{line}/number": ("imo",),
    "/trials/{sha256}/report": (),
    "/jobs": ("source", "vessel", "campaign", "structure", "tested_at", "place", "time_zone", "draught_m", "trim_m",
              "water_temperature_c", "water_density_kg_m3", "depth_m", "wind_m_s", "ship", "imo", "line"),
    "/jobs/{id}/retry": (),
    "/recordings/{id}/look": (),
    "/recordings/{id}/windows": ("vessel", "campaign"),
    "/recordings/{id}/windows/campaign": ("vessel", "campaign", "do", "use.0", "later.0", "from.0", "to.0"),
    "/sign-out": (),
    f"{API}/session": ("name", "password"),
}  # fmt: skip
"""Fields of each form, by its address."""
ANSWERS: Final[Mapping[str, tuple[str, ...]]] = {
    "/": ("headline", "lines", "counts", "found", "page", "pages"),
    "/kiosk": ("headline", "look", "at", "lines", "more"),
    "/ships/{ship}/{line}": ("ship", "line", "address", "kind", "word", "look", "note", "sentences", "next_test",
                             "finding", "events", "tests"),
    "/trials/{sha256}": ("ship", "line", "tested_at", "trustworthy", "superseded", "sha256", "made_at", "version",
                         "structure", "recording_sha256", "vessel_sha256", "conditions", "numbers", "previous", "first",
                         "report"),
    "/jobs": ("headline", "jobs"),
    "/jobs/{id}": ("job",),
    "/upload": ("uploads", "most_bytes"),
    "/recordings/{id}": ("upload", "inspection", "file"),
    "/recordings/{id}/windows": ("recording", "vessel", "campaign", "state", "sentence", "file", "chosen", "seen"),
    "/folders": ("entries", "file"),
    f"{API}/session": ("person", "token"),
}  # fmt: skip
"""Keys of what programs are given, by the address; a test holds them against the answers."""
_OTHER_MEDIA: Final = {"/jobs/{id}/events": "text/event-stream"}


def openapi_of(addresses: Sequence[Address]) -> dict[str, Any]:
    """Return the description of all that programs may ask."""
    paths: dict[str, dict[str, Any]] = {}
    for one in addresses:
        if one.twin or one.path.startswith(f"{API}/"):
            path = twin_of(one.path) if one.twin else one.path
            paths.setdefault(_PART.sub(r"{\1}", path), {})[one.method.lower()] = _operation(one)
    cookie = {"type": "apiKey", "in": "cookie", "name": COOKIE}
    token = {"type": "apiKey", "in": "header", "name": TOKEN_HEAD}
    refused = {
        "type": "object",
        "required": ["refused"],
        "properties": {"refused": {"type": "string", "description": "Why, in one sentence."}},
    }
    return {
        "openapi": "3.1.0",
        "info": {"title": "shaftprint", "version": __version__, "description": "The pages of a store, for programs."},
        "paths": paths,
        "components": {"securitySchemes": {"cookie": cookie, "token": token}, "schemas": {"Refused": refused}},
    }


def _operation(one: Address) -> dict[str, Any]:
    words = " ".join((one.answer.__doc__ or "").partition("\n\n")[0].split())
    refused = {"description": "Refused, and why.", "content": _json({"$ref": "#/components/schemas/Refused"})}
    needed: Mapping[str, list[str]] = {"cookie": []} | ({} if one.method == "GET" else {"token": []})
    words_of_path = re.findall(r"\w+", twin_of(one.path) if one.twin else one.path)
    made: dict[str, Any] = {
        "summary": words,
        "operationId": "_".join([one.method.lower(), *words_of_path[2:]]),
        "parameters": [
            *(_parameter(name, "path") for name in _PART.findall(one.path)),
            *(_parameter(name, "query") for name in (_QUERY.get(one.path, ()) if one.method != "POST" else ())),
        ],
        "responses": {"2XX": {"description": "What was asked for.", "content": _content(one)}, "4XX": refused},
        "security": [] if one.least is None else [needed],
    }
    if one.least is not None:
        made["description"] = f"For the role {one.least.name.lower()} and those above it."
    if one.method == "POST":
        fields = {name: {"type": "string"} for name in FIELDS[one.path]}
        form = {"schema": {"type": "object", "properties": fields}}
        made["requestBody"] = {"content": {"application/x-www-form-urlencoded": form, "application/json": form}}
    elif one.method == "PUT":
        made["requestBody"] = {"required": True, "content": {"application/octet-stream": {"schema": {}}}}
    return made


def _parameter(name: str, place: str) -> dict[str, Any]:
    return {"name": name, "in": place, "required": place == "path", "schema": {"type": "string"}}


def _content(one: Address) -> dict[str, Any]:
    if one.path in _OTHER_MEDIA:
        return {_OTHER_MEDIA[one.path]: {"schema": {"type": "string"}}}
    keys = ANSWERS.get(one.path, ()) if one.method == "GET" else ()
    schema: dict[str, Any] = {"type": "object"}
    return _json(schema | ({"required": list(keys), "properties": {name: {} for name in keys}} if keys else {}))


def _json(schema: dict[str, Any]) -> dict[str, Any]:
    return {"application/json": {"schema": schema}}
