"""What stands before every page: names of the server, tokens of forms, cookies, limits, heads."""

import os
import re
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest
from tests.web.client import form_of
from tests.web.conftest import ADA, PASSWORD

from shaftprint.errors import ServerError
from shaftprint.web import Listen, Serving, with_user
from shaftprint.web._door import Door
from shaftprint.web._routes import routes_of
from shaftprint.web._service import Service
from shaftprint.web._settings import listen_at
from shaftprint.web.access._audit import Audit
from shaftprint.web.access._person import Person, Role
from shaftprint.web.access._throttle import network_of


@pytest.mark.parametrize("host", ["evil.example", "evil.example:8080", "127.0.0.1.evil.example", "", "127.0.0.1@evil"])
def test_a_name_that_is_not_the_server_s_is_refused_on_this_computer_too(made, host):
    browser = made(users=False).browser()
    for path in ("/", "/api/v1/ships", "/static/web.css", "/nothing"):
        assert browser.get(path, host=host or " ").status == 421
    assert browser.get("/", host="localhost:8080").status == 200
    assert browser.get("/", host="[::1]:8080").status == 200


def test_two_hosts_are_refused(site):
    assert site.browser().ask("GET", "/", heads=[("host", "127.0.0.1"), ("host", "evil.example")]).status == 421


def test_whatever_is_sent_needs_the_token_of_the_browser(site):
    owner = site.person("owner-all")
    other = site.person("owner-ada").known()
    for route in routes_of(site.service):
        for method in route.methods & {"POST", "PUT"}:
            path = re.sub(r"\{(\w+)(:path)?\}", "x", route.path)
            if path == "/upload":
                kind, body = form_of({"token": other, "line": f"{ADA}/port"}, "a.nc", b"x")
                assert owner.ask("POST", path, body=body, heads=[("content-type", kind)]).status == 403
                continue
            for token in ("", other):
                sent = owner.put(path, b"x", token=token) if method == "PUT" else owner.post(path, token=token)
                assert sent.status == 403, path


@pytest.mark.parametrize(
    "heads", [[("origin", "https://evil.example")], [("origin", "null")], [("sec-fetch-site", "cross-site")]]
)
def test_what_another_page_sends_is_refused(site, heads):
    browser = site.person("tester-all")
    assert browser.post(f"/ships/{ADA}/port/events", {"what": "docking"}, heads=heads).status == 403


def test_the_cookie_is_out_of_reach_of_scripts_and_of_other_pages(made):
    answer = made().browser().get("/sign-in")
    parts = {one.strip().lower() for one in answer.heads["set-cookie"].split(";")}
    assert {"httponly", "samesite=strict", "path=/"} <= parts
    assert "secure" not in parts


def test_behind_tls_the_cookie_is_for_tls_only(made):
    answer = made(behind_tls=True).browser().get("/sign-in")
    assert "secure" in answer.heads["set-cookie"].lower()
    assert "strict-transport-security" in answer.heads


def test_a_cookie_that_was_changed_is_nobody_s(site):
    browser = site.person("reader-ada")
    payload, rest = browser.cookie.split(".", 1)
    for forged in (payload[:-2] + "AA." + rest, "x", "." * 3000, payload):
        browser.cookie = forged
        assert browser.get(f"/ships/{ADA}/port").status == 303


def test_signing_out_ends_the_session_for_whoever_has_its_cookie(site):
    browser = site.person("reader-ada")
    cookie = browser.cookie
    assert browser.get("/").status == 200
    browser.post("/sign-out")
    browser.cookie = cookie
    assert browser.get("/").status == 303


def test_who_is_taken_out_of_the_file_is_out(site):
    browser = site.person("reader-ada")
    users = site.service.serving.users
    text = users.read_text()
    users.write_text(text.replace('[users."reader-ada"]', '[users."another"]'))
    assert browser.get("/").status == 303


