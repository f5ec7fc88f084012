"""Every address and every job with every role, over ships with and without numbers, the same names among them."""

import os
from dataclasses import dataclass, replace
from datetime import UTC, datetime

import pytest
from benchmarks.store_documents import document
from tests.web.client import form_of
from tests.web.conftest import ADA, HIDDEN, NOW, Desk, Site

from shaftprint import __version__
from shaftprint.errors import StoreError
from shaftprint.fleet import submit
from shaftprint.fleet._arguments import arguments_of, job_arguments
from shaftprint.store import (
    JobRequest,
    add_document,
    claim,
    create_store,
    enqueue,
    finish,
    history,
    job,
    open_store,
    record_event,
)
from shaftprint.store._nouns import Ship
from shaftprint.store._overview import lines_now
from shaftprint.web import Listen, Serving, with_user
from shaftprint.web._kept import KeptJob, Upload
from shaftprint.web._rights import forbidden_by
from shaftprint.web._routes import ADDRESSES, routes_of
from shaftprint.web._service import Service
from shaftprint.web.access._person import Person, Role

BOB, NEW, OTHER_BOB = 9319466, 9100023, 9100011
SHIPS = {
    # two have the name of another ship, one of them without a number
    "namesake": Ship(name="Ada", class_name="Stan Tug 1205"),
    "ada": Ship(name="Ada", imo_number=ADA, class_name="Stan Tug 1205"),
    "bob": Ship(name="Bob", imo_number=BOB, class_name="Stan Tug 1205"),
    "cyd": Ship(name="Cyd", class_name="Stan Tug 1205"),
    "second": Ship(name="Bob", imo_number=OTHER_BOB, class_name="Stan Tug 1205"),
}
# name in the file of users: role, what was given, and which ships are seen by that
PEOPLE = {
    "nobody": (None, (), ()),
    "reader-of-ada": (Role.READER, (str(ADA),), ("ada",)),
    "tester-of-ada": (Role.TESTER, (str(ADA),), ("ada",)),
    "owner-of-ada": (Role.OWNER, (str(ADA),), ("ada",)),
    "tester-of-a-name": (Role.TESTER, ("Ada",), ("namesake",)),
    "owner-of-a-name": (Role.OWNER, ("Cyd", "Bob"), ("cyd",)),
    "tester-of-a-new-one": (Role.TESTER, (str(NEW),), ()),
    "owner-of-all": (Role.OWNER, ("all",), tuple(SHIPS)),
}
WRONG = (("name", "x"), ("password", "y"))
EVENT = {"what": "other", "at": "2026-05-01T08:00", "zone": "UTC", "note": "tried"}
WITHDRAWN = {"what": "docking", "at": "2025-09-01T00:00", "zone": "UTC", "why": "tried"}


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
SHIP, SHA, JOB, UPLOAD = "/ships/{ship}/port", "{sha}", "/jobs/{job}", "/recordings/{upload}"
FILES = {"vessel": "stan-tug-1205", "campaign": "short"}
WINDOWS = "/windows?vessel=stan-tug-1205&campaign=short"

