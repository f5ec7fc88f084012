"""What counterparts share that are commanded by single words: each word has a number, and is answered by the device."""

import time
from abc import ABC, abstractmethod
from typing import Final

from shaftprint.errors import LiveError
from shaftprint.live._counterpart import Abilities
from shaftprint.live._play import Play

WORDS: Final = {"take": 1, "write": 2, "abort": 3, "release": 4}
"""Words by the numbers that stand for them on the wire."""


class CommandedByWords(ABC):
    """A device that follows a set point where its owner says how, and plays no waveform."""

    name: str
    """Its address."""
    kind: str
    """What it is behind, in words."""

    @property
    @abstractmethod
    def is_commanded(self) -> bool:
        """Whether its map says how it is commanded."""

    @property
    def abilities(self) -> Abilities:
        """What it can do: follow a set point, where it is commanded."""
        is_able = self.is_commanded
        return Abilities(writes_set_point=is_able, reverts=is_able, ramps=is_able)

    def clock(self) -> float:
        """Return the present time, which stamps blocks too [s]."""
        return time.monotonic()

    async def take(self) -> None:
        """Take the set point over at the lever's value."""
        await self._command("take")

    async def play(self, play: Play) -> None:
        """Refuse: no waveform goes through single words."""
        raise LiveError(f"{self.name}: expected a counterpart that plays {play.name}, found {self.kind}, which cannot.")

    async def abort(self, ramp_s: float) -> None:
        """Go back to the lever on a cosine."""
        await self._command("abort", ramp_s=ramp_s)

    async def release(self) -> None:
        """Give the set point back."""
        await self._command("release")

    @abstractmethod
    async def _command(self, word: str, *, ramp_s: float = 0.0) -> None:
        """Send a word, and wait until the device has answered it."""

    def _expect_obeyed(self, word: str, refused: float) -> None:
        """Refuse to go on where the device gives a reason."""
        if refused:
            raise LiveError(f'{self.name}: the counterpart refuses "{word}" for reason {refused:g} of its list.')