def test_wrong_passwords_make_one_wait(site):
    browser = site.browser()
    for _ in range(5):
        assert browser.post("/sign-in", {"name": "reader-ada", "password": "no"}).status == 401
    waiting = browser.post("/sign-in", {"name": "reader-ada", "password": PASSWORD})
    assert waiting.status == 429
    assert int(waiting.heads["retry-after"]) >= 1
    # from there another name waits too; elsewhere nobody does: nobody locks out another by his name
    assert browser.post("/sign-in", {"name": "tester-ada", "password": PASSWORD}).status == 429
    elsewhere = site.browser(address="198.51.100.9")
    assert elsewhere.post("/sign-in", {"name": "reader-ada", "password": PASSWORD}).status == 303


def test_a_browser_that_is_known_does_not_wait_for_others_of_its_network(site):
    known = site.person("reader-ada")
    known.post("/sign-out")
    stranger = site.browser()
    for _ in range(6):
        stranger.post("/sign-in", {"name": "reader-ada", "password": "no"})
    assert stranger.post("/sign-in", {"name": "reader-ada", "password": PASSWORD}).status == 429
    # it is known for its own name only, and counts for itself
    assert known.post("/sign-in", {"name": "tester-ada", "password": PASSWORD}).status == 429
    assert known.post("/sign-in", {"name": "reader-ada", "password": PASSWORD}).status == 303


def test_own_sign_ins_between_take_back_no_wrong_password_of_others(site):
    for name in ("reader-all", "tester-all", "owner-all", "owner-ada", "reader-hidden"):
        site.browser().post("/sign-in", {"name": name, "password": "no"})
        status = site.browser().post("/sign-in", {"name": "tester-hidden", "password": PASSWORD}).status
    assert status == 429


@pytest.mark.parametrize(
    ("address", "network"),
    [
        ("192.0.2.7", "192.0.2.7"),
        ("2001:db8:1:2:3::4", "2001:db8:1:2::/64"),
        ("::ffff:192.0.2.7", "192.0.2.7"),
        ("", ""),
    ],
)
def test_an_address_counts_by_its_network(address, network):
    assert network_of(address) == network


@pytest.mark.parametrize("path", ["//evil.example", "https://evil.example", "/\\evil.example", "javascript:x"])
def test_after_signing_in_nobody_is_led_elsewhere(site, path):
    fields = {"name": "reader-ada", "password": PASSWORD, "next": path}
    assert site.browser().post("/sign-in", fields).heads["location"] == "/"


def test_a_form_and_an_address_have_an_end(site):
    browser = site.person("tester-ada")
    assert browser.post(f"/ships/{ADA}/port/events", {"note": "x" * 70_000}).status == 413
    assert browser.get("/" + "x" * 3000).status == 414
    assert browser.get("/?q=" + "x" * 5000).status == 414


def test_every_page_forbids_scripts_and_styles_within_it_and_has_none(site):
    browser = site.person("owner-all")
    sha = site.shas[ADA][1]
    job, upload = site.jobs[ADA], site.uploads[ADA]
    paths = ("/", f"/ships/{ADA}/port", f"/trials/{sha}", f"/compare?a={sha}&b={site.shas[ADA][0]}", "/jobs", "/upload",
             f"/jobs/{job}", f"/recordings/{upload}", "/audit", "/nothing", "/classes/Stan%20Tug%201205")  # fmt: skip
    for path in paths:
        answer = browser.get(path)
        policy = answer.heads["content-security-policy"]
        assert "default-src 'self'" in policy
        assert "unsafe" not in policy
        assert "frame-ancestors 'none'" in policy
        assert answer.heads["x-content-type-options"] == "nosniff"
        text = answer.text
        assert not re.search(r"<script(?![^>]*\bsrc=)", text), path
        assert not re.search(r"<style|\sstyle=|\son\w+=", text), path
        assert not re.search(r"(?:src|href|action)=\"(?:https?:)?//", text), path


def test_other_computers_need_a_file_of_users(tmp_path):
    with pytest.raises(ServerError, match="needs --users FILE"):
        Serving(store="x.db", state=tmp_path, listen=Listen(host="0.0.0.0", port=8443))  # noqa: S104
    assert Serving(store="x.db", state=tmp_path, listen=listen_at("[::1]:80")).listen.is_local


