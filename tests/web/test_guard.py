"""What stands before every page: names of the server, tokens of forms, cookies, limits, heads."""

import re

import pytest
from tests.web.client import form_of
from tests.web.conftest import ADA, PASSWORD

from shaftprint.errors import ServerError
from shaftprint.web import Listen, Role, Serving, listen_at, routes_of
from shaftprint.web.access import network_of


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
