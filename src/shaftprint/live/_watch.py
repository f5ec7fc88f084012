"""Abort rules on every block, each with channel, limit and persistence."""

from dataclasses import dataclass
from enum import StrEnum
from typing import Protocol

from shaftprint.live._block import Block


class AbortRule(StrEnum):
    """Why a test is aborted."""

    LIMIT = "limit"
    DATA = "data"
    HEARTBEAT = "heartbeat"
    SET_POINT = "set point not followed"
    OSCILLATION = "growing oscillation"
    DEVICE = "device"
    OPERATOR = "operator"


@dataclass(frozen=True, kw_only=True, slots=True)
class Breach:
    """A rule that was broken."""

    rule: AbortRule
    """Which."""
    channel: str
    """Channel or quantity that shows it."""
    value: float
    """What it was [unit]."""
    limit: float
    """What it had to stay within [unit]."""
    unit: str
    """Unit of both."""
    persistence_s: float
    """How long it was allowed to last [s]."""
    time_s: float
    """When it had lasted too long, by the counterpart's clock [s]."""

    @property
    def sentence(self) -> str:
        """What happened, in words."""
        return (
            f"{self.rule}: {self.channel} expected within {self.limit:.6g} {self.unit}, found {self.value:.6g} for "
            f"more than {self.persistence_s:g} s at {self.time_s:.2f} s"
        )


class Watch(Protocol):
    """One rule that looks at every block, in their order."""

    def look(self, block: Block) -> Breach | None:
        """Return what is broken with this block; None while all is well."""
