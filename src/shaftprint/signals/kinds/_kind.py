"""What a kind of channel is: where the vessel file names it, what it is to a test, how it is read and normalised."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, Generic, Protocol, TypeVar

from shaftprint.signals._channel_signals import ChannelRole, ChannelSignal
from shaftprint.signals._channels import find_channel
from shaftprint.signals.conditioning._condition import Reading, conditioned

if TYPE_CHECKING:
    from shaftprint.arrays import FloatArray
    from shaftprint.recording._channel import Channel
    from shaftprint.recording._recording import Recording
    from shaftprint.signals._clock import Clock
    from shaftprint.signals._signals import SetPointCalibration
    from shaftprint.signals._working_points import WorkingPoint
    from shaftprint.signals.conditioning._outliers import FaultLimits
    from shaftprint.signals.levels._dc_scale import DcScale
    from shaftprint.signals.levels._steady import SteadyStretch
    from shaftprint.vessel._vessel import Vessel


class Sensor(Protocol):
    """What the vessel file says of every sensor."""

    @property
    def channel(self) -> str:
        """Name of the channel in the recording."""

    @property
    def unit(self) -> str:
        """Unit of the channel."""


SensorT = TypeVar("SensorT", bound=Sensor)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Source(Generic[SensorT]):
    """One channel of a recording with what the vessel file says of it."""

    kind: "ChannelKind[SensorT]"
    """What kind of channel it is."""
    name: str
    """Name of its signal."""
    channel: "Channel"
    """The raw channel."""
    sensor: SensorT
    """What the vessel file says of it."""
    vessel: "Vessel"
    """The installation."""
    spare: bool = False
    """Whether another sensor shows the same, so that this one is left out where it fails."""


def conditioned_on(clock: "Clock", channel: "Channel", limits: "FaultLimits", latency_s: float = 0.0) -> Reading:
    """Return a channel that shows everything late by a latency [s] on the common clock, as ``conditioned`` does."""
    return conditioned(
        channel,
        limits,
        clock.grid(channel, latency_s),
        mode=clock.mode,
        block_samples=clock.block_samples(channel),
        advance=clock.advance,
    )


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SteadyState:
    """What set point, speed and torque together say of the working point and of the set point's line."""

    clock: "Clock"
    """The common grid."""
    stretches: "tuple[SteadyStretch, ...]"
    """Where the line stands still at the working point."""
    working_point: "WorkingPoint"
    """The working point."""
    calibration: "SetPointCalibration"
    """The line from set-point voltage to speed."""
    scale: "DcScale"
    """By how much that line was stretched."""
    speed_rev_s: "FloatArray"
    """Engine speed on the grid [rev/s], shape (samples,)."""


def steady_parts(values: "FloatArray", clock: "Clock", stretches: "Sequence[SteadyStretch]") -> "list[FloatArray]":
    """Return the values of a signal on the grid in each of some steady stretches."""

    def sample(time_s: float) -> int:
        return round((time_s - clock.start_s) * clock.rate_hz)

    return [values[sample(stretch.start_s) : sample(stretch.stop_s)] for stretch in stretches]


class ChannelKind(ABC, Generic[SensorT]):
    """One kind of sensor: everything that the room knows of it."""

    sensor: ClassVar[str]
    """Table of the vessel file's sensors."""
    name: ClassVar[str]
    """Symbol of the quantity."""
    use: ClassVar[str]
    """What it is, in words."""
    role: ClassVar[ChannelRole] = ChannelRole.RESPONSE
    """What it is to a test."""
    needed: ClassVar[bool] = False
    """Whether no test goes without it."""
    own_clock: ClassVar[bool] = False
    """Whether its values stay at their own times instead of the common grid."""
    takes_messages: ClassVar[bool] = False
    """Whether messages at times of their own will do."""
    absence: ClassVar[str] = ""
    """Why there may be no signal though the channel was logged."""

    def sources(self, recording: "Recording", vessel: "Vessel") -> "tuple[Source[SensorT], ...]":
        """Return the channels of this kind that the vessel file names.

        Raises
        ------
        SignalError
            If one is missing, empty or in another unit.
        """
        sensor: SensorT | None = getattr(vessel.sensors, self.sensor)
        if sensor is None:
            return ()
        way_out = "correct the name there"
        if not self.needed:
            way_out += f", or take [sensors.{self.sensor}] out where it was not logged"
        channel = find_channel(
            recording,
            sensor.channel,
            unit=sensor.unit,
            use=self.use,
            way_out=way_out,
            takes_messages=self.takes_messages,
            sensors=vessel.sensors,
            ship=vessel.name,
        )
        return (Source(kind=self, name=self.name, channel=channel, sensor=sensor, vessel=vessel),)

    def limits(self, source: Source[SensorT]) -> "FaultLimits | None":
        """Return what counts as a fault where samples follow the quantity; nothing for pulses and messages."""
        return None

    def stated_hold_s(self, source: Source[SensorT]) -> float | None:
        """Return for how long the vessel file says that each value is held [s]; None where equal samples say nothing.

        They do not in messages at times of their own, of which a sender may have no newer one.
        """
        return None if source.channel.is_uneven else 0.0

    @abstractmethod
    def read(self, source: Source[SensorT], clock: "Clock") -> Reading:
        """Return the values of a channel in the unit of the quantity, with what was repaired and what is missing.

        Raises
        ------
        SignalError
            If the channel cannot be used.
        """

    def judge(self, source: Source[SensorT], reading: Reading) -> tuple[str, ...]:
        """Return what the reader should know of a channel that was read.

        Raises
        ------
        SignalError
            If what was read cannot be used.
        """
        return reading.findings

    @abstractmethod
    def signal(self, source: Source[SensorT], reading: Reading, steady: SteadyState) -> ChannelSignal | None:
        """Return the signal with its working point; nothing where the channel says nothing in this test.

        Raises
        ------
        SignalError
            If the channel contradicts the working point.
        """
