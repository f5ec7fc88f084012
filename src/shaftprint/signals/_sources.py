"""The channels that the vessel file names, and the clock on which they are brought together."""

from collections.abc import Callable
from dataclasses import dataclass
from threading import Lock
from typing import TYPE_CHECKING, Literal, TypeAlias

from shaftprint.signals._channels import DEFAULT_BLOCK_SAMPLES, Advance, find_channel
from shaftprint.signals._decimate import Grid

if TYPE_CHECKING:
    from shaftprint.recording import Channel, Recording
    from shaftprint.vessel import Vessel

Mode: TypeAlias = Literal["shaftprint", "thesis"]
"""Whether each step is done shaftprint's way or the thesis' way."""

_FEWEST_BLOCK_SAMPLES = 64


@dataclass(frozen=True, kw_only=True, slots=True)
class Sources:
    """The raw channels of one shaft line."""

    speed: "tuple[Channel, ...]"
    """Pulse channels in the order of the vessel file."""
    torque: "Channel"
    """Shaft torque."""
    set_point: "Channel"
    """Set point of the engine speed."""
    rack: "Channel | None" = None
    """Percent torque of the control unit."""
    ship_speed: "Channel | None" = None
    """Speed of the ship."""

    @property
    def every(self) -> "tuple[Channel, ...]":
        """All of them but percent torque and speed of the ship, which come seldom."""
        return (*self.speed, self.torque, self.set_point)


@dataclass(frozen=True, kw_only=True, slots=True)
class Clock:
    """The common grid, and how the channels are read on it."""

    start_s: float
    """Time of the first sample [s]."""
    rate_hz: float
    """Samples a second [Hz]."""
    count: int
    """Number of samples."""
    mode: Mode
    """How each step is done."""
    chunk_s: float | None
    """How much of a channel is read at a time [s]."""
    advance: Advance
    """Is told how many samples have been read."""

    def grid(self, channel: "Channel", latency_s: float = 0.0) -> Grid:
        """Return the grid in samples of a channel that shows everything late by a latency [s]."""
        return Grid(
            first=(self.start_s + latency_s - channel.start_s) * channel.rate_hz,
            step=channel.rate_hz / self.rate_hz,
            count=self.count,
        )

    def block_samples(self, channel: "Channel") -> int:
        """Return how many samples of a channel are read at a time."""
        if self.chunk_s is None:
            return DEFAULT_BLOCK_SAMPLES
        return max(round(self.chunk_s * channel.rate_hz), _FEWEST_BLOCK_SAMPLES)


def find_sources(recording: "Recording", vessel: "Vessel") -> Sources:
    """Return the channels that the vessel file names.

    Raises
    ------
    SignalError
        If one is missing, empty or in another unit.
    """
    sensors = vessel.sensors
    torque, set_point, rack = sensors.shaft_torque, sensors.set_point, sensors.rack
    return Sources(
        speed=tuple(
            find_channel(recording, sensor.channel, unit=sensor.unit, use=f"speed {sensor.name}")
            for sensor in sensors.speed
        ),
        torque=find_channel(recording, torque.channel, unit=torque.unit, use="shaft torque"),
        set_point=find_channel(recording, set_point.channel, unit=set_point.unit, use="set point"),
        rack=None
        if rack is None
        else find_channel(
            recording,
            rack.channel,
            unit=rack.unit,
            use="fuel rack",
            way_out="correct the name there, or take [sensors.rack] out where it was not logged",
        ),
        ship_speed=None
        if sensors.ship_speed is None
        else find_channel(
            recording,
            sensors.ship_speed.channel,
            unit=sensors.ship_speed.unit,
            use="speed of the ship",
            way_out="correct the name there, or take [sensors.ship_speed] out where it was not logged",
        ),
    )


def common_clock(
    sources: Sources,
    *,
    mode: Mode,
    rate_hz: float,
    chunk_s: float | None,
    progress: Callable[[float], None] | None,
) -> Clock:
    """Return the grid that all channels cover, from the latest start to the earliest end."""
    start_s = max(channel.start_s for channel in sources.every)
    stop_s = min(channel.start_s + channel.duration_s for channel in sources.every)
    return Clock(
        start_s=start_s,
        rate_hz=rate_hz,
        count=max(int((stop_s - start_s) * rate_hz + 1e-6), 0),
        mode=mode,
        chunk_s=chunk_s,
        advance=_meter(sum(channel.count for channel in sources.every), progress),
    )


def _meter(total: int, progress: Callable[[float], None] | None) -> Advance:
    """Return a counter of samples that any thread may use."""
    done = 0
    lock = Lock()

    def advance(samples: int) -> None:
        nonlocal done
        with lock:
            done += samples
            if progress is not None:
                progress(done / total)

    return advance