@pytest.mark.parametrize("text", ["8080", "host:", "host:99999", ":80", "host:8o"])
def test_where_to_listen_is_a_host_and_a_port(text):
    with pytest.raises(ServerError, match="expected HOST:PORT"):
        listen_at(text)


def test_the_folder_of_the_server_is_nobody_else_s(site):
    state = site.service.serving.state
    assert state.stat().st_mode & 0o077 == 0
    assert (state / "secret").stat().st_mode & 0o077 == 0
    assert site.service.serving.users.stat().st_mode & 0o077 == 0


def test_deeds_are_written_down_and_shown_to_owners_of_the_ship(site):
    site.person("tester-ada").post(
        f"/ships/{ADA}/port/events", {"what": "docking", "at": "2026-05-01T08:00", "zone": "UTC"}
    )
    site.person("tester-hidden").post("/sign-out")
    deeds = site.person("owner-ada").get("/api/v1/audit").json["deeds"]
    found = {(one["person"], one["deed"]) for one in deeds}
    assert ("tester-ada", "noted an event") in found
    assert not any(person == "tester-hidden" for person, _ in found)


def test_roles_go_up():
    assert Role.READER < Role.TESTER < Role.OWNER


def test_refusals_are_counted_and_push_out_no_deeds(site):
    owner = site.person("owner-all")
    stranger = site.browser(address="198.51.100.9")
    for place in range(60):
        stranger.post("/sign-in", {"name": f"x{place}", "password": "no"}, token=stranger.token or stranger.known())
    folder = site.service.serving.state
    # one line of those that were wrong, one of those that had to wait
    assert len((folder / "refused.jsonl").read_text().splitlines()) == 2
    deeds = owner.get("/api/v1/audit").json["deeds"]
    assert {one["deed"] for one in deeds} == {"signed in"}
    refused = owner.get("/api/v1/audit?kind=refused%20sign-ins").json["deeds"]
    assert {one["deed"] for one in refused} == {"gave a wrong password", "had to wait before signing in"}
    assert site.person("owner-ada").get("/api/v1/audit?kind=refused%20sign-ins").json["deeds"] == []


def test_refusals_of_a_minute_are_one_line_with_their_number(tmp_path):
    audit = Audit(path=tmp_path / "audit.jsonl")
    begin = datetime(2026, 11, 24, 12, tzinfo=UTC)
    for second in (0, 1, 59, 61):
        audit.refused("gave a wrong password", address="192.0.2.7", now=begin + timedelta(seconds=second))
    newest = list(audit.newest(refusals=True))
    assert [one.get("times") for one in newest] == [None, 2, None]


@pytest.mark.slow
def test_deeds_go_through_files_that_are_put_aside(tmp_path, monkeypatch):
    audit = Audit(path=tmp_path / "audit.jsonl")
    note = "x" * 290
    monkeypatch.setattr(os, "fsync", lambda _: None)
    at = datetime(2026, 11, 24, 12, tzinfo=UTC)
    count = 60_000
    for place in range(count):
        audit.note("noted an event", person="anna", address="", now=at, place=place, note=note)
    files = sorted(tmp_path.iterdir())
    assert [one.name for one in files] == ["audit.1.jsonl", "audit.2.jsonl", "audit.jsonl"]
    assert all(one.stat().st_size <= 8 * 2**20 + 1000 for one in files)
    assert all(one.stat().st_mode & 0o077 == 0 for one in files)
    assert [one["place"] for one in audit.newest()] == list(reversed(range(count)))


