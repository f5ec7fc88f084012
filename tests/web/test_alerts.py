"""Alerts: told once, to whom the file says and to nobody else, with no secret where others read."""

import asyncio
import json
import logging
import threading
from http.server import BaseHTTPRequestHandler, HTTPServer

import pytest
from tests.web.conftest import ADA
from tests.web.test_pages import STEP

from shaftprint.errors import ServerError
from shaftprint.escape import chat_text
from shaftprint.web import _telling
from shaftprint.web._alerts import Alerts, read_alerts
from shaftprint.web._asked import line_key
from shaftprint.web._telling import tell

MAIL = """to = "yard@example.org"
from = "ship@example.org"
host = "mail.example.org"
user = "u"
password = "hunter 22"
"""


class Hook:
    """A hook on this computer: keeps what is posted, and answers with a status."""

    def __init__(self):
        self.status, self.posted, self.said = 200, [], None
        hook = self

        class Handler(BaseHTTPRequestHandler):
            def do_POST(self):
                body = self.rfile.read(int(self.headers["content-length"]))
                hook.said = self.headers["authorization"]
                hook.posted.append((self.path, json.loads(body)))
                self.send_response(hook.status)
                self.send_header("location", "/elsewhere")
                self.end_headers()

            do_GET = do_POST

            def log_message(self, *_):
                """Say nothing."""

        self.server = HTTPServer(("127.0.0.1", 0), Handler)
        self.url = f"http://127.0.0.1:{self.server.server_port}/secret-token?x=1"
        threading.Thread(target=self.server.serve_forever, daemon=True).start()


@pytest.fixture
def hook():
    made = Hook()
    yield made
    made.server.shutdown()
    made.server.server_close()


def stands(site, causes):
    """Let Ada have been judged so."""
    line = next(one for one in site.service.lines.now() if one.line.ship.imo_number == ADA)
    summary = {"causes": causes, "because": "", "since": "2025-03-01", "word": "x"}
    site.service.kept.put_finding(line_key(line.line.ship, "port"), line.state, summary, summary)


def told(site, alerts):
    return asyncio.run(tell(site.service, alerts))


def test_a_change_is_told_once_and_again_when_it_is_another(site, hook):
    alerts = Alerts(mail=None, hook=hook.url, pages="https://yard.example")
    stands(site, [])
    assert not told(site, alerts)
    stands(site, [STEP])
    assert told(site, alerts)
    assert not told(site, alerts)
    ((path, content),) = hook.posted
    assert path == "/secret-token?x=1"
    assert content["changed"] == 1
    assert content["lines"][0]["page"] == f"https://yard.example/ships/{ADA}/port"
    assert "Ada (IMO 9074729), port: changed: propeller; 4.20 ± 0.80 %, seen on 2026-03-01" in content["text"]
    stands(site, [STEP, STEP | {"name": "proportional gain of the governor"}])
    assert told(site, alerts)
    # what is over may come again
    stands(site, [])
    assert not told(site, alerts)
    stands(site, [STEP])
    assert told(site, alerts)
    assert len(hook.posted) == 3


def test_user_and_password_of_a_hook_go_along(hook):
    _telling.post(hook.url.replace("http://", "http://yard:p%40ss@"), "", [])
    # base64 of yard:p@ss
    assert hook.said == "Basic eWFyZDpwQHNz"
    assert hook.posted[0][0] == "/secret-token?x=1"


def test_a_name_of_a_ship_calls_nobody_in_a_chat():
    hostile = "<!channel> @here [see](https://x.example) `a` *b*\n&lt;"
    assert chat_text(hostile) == "‹!channel› ＠here (see)(https: //x.example) 'a' ·b·?+lt;"


def test_an_end_of_the_server_waits_for_no_alert():
    free = threading.Event()

    async def ended():
        sending = asyncio.create_task(_telling._sent(free.wait))
        await asyncio.sleep(0)
        sending.cancel()
        with pytest.raises(asyncio.CancelledError):
            await sending

    asyncio.run(ended())
    (thread,) = (one for one in threading.enumerate() if one.name == "alert")
    assert thread.daemon
    free.set()
    thread.join()


