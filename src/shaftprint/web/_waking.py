"""A bell: what runs beside the pages sleeps until somebody has something for it."""

import asyncio
import contextlib
from dataclasses import dataclass, field


@dataclass(slots=True)
class Waking:
    """A bell for something that sleeps."""

    _bell: asyncio.Event = field(default_factory=asyncio.Event)

    def wake(self) -> None:
        """Let it look at once whether there is something to do."""
        self._bell.set()

    async def sleep(self, longest_s: float) -> None:
        """Sleep until somebody wakes it, or for some time."""
        with contextlib.suppress(TimeoutError):
            await asyncio.wait_for(self._bell.wait(), longest_s)
        self._bell.clear()
