"""Which message of a CAN bus holds what, and whether the owner lets the program send: a file beside a DBC file."""

from typing import Literal, Self

from pydantic import Field, model_validator

from shaftprint.settings import Name, PositiveNumber, Settings, names_twice


class CanChannel(Settings):
    """A channel that comes in messages."""

    name: Name
    """Name, as in the vessel file."""
    message: Name
    """Message of the DBC file."""
    signal: Name
    """Signal of the message."""
    cycle_s: PositiveNumber
    """Time from one message to the next [s]."""
    sender: int | None = Field(default=None, strict=True, ge=0, le=255)
    """Source address of SAE J1939; of anybody where not given."""


class CanStatus(Settings):
    """The message by which the device says what it does: signals of it."""

    message: Name
    """Message of the DBC file."""
    mode: Name
    """0 lever, 1 held, 2 playing, 3 ramping."""
    heartbeat: Name
    """The last heartbeat that it has seen."""
    set_point: Name
    """What it puts out [V of the campaign]."""
    enabled: Name
    """1 where the key on the bridge is turned."""
    answer: Name
    """Number of the last command."""
    refused: Name
    """0, or why that is refused by the device's own list."""


class CanSending(Settings):
    """The message by which the program commands: signals of it. What is sent to an engine may move it."""

    is_allowed: Literal[True]
    """That the owner lets the program send on this bus: true, or the table is left out."""
    message: Name
    """Message of the DBC file; it goes out with every heartbeat and every command."""
    heartbeat: Name
    """The heartbeat, which goes round."""
    number: Name
    """Number of the command."""
    word: Name
    """0 none, 1 take, 2 write, 3 abort, 4 release."""
    set_point: Name
    """Set point [V of the campaign]."""
    ramp: Name
    """Length of the ramp of an abort [s]."""


class CanMap(Settings):
    """What is listened to on a bus."""

    database: Name
    """DBC or ARXML file, beside this one."""
    bitrate: int | None = Field(default=None, strict=True, gt=0, le=1_000_000)
    """Bits a second, for adapters that do not know it from the system."""
    block_s: PositiveNumber = Field(default=0.05, ge=0.02, le=1.0)
    """Time that a block covers [s]."""
    channel: tuple[CanChannel, ...] = Field(min_length=1, max_length=64)
    """Channels."""
    status: CanStatus | None = None
    """What the device says of itself."""
    sending: CanSending | None = None
    """How the program commands it; without it nothing is ever sent."""

    @model_validator(mode="after")
    def _sends_to_somebody_who_answers(self) -> Self:
        names = [channel.name for channel in self.channel]
        twice = names_twice(names)
        if twice:
            raise ValueError(f"expected each channel once, found {', '.join(twice)} twice.")
        if self.sending is not None and self.status is None:
            raise ValueError("expected [status] beside [sending]: a command that nobody answers is none, found none.")
        return self
