"""Every address with every role: who gets in, who is told that nothing is there, and that no other ship shows."""

from dataclasses import dataclass

import pytest
from tests.web.client import form_of
from tests.web.conftest import ADA, HIDDEN

from shaftprint.web import ADDRESSES, Person, Role, routes_of, with_user

NAMES = {ADA: "Ada", HIDDEN: "Hidden"}
OTHER = {ADA: HIDDEN, HIDDEN: ADA}
WRONG = (("name", "x"), ("password", "y"))
EVENT = {"what": "other", "at": "2026-05-01T08:00", "zone": "UTC", "note": "tried"}


@dataclass(frozen=True)
class Rule:
    """Who may, and how it is asked for of a ship."""

    least: Role | None
    """The least role; None for everybody."""
    path: str
    """The address, with what stands for the ship."""
    of_a_ship: bool = True
    """Whether who does not see the ship finds nothing."""
    fields: tuple = ()
    """Fields of the form."""
    good: tuple = (200,)
    """What comes back to who may."""
    all_ships: bool = False
    """Whether it is for who sees all ships."""


READ = Role.READER
SHIP, SHA, JOB, UPLOAD = "/ships/{imo}/port", "{sha}", "/jobs/{job}", "/recordings/{upload}"
# What every address does; one that is not here fails the first test below.
RULES = {
    ("GET", "/"): Rule(READ, "/", False),
    ("GET", "/api/v1/ships"): Rule(READ, "/api/v1/ships", False),
    ("GET", "/ships/{ship}/{line}"): Rule(READ, SHIP),
    ("POST", "/ships/{ship}/{line}/events"): Rule(
        Role.TESTER, SHIP + "/events", fields=tuple(EVENT.items()), good=(303, 201)
    ),
    ("GET", "/trials/{sha256}"): Rule(READ, "/trials/{sha}"),
    # its recording is not there
    ("POST", "/trials/{sha256}/report"): Rule(Role.TESTER, "/trials/{sha}/report", good=(409,)),
    # nobody has made it
    ("GET", "/trials/{sha256}/report/{path:path}"): Rule(READ, "/trials/{sha}/report/index.html", good=(404,)),
    ("GET", "/fingerprints/{sha256}"): Rule(READ, "/fingerprints/{sha}"),
    ("GET", "/compare"): Rule(READ, "/compare?a={sha}&b={other}"),
    ("GET", "/classes/{name}"): Rule(READ, "/classes/Stan%20Tug%201205", False),
    ("GET", "/jobs"): Rule(READ, "/jobs", False),
    ("POST", "/jobs"): Rule(
        Role.TESTER, "/jobs", fields=(("source", "upload:{upload}"), ("vessel", "none")), good=(404,)
    ),
    ("GET", "/jobs/{id}"): Rule(READ, JOB),
    ("GET", "/jobs/{id}/events"): Rule(READ, JOB + "/events"),
    ("POST", "/jobs/{id}/retry"): Rule(Role.TESTER, JOB + "/retry", good=(409,)),
    ("GET", "/upload"): Rule(Role.TESTER, "/upload", False),
    ("POST", "/upload"): Rule(Role.TESTER, "/upload", good=(303,)),
    ("PUT", "/api/v1/recordings/{name}"): Rule(Role.TESTER, "/api/v1/recordings/a.nc?line={imo}/port", good=(201,)),
    ("GET", "/recordings/{id}"): Rule(READ, UPLOAD),
    ("POST", "/recordings/{id}/look"): Rule(Role.TESTER, UPLOAD + "/look", good=(303, 202)),
    ("GET", "/folders"): Rule(Role.TESTER, "/folders", False, all_ships=True),
    ("GET", "/folders/{number}/{inside:path}"): Rule(Role.TESTER, "/folders/0/", False, all_ships=True),
    ("GET", "/audit"): Rule(Role.OWNER, "/audit", False),
    ("GET", "/sign-in"): Rule(None, "/sign-in", False, good=(200, 303)),
    ("POST", "/sign-in"): Rule(None, "/sign-in", False, fields=WRONG, good=(401,)),
    ("POST", "/sign-out"): Rule(None, "/sign-out", False, good=(303, 200)),
    ("GET", "/api/v1/session"): Rule(None, "/api/v1/session", False),
    ("POST", "/api/v1/session"): Rule(None, "/api/v1/session", False, fields=WRONG, good=(401,)),
    ("GET", "/static/{name}"): Rule(None, "/static/web.css", False),
}


def rule_of(method, path):
    return RULES.get((method, path)) or RULES.get((method, path.removeprefix("/api/v1")))


