"""Requests and uploads that are damaged or meant to do damage: each is answered, none with an error of the server."""

import random

import pytest
from benchmarks.mutations import mutated
from tests.web.client import form_of
from tests.web.conftest import ADA

COUNT = 40


@pytest.fixture
def tester(site):
    browser = site.person("owner-all")
    browser.known()
    return browser


def strange(raw, seed):
    rng = random.Random(seed)  # noqa: S311
    return [mutated(raw, rng) for _ in range(COUNT)]


def refused_or_done(answer):
    return answer.status < 500 and "Traceback" not in answer.text


def test_strange_paths(site, tester):
    for place, path in enumerate(
        ("/ships/id-3/port", "/?q=a&page=2", "/folders/0/a", "/jobs/1/events", "/trials/" + "0" * 64)
    ):
        for raw in strange(path.encode(), place):
            heads = [("last-event-id", raw.decode("latin-1").replace("\n", "").replace("\r", ""))]
            assert refused_or_done(tester.get(raw.decode("latin-1"), heads=heads, most_events=1)), raw


def test_strange_forms(site, tester):
    kind = [("content-type", "application/x-www-form-urlencoded"), ("x-csrf-token", tester.token)]
    forms = {
        f"/ships/{ADA}/port/events": b"what=docking&at=2026-05-01T08:00&zone=Europe/Amsterdam&numbers=K_Q&note=x",
        "/jobs": b"source=upload:0123456789abcdef&vessel=stan-tug-1205&campaign=short&draught_m=2&tested_at=2026-05-01",
    }
    for place, (path, body) in enumerate(forms.items()):
        for raw in strange(body, 10 + place):
            assert refused_or_done(tester.ask("POST", path, body=raw, heads=kind)), raw
        for raw in strange(b'{"what": "docking", "at": "2026-05-01T08:00", "zone": "UTC"}', 20 + place):
            heads = [("content-type", "application/json"), kind[1]]
            assert refused_or_done(tester.ask("POST", f"/api/v1{path}", body=raw, heads=heads)), raw


def test_strange_uploads(site, tester):
    kind, body = form_of({"token": tester.token, "line": f"{ADA}/port"}, "log.nc", bytes(range(256)) * 4)
    for raw in strange(body, 30):
        answer = tester.ask("POST", "/upload", body=raw, heads=[("content-type", kind)])
        assert refused_or_done(answer), raw
    for raw in strange(kind.encode(), 31):
        answer = tester.ask("POST", "/upload", body=body, heads=[("content-type", raw.decode("latin-1"))])
        assert refused_or_done(answer), raw
    for path in site.service.recordings.rglob("*.part"):
        raise AssertionError(path)


def test_strange_cookies_and_hosts(site, tester):
    cookie = tester.cookie
    for raw in strange(cookie.encode(), 40):
        tester.cookie = raw.decode("latin-1")
        assert refused_or_done(tester.get("/"))
    for raw in strange(b"127.0.0.1:8080", 41):
        assert refused_or_done(tester.get("/", host=raw.decode("latin-1") or " "))