# What every address does; one that is not here fails the first test below.
RULES = {
    ("GET", "/"): Rule(READ, "/", False),
    ("GET", "/api/v1/ships"): Rule(READ, "/api/v1/ships", False),
    ("GET", "/kiosk"): Rule(READ, "/kiosk", False),
    ("GET", "/api/v1/openapi.json"): Rule(READ, "/api/v1/openapi.json", False),
    ("GET", "/ships/{ship}/{line}"): Rule(READ, SHIP),
    ("POST", "/ships/{ship}/{line}/events"): Rule(
        Role.TESTER, SHIP + "/events", fields=tuple(EVENT.items()), good=(303, 201)
    ),
    ("POST", "/ships/{ship}/{line}/events/withdrawn"): Rule(
        Role.OWNER, SHIP + "/events/withdrawn", fields=tuple(WITHDRAWN.items()), good=(303, 200)
    ),
    # none of the ships may have this number
    ("POST", "/ships/{ship}/{line}/number"): Rule(
        Role.OWNER, SHIP + "/number", fields=(("imo", "1234568"),), good=(400,)
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
    ("PUT", "/api/v1/recordings/{name}"): Rule(Role.TESTER, "/api/v1/recordings/a.nc?line={ship}/port", good=(201,)),
    ("GET", "/recordings/{id}"): Rule(READ, UPLOAD),
    ("POST", "/recordings/{id}/look"): Rule(Role.TESTER, UPLOAD + "/look", good=(303, 202)),
    ("GET", "/recordings/{id}/windows"): Rule(READ, UPLOAD + WINDOWS),
    ("POST", "/recordings/{id}/windows"): Rule(
        Role.TESTER, UPLOAD + "/windows", fields=tuple(FILES.items()), good=(303, 202)
    ),
    # nobody has looked at them yet
    ("POST", "/recordings/{id}/windows/campaign"): Rule(
        Role.TESTER, UPLOAD + "/windows/campaign", fields=tuple(FILES.items()), good=(409,)
    ),
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


@pytest.fixture
def yard(tmp_path, password_hash, monkeypatch):
    """Give a server with all ships and people, and a job, an upload and an event of each ship."""
    store, users = tmp_path / "fleet.db", tmp_path / "users.toml"
    (tmp_path / "lies-here").mkdir()
    for name, (role, given, _) in PEOPLE.items():
        if role is not None:
            with_user(users, Person(name=name, role=role, ships=given, password=password_hash))
    shas = {}
    with create_store(str(store)) as opened:
        for place, (key, ship) in enumerate(SHIPS.items()):
            said = {"name": ship.name, "class_name": ship.class_name, "line": "port"}
            # named so at its newest test only: else it would be taken for the ship without a number
            said |= {} if ship.imo_number is None else {"imo_number": ship.imo_number}
            first = said | ({"name": "once"} if key == "ada" else {})
            shas[key] = [
                add_document(
                    opened,
                    document(
                        tested_at=f"20{year}-03-01T10:00:00Z", recording=f"{1000 * place + year:064x}",
                        ship=first if year == 25 else said,
                        seed=year, place=f"quay of {key}",
                    ),
                    named=key, now=NOW,
                ).sha256
                for year in (25, 26)
            ]  # fmt: skip
            record_event(opened, ship, "docking", at=datetime(2025, 9, 1, tzinfo=UTC), note=f"dock of {key}")
    serving = Serving(
        store=str(store), state=tmp_path / "state", users=users, folders=(tmp_path / "lies-here",),
        listen=Listen(host="127.0.0.1", port=8080),
    )  # fmt: skip
    monkeypatch.setenv("SHAFTPRINT_STORE", str(store))
    service = replace(Service.begun(serving, now=lambda: NOW), desk=Submitting())
    site = Site(service=service, shas=shas, jobs={}, uploads={})
    with open_store(str(store)) as opened:
        for key, ship in SHIPS.items():
            _with_job(site, opened, key, ship)
    yield site
    service.kept.close()
    service.store.close()


class Submitting(Desk):
    """Takes jobs as the process beside the server does, which test_judged_line.py asks itself."""

    async def ask(self, question, *, longest_s):
        if question["kind"] != "submit":
            return await super().ask(question, longest_s=longest_s)
        line = {name: question[name] for name in ("ship", "imo", "line")}
        files = [question[name] for name in ("recording", "vessel", "campaign")]
        arguments = job_arguments(*files, named="the form", **line, **question["facts"], only=line)
        with open_store(os.environ["SHAFTPRINT_STORE"]) as store:
            (one,) = submit(store, [arguments], now=NOW)
        return {"job": one.id, "args": dict(one.args)}


def _with_job(site, store, key, ship):
    kept, at = site.service.kept, NOW.isoformat()
    args = {"recording": f"/data/{key}.nc", "vessel": "stan-tug-1205", "campaign": "short", "imo": ship.imo_number}
    (one,) = enqueue(store, [JobRequest(key=key.encode().hex().zfill(64), args=args, version=__version__)], now=NOW)
    site.jobs[key], site.uploads[key] = one.id, key.encode().hex()[:16].zfill(16)
    kept.put_job(
        KeptJob(
            id=one.id, imo=ship.imo_number, ship=ship.name, line="port", name=f"{key}.nc", person="x", at=at, args=args
        )
    )
    (site.service.recordings / site.uploads[key]).mkdir()
    (site.service.recordings / site.uploads[key] / f"{key}.nc").write_bytes(b"no recording")
    kept.put_upload(
        Upload(
            id=site.uploads[key], imo=ship.imo_number, ship=ship.name, line="port", name=f"{key}.nc", size=12,
            sha256="ab" * 32, person="x", at=at,
        )
    )  # fmt: skip


def words_of(site):
    """Return what each ship is called in an address."""
    ids = {one.line.ship: one.ship_id for one in lines_now(site.service.store)}
    return {key: str(ship.imo_number or f"id-{ids[ship]}") for key, ship in SHIPS.items()}


def asked(site, browser, method, path, rule, key, word):
    """Return the answer to what a rule asks for of a ship."""
    first, second = site.shas[key]
    words = {"ship": word, "sha": second, "other": first, "job": site.jobs[key], "upload": site.uploads[key]}
    place = rule.path.format(**words)
    if path.startswith("/api/v1") and not place.startswith("/api/v1"):
        place = f"/api/v1{place}"
    if method == "GET":
        return browser.get(place, most_events=1)
    token = browser.known()
    if (method, path) == ("POST", "/upload"):
        kind, body = form_of({"token": token, "line": f"{word}/port"}, "a.nc", b"x")
        return browser.ask("POST", place, body=body, heads=[("content-type", kind)])
    if method == "PUT":
        return browser.put(place, b"x", token=token)
    fields = {name: value.format(**words) for name, value in rule.fields}
    return browser.post(place, fields, token=token)


def expected(rule, role, seen, key, *, api):
    """Return the status that somebody gets."""
    if rule.least is None:
        return rule.good
    if role is None:
        return (401,) if api else (303,)
    if role < rule.least:
        return (403,)
    if rule.all_ships:
        return rule.good if len(seen) == len(SHIPS) else (404,)
    if (rule.of_a_ship or "/classes/" in rule.path) and (key not in seen if rule.of_a_ship else not seen):
        return (404,)
    return rule.good


def test_every_address_has_a_rule(site):
    found = {(method, route.path) for route in routes_of(site.service) for method in route.methods if method != "HEAD"}
    assert {one for one in found if rule_of(*one) is None} == set()
    stated = {(one.method, one.path) for one in ADDRESSES}
    assert set(RULES) - {("GET", "/api/v1/ships")} == stated


@pytest.mark.slow
@pytest.mark.parametrize("who", PEOPLE)
def test_who_sees_what(yard, who):
    role, _, seen = PEOPLE[who]
    browser = yard.browser() if role is None else yard.person(who)
    cookie, words = browser.cookie, words_of(yard)
    for route in routes_of(yard.service):
        for method in sorted(route.methods - {"HEAD"}):
            rule = rule_of(method, route.path)
            for key in SHIPS if rule.of_a_ship else ("ada",):
                browser.cookie = "" if route.path.endswith("sign-out") else cookie
                answer = asked(yard, browser, method, route.path, rule, key, words[key])
                case = f"{who}: {method} {route.path} of {key}: {answer.status} {answer.text[:300]}"
                api = route.path.startswith("/api/v1")
                assert answer.status in expected(rule, role, seen, key, api=api), case
                for other in SHIPS:
                    if other not in seen:
                        hidden = (f"dock of {other}", f"quay of {other}", f"{other}.nc", yard.shas[other][1])
                        assert not any(one in answer.text for one in hidden), case


NAMES = ("Ada", "Bob", "Cyd", "Zed")
NUMBERS = (None, ADA, BOB, OTHER_BOB, NEW)


def _job_for(site, browser, query, kept):
    """Upload a recording and ask for its job; return the job, or None where either is refused."""
    answer = browser.put(f"/api/v1/recordings/a.nc?{query}", repr(kept).encode())
    if answer.status != 201:
        assert answer.status in (400, 404, 409), answer.text
        return None
    fields = {"source": f"upload:{answer.json['id']}", "vessel": "stan-tug-1205", "campaign": "short"}
    answer = browser.post("/api/v1/jobs", fields | {"tested_at": "2026-05-01T08:00Z"})
    assert answer.status in (201, 404, 409), answer.text
    return answer.json["job"] if answer.status == 201 else None


def _ended(site, number, place):
    """End a job as a worker does, with a fingerprint that says nothing of its ship; return where it was put."""
    store = site.service.store
    while (one := claim(store, owner="w", version=__version__, now=NOW)) is not None and one.id != number:
        continue
    arguments = arguments_of(one.args, named="job")
    content = document(
        ship=None,
        tested_at="2026-05-01T08:00:00Z",
        recording=f"{place:064x}",
        created=f"2026-06-01T00:00:{place % 60:02}Z",
    )
    return finish(store, one, content, stated=arguments.stated, only=arguments.only_line, now=NOW)


@pytest.mark.slow
@pytest.mark.parametrize("who", [name for name, (role, _, _) in PEOPLE.items() if role is not None and role > READ])
def test_a_job_writes_to_ships_that_its_person_sees_and_to_no_other(yard, who):
    person, browser = yard.service.sessions.users.named(who), yard.person(who)
    queries = [f"line={word}/port" for word in words_of(yard).values()]
    queries += [
        f"ship={name}&line=port" + ("" if number is None else f"&imo={number}")
        for name in (*NAMES, str(ADA))
        for number in NUMBERS
    ]
    done = 0
    for place, query in enumerate(queries):
        number = _job_for(yard, browser, query, place)
        if number is not None:
            added = _ended(yard, number, 50_000 + place)
            assert person.sees(added.line.ship), f"{query}: {added.line}"
            done += 1
    assert done
    lines = lines_now(yard.service.store)
    there = {one.line.ship for one in lines}
    for key, ship in SHIPS.items():
        # none has another number, and none that is not seen has another test
        assert any((one.name, one.imo_number) == (ship.name, ship.imo_number) for one in there) or person.sees(ship)
        if not person.sees(ship):
            shas = [one.fingerprint.sha256 for one in history(yard.service.store, ship).entries]
            assert shas == yard.shas[key]


def test_a_ship_that_is_another_one_by_the_end_of_a_job_is_not_written_to(yard):
    browser = yard.person("owner-of-a-name")
    number = _job_for(yard, browser, "ship=Cyd&line=port", 1)
    store = yard.service.store
    while (one := claim(store, owner="w", version=__version__, now=NOW)).id != number:
        continue
    # a command of whoever keeps the server gives Cyd its number
    said = {"name": "Cyd", "imo_number": NEW, "line": "port"}
    add_document(store, document(ship=said, recording="cc" * 32), named="x", now=NOW)
    arguments = arguments_of(one.args, named="job")
    with pytest.raises(StoreError, match="not in the store as it was"):
        finish(store, one, document(ship=None, recording="dd" * 32), stated=arguments.stated, only=arguments.only_line)
    assert job(store, number).state == "running"
    assert "Cyd" not in {one.line.ship.name for one in lines_now(store) if one.line.ship.imo_number is None}


def test_who_may_not_any_more_when_a_job_ends_is_refused(yard):
    number = _job_for(yard, yard.person("tester-of-ada"), f"line={ADA}/port", 1)
    forbidden = forbidden_by(yard.service.kept, yard.service.sessions.users)
    one = job(yard.service.store, number)
    assert forbidden(one) is None
    users = yard.service.serving.users
    users.write_text(users.read_text().replace('[users."tester-of-ada"]', '[users."gone"]'))
    assert "may not write to this line any more" in forbidden(one)
    # asked for by a command, nobody of this server has to have a right
    assert forbidden(replace(one, id=4711)) is None


def test_a_number_comes_from_an_owner_who_sees_it(yard):
    words, fields = words_of(yard), {"imo": str(NEW)}
    path = f"/ships/{words['cyd']}/port/number"
    assert yard.person("owner-of-a-name").post(path, fields).status == 404
    assert yard.person("tester-of-a-name").post(path, fields).status == 403
    owner = yard.person("owner-of-all")
    assert owner.post(path, {"imo": str(BOB)}).status == 400
    assert owner.post(path, fields).status == 303
    assert owner.post(f"/ships/{NEW}/port/number", {"imo": str(NEW)}).status == 409
    assert owner.get(f"/ships/{NEW}/port").status == 200
    tester = yard.person("tester-of-a-new-one")
    # who was given the number sees all that was of the name
    assert "quay of cyd" in tester.get(f"/trials/{yard.shas['cyd'][0]}").text
    assert tester.get(f"/recordings/{yard.uploads['cyd']}").status == 200
    assert yard.person("owner-of-a-name").get(f"/recordings/{yard.uploads['cyd']}").status == 404


def test_a_name_that_could_be_a_number_is_given_to_nobody():
    numbered = Person(name="x", role=Role.TESTER, ships=(str(ADA), "IMO 9319466"))
    assert numbered.sees(Ship(name="Ada", imo_number=ADA))
    assert not numbered.sees(Ship(name=str(ADA)))
    assert not numbered.sees(Ship(name="IMO 9319466"))


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
