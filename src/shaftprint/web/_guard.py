"""What stands before every endpoint: names by which the server may be called, and heads that every answer has."""

import logging
from collections.abc import Awaitable, Callable, MutableMapping
from typing import Any, Final, TypeAlias

from starlette.responses import Response

from shaftprint.web._asked import API
from shaftprint.web._setting import refusal

Scope: TypeAlias = MutableMapping[str, Any]
Message: TypeAlias = MutableMapping[str, Any]
Receive: TypeAlias = Callable[[], Awaitable[Message]]
Send: TypeAlias = Callable[[Message], Awaitable[None]]
Application: TypeAlias = Callable[[Scope, Receive, Send], Awaitable[None]]

POLICY: Final = "default-src 'self'; object-src 'none'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'"
"""Policy of every page: nothing of another host, no script or style within a page."""
_HEADS: Final = {
    b"content-security-policy": POLICY.encode(),
    b"x-content-type-options": b"nosniff",
    b"x-frame-options": b"DENY",
    # not no-referrer: browsers would then hide where a form of this server comes from
    b"referrer-policy": b"same-origin",
    b"cross-origin-opener-policy": b"same-origin",
    b"cross-origin-resource-policy": b"same-origin",
    b"permissions-policy": b"camera=(), microphone=(), geolocation=()",
    b"cache-control": b"no-store",
}
_LONGEST_PATH, _LONGEST_QUERY = 2000, 4000
_LOG = logging.getLogger("shaftprint.web")


class Guard:
    """An application behind the guard."""

    def __init__(self, application: Application, *, hosts: frozenset[str], is_secure: bool) -> None:
        self.application = application
        self.hosts = hosts
        self.is_secure = is_secure

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request, or refuse it before anything else looks at it."""
        if scope["type"] == "lifespan":
            await self.application(scope, receive, send)
            return
        if scope["type"] != "http":
            await send({"type": "websocket.close", "code": 1008})
            return
        begun = False

        async def guarded(message: Message) -> None:
            nonlocal begun
            if message["type"] == "http.response.start":
                begun = True
                message["headers"] = self._with_heads(message.get("headers", []))
            await send(message)

        refused = self._refused(scope)
        if refused is not None:
            await refused(scope, receive, guarded)
            return
        try:
            await self.application(scope, receive, guarded)
        except Exception:
            _LOG.exception("%s %s", scope["method"], scope["path"].encode("ascii", "replace").decode())
            if begun:
                raise
            sorry = "Something went wrong here; whoever keeps the server finds it in its log."
            await refusal(sorry, 500, api=_is_api(scope))(scope, receive, guarded)

    def _with_heads(self, there: list[tuple[bytes, bytes]]) -> list[tuple[bytes, bytes]]:
        names = {name.lower() for name, _ in there}
        heads = _HEADS | ({b"strict-transport-security": b"max-age=31536000"} if self.is_secure else {})
        return [*there, *((name, value) for name, value in heads.items() if name not in names)]

    def _refused(self, scope: Scope) -> Response | None:
        hosts = [value for name, value in scope["headers"] if name == b"host"]
        # a page of another host that calls itself by this address (DNS rebinding) has its own name here
        if len(hosts) != 1 or _without_port(hosts[0].decode("latin-1")) not in self.hosts:
            return refusal(
                "This server does not go by that name; state it with shaftprint serve --host NAME.",
                421,
                api=_is_api(scope),
            )
        if len(scope["path"]) > _LONGEST_PATH or len(scope["query_string"]) > _LONGEST_QUERY:
            return refusal("The address is too long.", 414, api=_is_api(scope))
        return None


def _without_port(host: str) -> str:
    name, mark, port = host.lower().rpartition(":")
    return name if mark and port.isascii() and port.isdigit() else host.lower()


def _is_api(scope: Scope) -> bool:
    return bool(scope["path"].startswith(f"{API}/"))
