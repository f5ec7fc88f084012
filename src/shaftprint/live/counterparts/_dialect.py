"""What is said over MQTT: messages that come in, and commands that go out, in one dialect or another."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final, Protocol, TypeAlias

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.live._block import Block, DeviceMode, LiveChannel
from shaftprint.live._counterpart import Abilities

MODES = (DeviceMode.LEVER, DeviceMode.HELD, DeviceMode.PLAYING, DeviceMode.RAMPING)
"""Modes by the numbers that stand for them on the wire."""
DTYPES: Final[Mapping[str, np.dtype[Any]]] = {"int16": np.dtype("<i2"), "float64": np.dtype("<f8")}
"""How samples stand on the wire, by the type that their channel says."""
MOST_CHANNELS = 64
"""Channels of one counterpart."""
MOST_SAMPLES = 1_000_000
"""Samples of all channels in one block."""


def latest_like(sent: int, seen: int, bits: int) -> int:
    """Return the last number up to one that was sent of which a device gives so many bits back."""
    return sent - (sent - seen) % (1 << bits)


@dataclass(frozen=True, kw_only=True, slots=True)
class Description:
    """What a counterpart says of itself."""

    channels: tuple[LiveChannel, ...]
    """Its channels."""
    abilities: Abilities
    """What it can do."""

    def __post_init__(self) -> None:
        """Refuse what no counterpart has; raises ValueError."""
        names = {channel.name for channel in self.channels}
        if not 0 < len(self.channels) <= MOST_CHANNELS or len(names) < len(self.channels) or "" in names:
            raise ValueError(f"expected 1 to {MOST_CHANNELS} channels of different names, found {len(self.channels)}")
        if not all(0.0 < channel.rate_hz <= MOST_SAMPLES for channel in self.channels):
            raise ValueError("expected channels with a rate above 0 Hz")


@dataclass(frozen=True, kw_only=True, slots=True)
class Answer:
    """What a counterpart says to a command."""

    number: int
    """Number of the command."""
    refused: str
    """Why it is refused; empty where it is obeyed."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Gone:
    """The counterpart says, or the broker for it, that it is gone."""

    sentence: str
    """What happened, in words."""


Said: TypeAlias = Description | Block | Answer | Gone | None
Content: TypeAlias = Mapping[str, float | FloatArray]


class Dialect(Protocol):
    """One way to put blocks and commands into messages."""

    @property
    def topics(self) -> tuple[str, ...]:
        """Topics of what comes in."""

    @property
    def will(self) -> tuple[str, bytes] | None:
        """Topic and message by which the broker tells that this program is gone; none where the dialect has none."""

    def heard(self, topic: str, payload: bytes, received_s: float) -> Said:
        """Return what a message says; raise ValueError, in a sentence, if it is none of the dialect."""

    def command(self, word: str, number: int, content: Content) -> tuple[str, bytes]:
        """Return topic and message of a command."""

    def heartbeat(self, count: int) -> tuple[str, bytes]:
        """Return topic and message of a heartbeat."""

    def again(self) -> tuple[str, bytes] | None:
        """Return what asks the counterpart to describe itself anew; None where it has left that with the broker."""
