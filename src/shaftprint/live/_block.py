"""What comes from a counterpart: blocks of samples, each with what the device does meanwhile."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray


class DeviceMode(StrEnum):
    """Who rules the set point."""

    LEVER = "lever"
    """The lever on the bridge: nothing that the program says matters."""
    HELD = "held"
    """The counterpart, which stands at the value that it took over or was given."""
    PLAYING = "playing"
    """The counterpart, which plays a waveform."""
    RAMPING = "ramping"
    """The counterpart, which goes back to the lever's value after an abort."""


@dataclass(frozen=True, kw_only=True, slots=True)
class DeviceStatus:
    """What the counterpart does while it takes a block."""

    mode: DeviceMode
    """Who rules the set point."""
    heartbeat: int
    """The last heartbeat that it has seen."""
    set_point_v: float
    """What it puts out at the end of the block [V of the campaign]."""
    is_enabled: bool = True
    """Whether somebody on the bridge allows the program to take over."""


@dataclass(frozen=True, kw_only=True, slots=True)
class LiveChannel:
    """One channel of a counterpart; ``value = sample * scale + offset``."""

    name: str
    """Name, as in the vessel file."""
    unit: str
    """Unit of its values."""
    rate_hz: float
    """Samples a second [Hz]."""
    scale: float = 1.0
    """Value of one count [unit]; 1 where it sends values."""
    offset: float = 0.0
    """Value at count zero [unit]; 0 where it sends values."""
    dtype: Literal["int16", "float64"] = "float64"
    """Whether it sends counts of 16 bits or values."""
    long_name: str = ""
    """What it is, in words."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Block:
    """Samples of all channels over the same time, as the counterpart took them."""

    counter: int
    """Number of the block by the counterpart's count, one more each."""
    source_s: float
    """Time of its first samples by the counterpart's clock [s]."""
    span_s: float
    """Time that it covers [s]."""
    samples: Mapping[str, NDArray[Any]]
    """Samples of each channel as it sends them, shape (samples,); a slow channel has fewer, or none."""
    device: DeviceStatus
    """What the counterpart does."""
    received_s: float
    """When it was there, by this computer's clock [s]."""
    findings: tuple[str, ...] = ()
    """What the link itself says of it, such as that values before it were dropped."""

    @property
    def stop_s(self) -> float:
        """End of the time that it covers, by the counterpart's clock [s]."""
        return self.source_s + self.span_s

    def values(self, channel: LiveChannel) -> FloatArray:
        """Return the values of a channel in its unit, shape (samples,); none where the block has none of it."""
        samples = self.samples.get(channel.name)
        if samples is None:
            return np.empty(0)
        values: FloatArray = np.asarray(samples, dtype=np.float64) * channel.scale + channel.offset
        return values


@dataclass(frozen=True, kw_only=True, slots=True)
class Event:
    """Something that happened in a live test."""

    time_s: float
    """When, by the counterpart's clock [s]."""
    kind: str
    """One word, such as ``armed``, ``abort`` or ``lost``."""
    sentence: str
    """What, in words."""
    facts: Mapping[str, str | float] = field(default_factory=dict)
    """Channel, limit, value, persistence and the like, by name."""