def test_nobody_goes_where_a_hook_sends_him_and_no_log_says_where_it_is(site, hook, caplog):
    alerts = Alerts(mail=None, hook=hook.url, pages="")
    stands(site, [STEP])
    hook.status = 302
    with caplog.at_level(logging.WARNING):
        assert told(site, alerts)
    assert [path for path, _ in hook.posted] == ["/secret-token?x=1"]
    assert "the webhook could not be sent" in caplog.text
    hook.status = 200
    # it was not taken, so that it is sent again
    assert told(site, alerts)
    assert len(hook.posted) == 2
    kept = [path.read_bytes() for path in site.service.serving.state.rglob("*") if path.is_file()]
    assert not any(b"secret-token" in content for content in kept)
    assert "secret-token" not in caplog.text


class Server:
    """Stands for a mail server; keeps what was asked of it."""

    asked: list = []  # noqa: RUF012

    def __init__(self, host, port, *, timeout):
        self.asked.append(("open", host, port, timeout))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        """Close nothing."""

    def starttls(self, *, context):
        self.asked.append(("starttls", context.check_hostname))

    def login(self, user, password):
        self.asked.append(("login", user, password))

    def send_message(self, message):
        self.asked.append(("send", message))


def test_a_mail_goes_out_by_tls_before_a_password_does(site, tmp_path, monkeypatch):
    monkeypatch.setattr(_telling.smtplib, "SMTP", Server)
    Server.asked = []
    path = tmp_path / "alerts.toml"
    path.write_text(f"[mail]\n{MAIL}")
    path.chmod(0o600)
    stands(site, [STEP])
    assert told(site, read_alerts(path))
    assert [one[0] for one in Server.asked] == ["open", "starttls", "login", "send"]
    assert Server.asked[0] == ("open", "mail.example.org", 587, _telling.TIMEOUT_S)
    assert Server.asked[1] == ("starttls", True)
    message = Server.asked[-1][1]
    assert (message["To"], message["Subject"]) == ("yard@example.org", "shaftprint: 1 shaft line changed")
    assert "changed: propeller" in message.get_content()


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", r"expected the tables \[mail\] or \[webhook\]"),
        ('[webhook]\nurl = "ftp://x/"', "begins with https"),
        ('[webhook]\nurl = "https://[::1/x"', "begins with https"),
        ('[webhook]\nurl = "https://x:99999/"', "begins with https"),
        ('[webhook]\nurl = "http://yard:hunter@x/"', "expected https:// where a user or password"),
        ('[webhook]\nurl = "https://x/"\nother = 1', "expected a table of url"),
        (f'[mail]\n{MAIL}tls = "none"', "where there is a password"),
        (f"[mail]\n{MAIL}".replace("yard@", "a\\nBcc: b@"), "a text in one line"),
        ("[mail", "expected a file of alerts in TOML"),
    ],
)
def test_a_file_of_alerts_that_cannot_be_used_is_refused(tmp_path, text, words):
    path = tmp_path / "alerts.toml"
    path.write_text(text)
    path.chmod(0o600)
    with pytest.raises(ServerError, match=words) as refused:
        read_alerts(path)
    assert "hunter" not in str(refused.value)


def test_a_file_of_alerts_that_others_can_read_is_refused(tmp_path):
    path = tmp_path / "alerts.toml"
    path.write_text('[webhook]\nurl = "https://hook.example.org/x"')
    path.chmod(0o644)
    with pytest.raises(ServerError, match="chmod 600"):
        read_alerts(path)
    path.chmod(0o600)
    alerts = read_alerts(path)
    assert alerts == Alerts(mail=None, hook="https://hook.example.org/x", pages="")
    assert "hook.example" not in repr(alerts)
    path.write_text(f"[mail]\n{MAIL}")
    assert "hunter" not in repr(read_alerts(path).mail)


def test_without_a_file_of_alerts_nothing_goes_out(site):
    assert site.service.alerts is None
    asyncio.run(_telling.keep_alerting(site.service))
