"""Two pages of a running test, for this computer alone: one large word for the bridge, all else for the engineer.

Server-sent events carry what is shown. Taken in is what an operator may ask for, of the page that was opened with the
address that the program has printed: it holds a word that no other page and no other user of this computer has. Who
wants to stop does it at the program, or at the lever.
"""

import hmac
import json
import math
import secrets
import threading
from collections.abc import Callable
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib.resources import files
from types import TracebackType
from typing import Any, Self
from urllib.parse import unquote

from shaftprint.errors import ServerError
from shaftprint.files import reason
from shaftprint.live._block import Event
from shaftprint.live._loop import Loop
from shaftprint.live._outcome import Ask, Operator
from shaftprint.live._sight import Sight
from shaftprint.live._state import State

HERE = "127.0.0.1"
_EVERY_S = 0.25
_MOST_EVENTS = 50
_WORD = "X-Word"
_HOSTS = ("127.0.0.1", "localhost")
_PAGES = {"/": "bridge.html", "/engineer": "engineer.html"}
_HEADERS = {
    "Cache-Control": "no-store",
    "Content-Security-Policy": "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
    "connect-src 'self'; frame-ancestors 'none'",
    "X-Content-Type-Options": "nosniff",
}
# What the bridge reads: the state in a word that is understood across a room.
_WORDS = {
    State.IDLE: "LEVER",
    State.ARMED: "ARMED",
    State.RAMP_IN: "RAMP",
    State.SETTLE: "TEST",
    State.LEG: "TEST",
    State.RAMP_OUT: "RAMP",
    State.HOLD: "HOLD",
    State.ABORT: "ABORT",
}
_ALARM = "TAKE LOCAL CONTROL"


class LivePages:
    """The pages; they are there while the ``with`` block runs, and ask nobody else for anything."""

    def __init__(self, port: int, operator: Operator | None = None) -> None:
        """Take a port of this computer, 0 for any; ``operator``: who asks on the page. Raises ServerError if taken."""
        self._operator, self._word = operator, secrets.token_urlsafe(16)
        self._shown: dict[str, Any] = {"word": _WORDS[State.IDLE], "events": []}
        self._lock = threading.Lock()
        self._ends = threading.Event()
        try:
            self._server = ThreadingHTTPServer((HERE, port), _handler_of(self))
        except OSError as error:
            raise ServerError(
                f"port {port}: expected a free one for the pages, found another: {reason(error)}."
            ) from None
        self._server.daemon_threads = True
        self._thread = threading.Thread(target=self._server.serve_forever, daemon=True)

    @property
    def url(self) -> str:
        """Address of the page for the bridge."""
        return f"http://{HERE}:{self._server.server_port}/"

    @property
    def url_of_engineer(self) -> str:
        """Address of the page for the engineer, with the word that lets it ask."""
        return f"{self.url}engineer" + ("" if self._operator is None else f"#{self._word}")

    def take(self, ask: str, word: str) -> bool:
        """Ask for something, where the word is the right one; return whether it was taken."""
        if self._operator is None or not hmac.compare_digest(word.encode(), self._word.encode()):
            return False
        if ask not in set(Ask):
            return False
        self._operator.asks.append(Ask(ask))
        return True

    @property
    def has_ended(self) -> bool:
        """Whether the pages are taken away."""
        return self._ends.wait(_EVERY_S)

    def __enter__(self) -> Self:
        """Begin to answer."""
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """End."""
        self._ends.set()
        self._server.shutdown()
        self._server.server_close()
        self._thread.join()

    def show(self, test: Loop, sight: Sight) -> None:
        """Take what a block shows."""
        numbers = {
            "set point [V]": sight.set_point_v,
            "speed [rpm]": sight.speed_rpm,
            "torque [N m]": sight.torque_nm,
            "time left [s]": getattr(test, "left_s", math.nan),
        }
        with self._lock:
            self._shown |= {
                "word": _ALARM if self._shown["word"] == _ALARM and test.state is State.ABORT else _WORDS[test.state],
                "state": str(test.state),
                "lever": str(sight.block.device.mode),
                "numbers": {name: f"{value:.5g}" for name, value in numbers.items() if math.isfinite(value)},
            }

    def tell(self, event: Event) -> None:
        """Take what happened."""
        with self._lock:
            events = [*self._shown["events"], f"{event.time_s:.1f} s  {event.kind}: {event.sentence}"]
            self._shown["events"] = events[-_MOST_EVENTS:]
            if event.kind == "known":
                self._shown["known"] = event.sentence
            if event.kind in ("abort", "alarm"):
                self._shown["reason"] = event.sentence
            if event.kind == "alarm":
                self._shown["word"] = _ALARM

    def message(self) -> bytes:
        """Return what is shown now as a server-sent event."""
        with self._lock:
            return f"data: {json.dumps(self._shown)}\n\n".encode()


def watched(told: Callable[[Event], None], pages: LivePages | None) -> dict[str, Any]:
    """Return what a test is to tell and to show, on pages too where there are any."""
    if pages is None:
        return {"told": told}

    def tell(event: Event) -> None:
        told(event)
        pages.tell(event)

    return {"told": tell, "shown": pages.show}


def _handler_of(pages: LivePages) -> type[BaseHTTPRequestHandler]:
    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            """Answer with a page, or with events as long as somebody listens."""
            host = self.headers.get("Host", "").rpartition(":")[0]
            if host not in _HOSTS:
                self.send_error(HTTPStatus.FORBIDDEN)
            elif self.path == "/events":
                self._stream()
            elif self.path in _PAGES:
                page = files("shaftprint.live").joinpath("pages", _PAGES[self.path]).read_bytes()
                self._head("text/html; charset=utf-8", len(page))
                self.wfile.write(page)
            else:
                self.send_error(HTTPStatus.NOT_FOUND)

        def do_POST(self) -> None:
            """Take what is asked for on the page; no other page can send its header."""
            host, asked = self.headers.get("Host", "").rpartition(":")[0], self.path.removeprefix("/ask/")
            is_right = host in _HOSTS and pages.take(unquote(asked), self.headers.get(_WORD, ""))
            self.send_response(HTTPStatus.NO_CONTENT if is_right else HTTPStatus.FORBIDDEN)
            self.end_headers()

        def _head(self, kind: str, length: int | None = None) -> None:
            self.send_response(HTTPStatus.OK)
            self.send_header("Content-Type", kind)
            if length is not None:
                self.send_header("Content-Length", str(length))
            for name, value in _HEADERS.items():
                self.send_header(name, value)
            self.end_headers()

        def _stream(self) -> None:
            self._head("text/event-stream")
            try:
                while True:
                    self.wfile.write(pages.message())
                    self.wfile.flush()
                    if pages.has_ended:
                        return
            except OSError:
                # nobody listens any more
                return

        def log_message(self, format: str, *arguments: Any) -> None:
            """Keep the terminal for what happens on board."""

    return Handler