def test_files_of_passwords_and_sessions_are_private_from_their_first_byte(site, tmp_path, password_hash, monkeypatch):
    seen = []
    write = Path.write_bytes

    def spied(path, content):
        seen.append(path.stat().st_mode & 0o777)
        return write(path, content)

    monkeypatch.setattr(Path, "write_bytes", spied)
    old = os.umask(0)
    try:
        with_user(tmp_path / "new.toml", Person(name="x", role=Role.READER, ships=("all",), password=password_hash))
    finally:
        os.umask(old)
    assert seen == [0o600]
    assert (tmp_path / "new.toml").stat().st_mode & 0o777 == 0o600
    site.person("reader-ada")
    state = site.service.serving.state
    for name in ("server.db", "server.db-wal", "audit.jsonl", "secret"):
        assert (state / name).stat().st_mode & 0o777 == 0o600, name


def test_what_a_killed_server_left_is_taken_away(made):
    site = made()
    state, serving = site.service.serving.state, site.service.serving
    for name in ("half", "empty"):
        (state / "recordings" / name).mkdir()
    (state / "recordings" / "half" / "a.nc.part").write_bytes(b"x")
    (state / "scratch" / "desk" / "shaftprint-x").mkdir(parents=True)
    kept = {one.name for one in (state / "recordings").iterdir()} - {"half", "empty"}
    again = Service.begun(serving)
    again.kept.close()
    again.store.close()
    assert {one.name for one in (state / "recordings").iterdir()} == kept
    assert not (state / "scratch").exists()


class Visitor:
    """A connection at the door."""

    is_uploading = False

    def __init__(self, door, address):
        self.door, self.address = door, address
        self.transport, self.closed = self, False

    def close(self):
        self.closed = True
        self.door.leave(self, self.address)


def test_whoever_says_nothing_takes_nobody_s_place():
    door = Door(behind_proxy=False)
    silent = [Visitor(door, "192.0.2.7") for _ in range(230)]
    for one in silent:
        door.enter(one, one.address)
    # the newest hundred still may say something
    assert [one.closed for one in silent] == 130 * [True] + 100 * [False]
    others = [Visitor(door, "198.51.100.9") for _ in range(20)]
    assert all(door.enter(one, one.address) for one in others)
    assert not any(one.closed for one in others)
    assert sum(one.closed for one in silent) == 150


def test_an_address_has_so_many_connections_and_no_more():
    door = Door(behind_proxy=False)
    busy = [Visitor(door, "192.0.2.7") for _ in range(120)]
    for one in busy:
        assert door.enter(one, one.address)
        door.has_said(one)
    assert not door.enter(Visitor(door, "192.0.2.7"), "192.0.2.7")
    assert door.enter(Visitor(door, "198.51.100.9"), "198.51.100.9")
    behind = Door(behind_proxy=True)
    for one in [Visitor(behind, "127.0.0.1") for _ in range(150)]:
        assert behind.enter(one, one.address)
        behind.has_said(one)


@pytest.mark.parametrize("at", ["0001-01-01T00:00+14:00", "9999-12-31T23:59-14:00", "9999-12-31T23:59", "2099-01-01"])
def test_a_time_that_cannot_be_is_refused_in_every_form(site, at):
    tester = site.person("tester-ada")
    fields = {"what": "docking", "at": at, "zone": "Pacific/Kiritimati"}
    assert tester.post(f"/api/v1/ships/{ADA}/port/events", fields).status == 400
    job = {"source": f"upload:{site.uploads[ADA]}", "vessel": "stan-tug-1205", "campaign": "short", "tested_at": at}
    answer = tester.post("/api/v1/jobs", job)
    assert (answer.status, "expected a time from 1950-01-01" in answer.text) == (400, True)


def test_an_owner_withdraws_what_was_noted_and_the_page_shows_both(site):
    owner, path = site.person("owner-ada"), f"/ships/{ADA}/port"
    fields = {"what": "docking", "at": "2025-09-01T00:00+00:00", "why": "another ship"}
    assert site.person("tester-ada").post(f"{path}/events/withdrawn", fields).status == 403
    assert owner.post(f"{path}/events/withdrawn", fields).status == 303
    (event,) = owner.get(f"/api/v1{path}").json["events"]
    assert (event["note"], event["withdrawn"]) == ("dock of Ada", "another ship")
    assert "(withdrawn: another ship)" in owner.get(path).text
