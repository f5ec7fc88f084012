"""What is in a recording, channel by channel, before anything is made of it."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from shaftprint.errors import SignalError
from shaftprint.recording._level_watch import watch_levels
from shaftprint.recording._levels import Levels
from shaftprint.signals._channel_readings import ChannelReadings, read_channels
from shaftprint.signals._channel_signals import ChannelRole
from shaftprint.signals._gaps import Gap
from shaftprint.signals._signals import Repair
from shaftprint.signals.kinds._pick_up import PulseReading
from shaftprint.units import rpm_from_rev_s, unit_factor

if TYPE_CHECKING:
    from shaftprint.recording._channel import Channel
    from shaftprint.recording._recording import Recording
    from shaftprint.signals.kinds._kind import Source
    from shaftprint.vessel._sensors import SpeedSensor
    from shaftprint.vessel._vessel import Vessel

_ORDER = (ChannelRole.RESPONSE, ChannelRole.EXCITATION, ChannelRole.SIDE)


@dataclass(frozen=True, kw_only=True, slots=True)
class ChannelReport:
    """What one raw channel holds."""

    channel: str
    """Name of the channel in the recording."""
    use: str
    """What the vessel file uses it for."""
    unit: str
    """Unit of the values below."""
    rate_hz: float
    """Sample rate [Hz]."""
    start_s: float
    """Time of the first sample [s]."""
    duration_s: float
    """Length [s]."""
    lowest: float
    """Smallest value [unit]."""
    highest: float
    """Largest value [unit]."""
    mean: float
    """Mean of all values [unit]."""
    pulses: "PulseReport | None"
    """What the pulses say; nothing for other channels and for pulses that cannot be used."""
    faults: tuple[Repair, ...]
    """Missing and doubled pulses, outliers and dropouts, in order of time."""
    gaps: tuple[Gap, ...]
    """Stretches in which it says nothing, in order of time."""
    problem: str | None
    """Why the channel cannot be used, in one sentence; nothing if it can."""
    held: str | None = None
    """That it keeps its last value, how often and how long, in one sentence; nothing if it does not."""


@dataclass(frozen=True, kw_only=True, slots=True)
class PulseReport:
    """What the pulses of a channel say."""

    low: float
    """Level between pulses [unit of the channel]."""
    high: float
    """Level during a pulse [unit of the channel]."""
    per_second: float
    """Mean number of pulses a second [Hz]; half of it is the highest frequency without aliasing."""
    speed_rpm: float
    """Mean speed of the shaft that carries the strips [rpm]."""
    strip_angles_deg: tuple[float, ...]
    """Angle from each strip to the next [deg]."""
    largest_error_deg: float
    """Largest difference of one from that of even strips, or of a wheel without errors [deg]."""


def inspect_channels(recording: "Recording", vessel: "Vessel") -> tuple[ChannelReport, ...]:
    """Look at every channel that the vessel file names, without a campaign.

    A channel that cannot be used gets a report that says why; only one that cannot be found or read
    raises.

    Parameters
    ----------
    recording
        The raw recording, open.
    vessel
        Says which channel carries what.

    Raises
    ------
    SignalError
        If a channel is missing, empty, or in another unit.
    """
    watch = watch_levels(recording)
    readings = read_channels(watch.recording, vessel)
    return channel_reports(readings, watch.levels())


def channel_reports(readings: ChannelReadings, levels: Mapping[str, Levels]) -> tuple[ChannelReport, ...]:
    """Return what each channel that was read holds: speeds and torque first, then what a test moves.

    ``readings``: what every channel gave, from `read_channels`. ``levels``: levels of the raw channels by name.
    """
    sources = sorted(readings.sources, key=lambda source: _ORDER.index(source.kind.role))
    return tuple(_report(source, readings, levels[source.channel.name]) for source in sources)


def _report(source: "Source[Any]", readings: ChannelReadings, levels: Levels) -> ChannelReport:
    channel, reading = source.channel, readings.by_name.get(source.name)
    problem, held = readings.problems.get(source.name), readings.held.get(source.name)
    if reading is not None:
        try:
            source.kind.judge(source, reading)
        except SignalError as error:
            problem = error
    # a raw channel is in the unit of the file
    factor = unit_factor(levels.unit, channel.unit) or 1.0
    return ChannelReport(
        channel=channel.name,
        use=source.kind.use,
        unit=channel.unit,
        rate_hz=channel.rate_hz,
        start_s=channel.start_s,
        duration_s=channel.duration_s,
        lowest=factor * levels.lowest,
        highest=factor * levels.highest,
        mean=factor * levels.mean,
        pulses=_pulse_report(channel, source.sensor, reading) if isinstance(reading, PulseReading) else None,
        faults=() if reading is None else tuple(reading.repairs),
        gaps=() if reading is None else tuple(sorted(reading.gaps, key=lambda gap: gap.start_s)),
        problem=None if problem is None else str(problem),
        held=None if held is None else held.sentence,
    )


def _pulse_report(channel: "Channel", sensor: "SpeedSensor", reading: PulseReading) -> PulseReport:
    strips = reading.strips
    return PulseReport(
        low=reading.levels.low * channel.scale + channel.offset,
        high=reading.levels.high * channel.scale + channel.offset,
        per_second=reading.pulse_rate_hz,
        speed_rpm=rpm_from_rev_s(reading.pulse_rate_hz / sensor.pulses_per_revolution),
        strip_angles_deg=(360.0,) if strips is None else tuple((strips.angle_rev * 360.0).tolist()),
        largest_error_deg=0.0 if strips is None else float(strips.error_rev[strips.worst]) * 360.0,
    )