def asked(site, browser, method, path, rule, imo):
    """Return the answer to what a rule asks for of a ship."""
    first, second = site.shas[imo]
    words = {"imo": imo, "sha": second, "other": first, "job": site.jobs[imo], "upload": site.uploads[imo]}
    place = rule.path.format(**words)
    if path.startswith("/api/v1") and not place.startswith("/api/v1"):
        place = f"/api/v1{place}"
    if method == "GET":
        return browser.get(place, most_events=1)
    token = browser.known()
    if (method, path) == ("POST", "/upload"):
        kind, body = form_of({"token": token, "line": f"{imo}/port"}, "a.nc", b"x")
        return browser.ask("POST", place, body=body, heads=[("content-type", kind)])
    if method == "PUT":
        return browser.put(place, b"x", token=token)
    fields = {name: value.format(**words) for name, value in rule.fields}
    return browser.post(place, fields, token=token)


def expected(rule, role, seen, imo, *, api):
    """Return the status that somebody gets."""
    if rule.least is None:
        return rule.good
    if role is None:
        return (401,) if api else (303,)
    if role < rule.least:
        return (403,)
    if rule.all_ships:
        return rule.good if seen == "all" else (404,)
    if rule.of_a_ship and seen != "all" and seen != imo:
        return (404,)
    return rule.good


def test_every_address_has_a_rule(site):
    found = {(method, route.path) for route in routes_of(site.service) for method in route.methods if method != "HEAD"}
    assert {one for one in found if rule_of(*one) is None} == set()
    stated = {(one.method, one.path) for one in ADDRESSES}
    assert set(RULES) - {("GET", "/api/v1/ships")} == stated


PEOPLE = [(None, None), *((role, seen) for role in Role for seen in (ADA, HIDDEN, "all"))]


@pytest.mark.slow
@pytest.mark.parametrize(("role", "seen"), PEOPLE)
def test_who_sees_what(made, tmp_path, role, seen):
    (tmp_path / "lies-here").mkdir()
    site = made(folders=(tmp_path / "lies-here",))
    who = {ADA: "ada", HIDDEN: "hidden", "all": "all"}.get(seen)
    signed_in = site.browser() if role is None else site.person(f"{role.name.lower()}-{who}")
    cookie = signed_in.cookie
    for route in routes_of(site.service):
        for method in sorted(route.methods - {"HEAD"}):
            for imo in (ADA, HIDDEN):
                signed_in.cookie = cookie
                if route.path.endswith("sign-out"):
                    signed_in.cookie = ""
                rule = rule_of(method, route.path)
                answer = asked(site, signed_in, method, route.path, rule, imo)
                api = route.path.startswith("/api/v1")
                case = f"{method} {route.path} of {NAMES[imo]}: {answer.status} {answer.text[:300]}"
                assert answer.status in expected(rule, role, seen, imo, api=api), case
                hidden = [one for one in NAMES if seen not in ("all", one)]
                for one in hidden:
                    # the page that was asked for may be named in what leads to the page on which one signs in
                    assert NAMES[one] not in answer.text, case
                    assert site.shas[one][1] not in answer.text, case


def test_unknown_and_forbidden_are_alike(site):
    reader = site.person("reader-ada")
    sha = site.shas[HIDDEN][0]
    pairs = [
        (f"/ships/{HIDDEN}/port", "/ships/9000015/port"),
        (f"/trials/{sha}", f"/trials/{'0' * 64}"),
        (f"/fingerprints/{sha}", f"/fingerprints/{'0' * 64}"),
        (f"/jobs/{site.jobs[HIDDEN]}", "/jobs/4711"),
        (f"/recordings/{site.uploads[HIDDEN]}", "/recordings/00000000000000ff"),
        (f"/compare?a={sha}&b={sha}", f"/compare?a={'0' * 64}&b={'0' * 64}"),
    ]
    for forbidden, unknown in pairs:
        one, two = reader.get(forbidden), reader.get(unknown)
        assert (one.status, two.status) == (404, 404), forbidden
        assert one.text.replace(forbidden, "") == two.text.replace(unknown, ""), forbidden


def test_a_name_gives_no_right_to_a_ship_with_a_number(made, password_hash):
    site = made()
    with_user(
        site.service.serving.users, Person(name="namesake", role=Role.OWNER, ships=("Hidden",), password=password_hash)
    )
    assert site.person("namesake").get(f"/ships/{HIDDEN}/port").status == 404


def test_what_one_uploads_for_a_ship_that_he_does_not_see_is_not_kept(site):
    tester = site.person("tester-ada")
    for query in (f"line={HIDDEN}/port", f"line=port&ship=Hidden&imo={HIDDEN}", "line=port&ship=Hidden"):
        assert tester.put(f"/api/v1/recordings/a.nc?{query}", b"x").status == 404
    assert len(list(site.service.recordings.iterdir())) == 2
