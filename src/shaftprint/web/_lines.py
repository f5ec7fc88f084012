"""The lines of the store as pages show them, read anew when something was put in."""

import threading
from dataclasses import dataclass, field

from shaftprint.store._overview import LineNow, lines_now, store_state
from shaftprint.store._store import Store


@dataclass(slots=True)
class Lines:
    """All lines of a store: a list of a thousand ships takes a tenth of a second to read."""

    store: Store
    """The store."""
    _known: dict[str | None, tuple[str, tuple[LineNow, ...]]] = field(default_factory=dict)
    _lock: threading.Lock = field(default_factory=threading.Lock)

    def now(self, number: str | None = None) -> tuple[LineNow, ...]:
        """Return every line with its newest test.

        ``number``: name of a number that is wanted of that test, of few that are ever asked for; None for none.
        """
        # before the lines: what comes in between is seen the next time
        state = store_state(self.store)
        with self._lock:
            known = self._known.get(number)
            if known is None or known[0] != state:
                known = self._known[number] = (state, lines_now(self.store, number=number))
            return known[1]
