"""The description for programs, held against the addresses and against what they give; the wall."""

import re

from tests.web.conftest import ADA
from tests.web.test_pages import STEP

from shaftprint.web._openapi import ANSWERS, FIELDS
from shaftprint.web._routes import ADDRESSES, routes_of


def test_every_address_for_programs_is_described_and_no_other(site):
    told = site.person("reader-ada").get("/api/v1/openapi.json").json
    assert told["openapi"] == "3.1.0"
    described = {(method.upper(), path) for path, every in told["paths"].items() for method in every}
    there = {
        (method, re.sub(r":path}", "}", route.path))
        for route in routes_of(site.service)
        for method in route.methods - {"HEAD"}
        if route.path.startswith("/api/v1/")
    }
    assert described == there
    names = [one["operationId"] for every in told["paths"].values() for one in every.values()]
    assert len(set(names)) == len(names)
    for path, every in told["paths"].items():
        for method, one in every.items():
            places = {each["name"] for each in one["parameters"] if each["in"] == "path"}
            assert places == set(re.findall(r"{(\w+)}", path)), path
            assert one["summary"].endswith("."), path
            assert {"2XX", "4XX"} == set(one["responses"])
            # what changes something needs the token
            assert method == "get" or path.endswith("/session") or all("token" in each for each in one["security"])


def test_answers_have_the_keys_that_are_described(site):
    owner = site.person("owner-all")
    words = {"ship": ADA, "line": "port", "sha256": site.shas[ADA][0]}
    for path, keys in ANSWERS.items():
        number = site.jobs[ADA] if path.startswith("/jobs") else site.uploads[ADA]
        place = path.removeprefix("/api/v1").format(**words, id=number)
        query = "?vessel=stan-tug-1205&campaign=short" if path.endswith("/windows") else ""
        answer = owner.get(f"/api/v1{'/ships' if place == '/' else place}{query}")
        assert answer.status == 200, (path, answer.text)
        assert set(answer.json) == set(keys), path


def test_forms_are_those_of_the_addresses():
    twins = {one.path for one in ADDRESSES if one.method == "POST" and (one.twin or one.path.startswith("/api/v1"))}
    assert twins == set(FIELDS)


def test_the_wall_shows_those_first_that_need_somebody(site):
    from shaftprint.web._asked import line_key

    for one in site.service.lines.now():
        is_ada = one.line.ship.imo_number == ADA
        summary = {"causes": [STEP] if is_ada else [], "because": "", "since": "2025-03-01", "word": "x"}
        site.service.kept.put_finding(line_key(one.line.ship, "port"), one.state, summary, summary)
    told = site.person("reader-all").get("/api/v1/kiosk").json
    assert [(one["ship"], one["word"]) for one in told["lines"]] == [
        ("Ada", "changed: propeller"),
        ("Hidden", "no change seen since 2025-03"),
    ]
    assert (told["look"], told["more"]) == ("look", 0)
    page = site.person("reader-hidden").get("/kiosk").text
    assert "Ada" not in page
    assert '<meta http-equiv="refresh" content="60">' in page
