"""Abort rules on every block, each with channel, limit and persistence."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Protocol

import numpy as np

from shaftprint.live._block import DeviceMode
from shaftprint.live._envelope import SET_POINT, SPEED, TORQUE, Bound, Envelope
from shaftprint.live._sight import Sight

MISSING_S = 0.5
"""How long data or heartbeat may be missing [s]."""
_CLOCK_S = 0.1


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
    why: str = ""
    """What else is to be said, in words."""

    @property
    def sentence(self) -> str:
        """What happened, in words."""
        unit = f" {self.unit}" if self.unit else ""
        lasting = f" for more than {self.persistence_s:g} s" if self.persistence_s else ""
        more = f"; {self.why.removesuffix('.')}" if self.why else ""
        if math.isnan(self.limit):
            return f"{self.rule} at {self.time_s:.2f} s: {self.channel}{more}."
        return (
            f"{self.rule} at {self.time_s:.2f} s: {self.channel} expected within {self.limit:.6g}{unit}, found "
            f"{self.value:.6g}{unit}{lasting}{more}."
        )


@dataclass(frozen=True, kw_only=True, slots=True)
class Expected:
    """What the program expects to see with a block."""

    set_point_v: float
    """Mean of what it has put out [V of the campaign]."""
    is_ruling: bool
    """Whether the program rules the set point."""
    since_s: float
    """When it took it over, by the counterpart's clock [s]."""
    unanswered_s: float
    """For how long the oldest heartbeat has not been answered [s]; 0 where all are."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Rest:
    """What the line showed at rest in the arming test: the noise that rules must bear."""

    set_point_offset_v: float = 0.0
    """What the logged set point shows beyond what was put out [V]."""
    set_point_std_v: float = 0.0
    """Scatter of its means over a block [V]."""
    speed_rpm: float = math.nan
    """Engine speed [rpm]."""
    speed_std_rpm: float = 0.0
    """Scatter of the speed [rpm]."""
    volts: float = 0.0
    """Set point at which this was [V]."""


class Watch(Protocol):
    """One rule that looks at every block, in their order."""

    def look(self, sight: Sight, expected: Expected) -> Breach | None:
        """Return what is broken with this block; None while all is well."""


class Lasting:
    """How long something has been wrong."""

    def __init__(self, persistence_s: float) -> None:
        self.persistence_s = persistence_s
        self._since_s: float | None = None

    def too_long(self, is_wrong: bool, sight: Sight) -> bool:
        """Return whether it has been wrong for longer than it may."""
        if not is_wrong:
            self._since_s = None
            return False
        if self._since_s is None:
            self._since_s = sight.block.source_s
        return sight.time_s - self._since_s > self.persistence_s


class LimitWatch:
    """A quantity stays within its bound."""

    def __init__(self, bound: Bound) -> None:
        self._bound, self._lasting = bound, Lasting(bound.persistence_s)

    def look(self, sight: Sight, expected: Expected) -> Breach | None:
        """Return what is broken with this block."""
        value = {SPEED: sight.speed_rpm, TORQUE: sight.torque_nm, SET_POINT: sight.set_point_v}.get(
            self._bound.quantity, sight.means.get(self._bound.quantity, math.nan)
        )
        # what is not a number is a matter of the data, which has a rule of its own
        is_wrong = not math.isnan(value) and not self._bound.holds(value)
        if not self._lasting.too_long(is_wrong, sight):
            return None
        return Breach(
            rule=AbortRule.LIMIT,
            channel=self._bound.quantity,
            value=value,
            limit=self._bound.nearest(value),
            unit=self._bound.unit,
            persistence_s=self._bound.persistence_s,
            time_s=sight.time_s,
        )


class BarredWatch:
    """The speed does not stay in a barred range."""

    def __init__(self, envelope: Envelope) -> None:
        self._ranges = [(one, Lasting(envelope.barred_passage_s)) for one in envelope.barred_rpm]

    def look(self, sight: Sight, expected: Expected) -> Breach | None:
        """Return what is broken with this block."""
        for (low, high), lasting in self._ranges:
            if lasting.too_long(low < sight.speed_rpm < high, sight):
                return Breach(
                    rule=AbortRule.LIMIT,
                    channel=SPEED,
                    value=sight.speed_rpm,
                    limit=low if sight.speed_rpm - low < high - sight.speed_rpm else high,
                    unit="rpm",
                    persistence_s=lasting.persistence_s,
                    time_s=sight.time_s,
                    why=f"{low:g} to {high:g} rpm is barred",
                )
        return None


class DataWatch:
    """Samples are numbers and go on; blocks follow each other."""

    def __init__(self, needed: Sequence[str]) -> None:
        self._needed = tuple(needed)
        self._missing = {name: Lasting(MISSING_S) for name in needed}
        self._stale = Lasting(MISSING_S)
        self._before: Sight | None = None

    def look(self, sight: Sight, expected: Expected) -> Breach | None:
        """Return what is broken with this block."""
        before, self._before = self._before, sight
        for name in self._needed:
            is_missing = not math.isfinite(sight.means.get(name, math.nan))
            if self._missing[name].too_long(is_missing, sight):
                return self._breach(name, "no numbers", sight)
        if before is None:
            return None
        if self._stale.too_long(self._is_same(before, sight), sight):
            return self._breach(self._needed[0], "all channels repeat their last block to the last bit", sight)
        gap_s = sight.block.source_s - before.block.stop_s
        lost = sight.block.counter - before.block.counter - 1
        if lost * sight.block.span_s > MISSING_S:
            return self._breach("blocks", f"{lost} blocks were lost one after the other", sight, lost)
        jump_s = gap_s - lost * sight.block.span_s
        return self._jumped(jump_s, sight) if abs(jump_s) > _CLOCK_S else None

    def _jumped(self, jump_s: float, sight: Sight) -> Breach:
        return Breach(
            rule=AbortRule.DATA,
            channel="clock",
            value=jump_s,
            limit=_CLOCK_S,
            unit="s",
            persistence_s=0.0,
            time_s=sight.time_s,
            why="the clock of the counterpart has jumped",
        )

    def _is_same(self, before: Sight, sight: Sight) -> bool:
        old, new = before.block.samples, sight.block.samples
        return all(name in old and name in new and np.array_equal(old[name], new[name]) for name in self._needed)

    def _breach(self, channel: str, why: str, sight: Sight, value: float = math.nan) -> Breach:
        return Breach(
            rule=AbortRule.DATA,
            channel=channel,
            value=value if math.isfinite(value) else sight.means.get(channel, math.nan),
            limit=MISSING_S,
            unit="",
            persistence_s=MISSING_S,
            time_s=sight.time_s,
            why=why,
        )


class HeartbeatWatch:
    """The counterpart gives the heartbeat back."""

    def look(self, sight: Sight, expected: Expected) -> Breach | None:
        """Return what is broken with this block."""
        if not expected.is_ruling or expected.unanswered_s <= MISSING_S:
            return None
        return Breach(
            rule=AbortRule.HEARTBEAT,
            channel="heartbeat",
            value=expected.unanswered_s,
            limit=MISSING_S,
            unit="s",
            persistence_s=MISSING_S,
            time_s=sight.time_s,
            why="the counterpart does not give it back",
        )


class DeviceWatch:
    """The counterpart keeps the set point, and not for longer than it may."""

    def __init__(self, longest_s: float) -> None:
        self._longest_s = longest_s

    def look(self, sight: Sight, expected: Expected) -> Breach | None:
        """Return what is broken with this block."""
        if not expected.is_ruling:
            return None
        device, ruled_s = sight.block.device, sight.time_s - expected.since_s
        if device.mode in (DeviceMode.LEVER, DeviceMode.RAMPING) or not device.is_enabled:
            why = "the counterpart has given the set point back to the lever"
            return self._breach("set point", ruled_s, why if device.is_enabled else "the bridge took it back", sight)
        if ruled_s > self._longest_s:
            return self._breach("time", ruled_s, "the program may not rule for longer", sight)
        return None

    def _breach(self, channel: str, value: float, why: str, sight: Sight) -> Breach:
        return Breach(
            rule=AbortRule.DEVICE,
            channel=channel,
            value=value,
            limit=self._longest_s,
            unit="s",
            persistence_s=0.0,
            time_s=sight.time_s,
            why=why,
        )
