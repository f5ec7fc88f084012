"""The door: how long somebody may take to say what he wants, and how many may be saying it at one time.

Whoever holds a connection and says nothing, or a letter now and then, takes nobody's place: he has seconds, and where
many do so the one that has waited longest goes, of the address that has most of them.
"""

from asyncio import TimerHandle, Transport
from collections import Counter
from typing import Any, Final, TypeAlias

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol

from shaftprint.web.access._throttle import network_of

WHOLE_S: Final = 15.0
"""How long a request may take until all of it is there, but for an upload of somebody who may [s]."""
MOST_WAITING: Final = 100
"""Connections at one time that have not said what they want."""
MOST_FROM_ONE: Final = 120
"""Connections of one address at one time."""
STREAMS: Final = "shaftprint.streams"
"""In the scope of a request whose body is an upload: its endpoint looks after the time."""
_SAYING: Final = frozenset({h11.IDLE, h11.SEND_BODY})


class Door:
    """Who is at the door."""

    def __init__(self, *, behind_proxy: bool) -> None:
        # behind a proxy all come from its address
        self._most_from_one = MOST_WAITING if behind_proxy else MOST_FROM_ONE
        self._behind_proxy = behind_proxy
        self._open: Counter[str] = Counter()
        # in the order in which they began to wait
        self._waiting: dict[Any, str] = {}

    def enter(self, visitor: Any, address: str) -> bool:
        """Note a connection; return whether it may stay."""
        self._open[address] += 1
        self.wait(visitor, address)
        if self._behind_proxy or self._open[address] <= self._most_from_one:
            return True
        return self._turn_out(address, but=visitor)

    def wait(self, visitor: Any, address: str) -> None:
        """Note that somebody has not said what he wants."""
        self._waiting.pop(visitor, None)
        self._waiting[visitor] = address
        if len(self._waiting) > MOST_WAITING:
            self._turn_out(Counter(self._waiting.values()).most_common(1)[0][0], but=visitor)

    def has_said(self, visitor: Any) -> None:
        """Note that somebody has said all."""
        self._waiting.pop(visitor, None)

    def leave(self, visitor: Any, address: str) -> None:
        """Note that a connection is gone."""
        self._waiting.pop(visitor, None)
        self._open[address] -= 1
        if self._open[address] <= 0:
            del self._open[address]

    def _turn_out(self, address: str, *, but: Any) -> bool:
        for visitor in [one for one, of in self._waiting.items() if of == address and one is not but]:
            del self._waiting[visitor]
            if not visitor.is_uploading:
                visitor.transport.close()
                return True
        return False


Protocol: TypeAlias = type[H11Protocol]


def patient_protocol(door: Door) -> Protocol:
    """Return the protocol of connections that come in through a door."""

    class PatientProtocol(H11Protocol):
        """HTTP as uvicorn speaks it, with an end to the patience."""

        late: TimerHandle | None = None
        address = ""

        @property
        def is_uploading(self) -> bool:
            """Whether somebody who may sends a file."""
            return self.scope is not None and STREAMS in self.scope

        def connection_made(self, transport: Transport) -> None:  # type: ignore[override]
            super().connection_made(transport)
            self.address = network_of(self.client[0] if self.client else "")
            self._be_patient()
            if not door.enter(self, self.address):
                transport.close()

        def connection_lost(self, exc: Exception | None) -> None:
            self._stop_waiting()
            door.leave(self, self.address)
            super().connection_lost(exc)

        def handle_events(self) -> None:
            super().handle_events()
            if self.conn.their_state not in _SAYING:
                self._stop_waiting()
                door.has_said(self)

        def on_response_complete(self) -> None:
            self._be_patient()
            door.wait(self, self.address)
            super().on_response_complete()

        def _be_patient(self) -> None:
            self._stop_waiting()
            self.late = self.loop.call_later(WHOLE_S, self._lose_patience)

        def _stop_waiting(self) -> None:
            if self.late is not None:
                self.late.cancel()
                self.late = None

        def _lose_patience(self) -> None:
            if not self.is_uploading:
                self.transport.close()

    return PatientProtocol
