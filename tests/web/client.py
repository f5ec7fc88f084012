"""A browser without a network: it calls the application, keeps its cookie, and reads the token of a page."""

import asyncio
import json
import re
from dataclasses import dataclass, field
from urllib.parse import unquote, urlencode


@dataclass
class Answer:
    """What came back."""

    status: int
    heads: dict[str, str]
    body: bytes

    @property
    def text(self) -> str:
        return self.body.decode()

    @property
    def json(self):
        return json.loads(self.body)


@dataclass
class Browser:
    """Somebody who asks."""

    application: object
    host: str = "127.0.0.1:8080"
    address: str = "192.0.2.7"
    cookie: str = ""
    token: str = ""
    log: list[str] = field(default_factory=list)

    def ask(self, method, path, *, body=b"", heads=(), pieces=None, host=None, most_events=None):
        """Return the answer to a request; of a stream that does not end the first events."""
        return asyncio.run(self._ask(method, path, body, list(heads), pieces, host or self.host, most_events))

    async def _ask(self, method, path, body, heads, pieces, host, most_events):
        place, _, query = path.partition("?")
        coming = [body] if pieces is None else list(pieces)
        names = {name.lower() for name, _ in heads}
        heads = [(b"host", host.encode())] * ("host" not in names) + [
            (n.lower().encode(), v.encode()) for n, v in heads
        ]
        if self.cookie:
            heads.append((b"cookie", f"shaftprint={self.cookie}".encode()))
        scope = {
            "type": "http", "asgi": {"version": "3.0"}, "http_version": "1.1", "method": method, "scheme": "http",
            "path": unquote(place), "raw_path": place.encode(), "query_string": query.encode(), "root_path": "",
            "headers": heads, "client": (self.address, 1234), "server": ("127.0.0.1", 8080),
        }  # fmt: skip
        start, parts, gone = {}, [], asyncio.Event()

        async def receive():
            if coming:
                return {"type": "http.request", "body": coming.pop(0), "more_body": bool(coming)}
            await gone.wait()
            return {"type": "http.disconnect"}

        async def send(message):
            if message["type"] == "http.response.start":
                start.update(message)
            else:
                parts.append(message.get("body", b""))
                if most_events is not None and b"".join(parts).count(b"data: ") >= most_events:
                    gone.set()

        await asyncio.wait_for(self.application(scope, receive, send), 30)
        found = [(name.decode().lower(), value.decode()) for name, value in start["headers"]]
        for name, value in found:
            if name == "set-cookie":
                self.cookie = re.match(r"shaftprint=([^;]*)", value)[1]
        return Answer(status=start["status"], heads=dict(found), body=b"".join(parts))

    def get(self, path, **further):
        return self.ask("GET", path, **further)

    def known(self):
        """Return the token of this browser."""
        self.token = self.get("/api/v1/session").json["token"]
        return self.token

    def post(self, path, fields=(), *, token=None, **further):
        fields = dict(fields) | {"token": self.known() if token is None else token}
        heads = [("content-type", "application/x-www-form-urlencoded"), *further.pop("heads", ())]
        return self.ask("POST", path, body=urlencode(fields).encode(), heads=heads, **further)

    def put(self, path, content, *, token=None, **further):
        heads = [("x-csrf-token", self.known() if token is None else token), *further.pop("heads", ())]
        return self.ask("PUT", path, body=content, heads=heads, **further)

    def signed_in(self, name, password):
        """Sign in, and return this browser."""
        answer = self.post("/sign-in", {"name": name, "password": password})
        assert answer.status == 303, answer.text
        return self


def form_of(fields, name, content, boundary="frontier"):
    """Return content type and body of a form with a file."""
    body = b""
    for key, value in fields.items():
        body += f'--{boundary}\r\nContent-Disposition: form-data; name="{key}"\r\n\r\n{value}\r\n'.encode()
    body += (
        f'--{boundary}\r\nContent-Disposition: form-data; name="file"; filename="{name}"\r\n'
        "Content-Type: application/octet-stream\r\n\r\n"
    ).encode()
    return f"multipart/form-data; boundary={boundary}", body + content + f"\r\n--{boundary}--\r\n".encode()
