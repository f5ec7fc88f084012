"""The contract of a counterpart: the device that stands between the program and the governor."""

from dataclasses import dataclass
from typing import Protocol

from shaftprint.live._block import Block, LiveChannel
from shaftprint.live._play import Play

REVERT_S = 1.0
"""Time after its last heartbeat within which the counterpart has gone back to the lever [s]."""
SILENT_S = 1.0
"""Time within which a link that went silent is noticed [s]."""
ANSWER_S = 0.8
"""Time within which a counterpart answers a command, or the link is silent [s]."""
ABORT_RAMP_S = 2.0
"""Length of the cosine with which a counterpart goes back to the lever's value after an abort [s]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Abilities:
    """What a counterpart can do; one that can nothing of it is listened to."""

    plays_waveform: bool = False
    """Whether it plays a waveform from a table by its own clock."""
    writes_set_point: bool = False
    """Whether it follows a set point that is written now."""
    reverts: bool = False
    """Whether it says of itself that it goes back to the lever without heartbeat. It is believed when it was seen."""
    ramps: bool = False
    """Whether it makes the ramp of an abort itself."""

    @property
    def can_be_armed(self) -> bool:
        """Whether it can do what a live test needs."""
        return self.reverts and self.ramps and (self.plays_waveform or self.writes_set_point)


class Counterpart(Protocol):
    """A device on board, or a simulated one, behind a protocol.

    Whatever is awaited ends in time: a link that answers nothing ends in a SilentLinkError, never in waiting.
    What the device refuses is a LiveError with its reason.
    """

    @property
    def name(self) -> str:
        """What it is called in sentences, such as its address without secrets."""

    @property
    def abilities(self) -> Abilities:
        """What it can do."""

    @property
    def channels(self) -> tuple[LiveChannel, ...]:
        """Its channels, once it is connected."""

    async def connect(self) -> None:
        """Reach it and learn its channels."""

    async def read(self, timeout_s: float) -> Block:
        """Return the next block in the order in which they come; raise SilentLinkError if none comes in time."""

    async def beat(self, count: int) -> None:
        """Send the heartbeat."""

    async def take(self) -> None:
        """Take the set point over from the lever, at the lever's value, so that nothing moves."""

    async def write(self, volts: float) -> None:
        """Write a set point [V of the campaign]."""

    async def play(self, play: Play) -> None:
        """Play a waveform from its start on, in place of what is played then."""

    async def abort(self, ramp_s: float) -> None:
        """Go back to the lever's value on a cosine of this length [s], then give the set point back to the lever."""

    async def release(self) -> None:
        """Give the set point back to the lever now."""

    async def close(self) -> None:
        """Let go of the link; never raises for one that is gone."""

    def clock(self) -> float:
        """Return the present time by the clock by which blocks are received [s]."""
