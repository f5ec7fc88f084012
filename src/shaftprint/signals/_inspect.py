"""What is in a recording, channel by channel, before anything is made of it."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from shaftprint.errors import SignalError
from shaftprint.signals._channel_signals import ChannelRole
from shaftprint.signals._channels import DEFAULT_BLOCK_SAMPLES, Counts, blocks
from shaftprint.signals._clock import clock_of
from shaftprint.signals._gaps import Gap, clock_gaps
from shaftprint.signals._signals import Repair
from shaftprint.signals.conditioning import FaultLimits, Patcher, flagged
from shaftprint.signals.kinds import find_sources, judge_saturation, numbered_strips, pulse_gaps, pulse_repairs
from shaftprint.signals.pulses import find_edges, pulse_levels
from shaftprint.vessel import SpeedSensor

if TYPE_CHECKING:
    from shaftprint.recording import Channel, Recording
    from shaftprint.signals.kinds import Source
    from shaftprint.vessel import Vessel

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


@dataclass(frozen=True, kw_only=True, slots=True)
class PulseReport:
    """What the pulses of a channel say."""

    low: float
    """Level between pulses [unit of the channel]."""
    high: float
    """Level during a pulse [unit of the channel]."""
    per_second: float
    """Mean number of pulses a second [Hz]; half of it is the highest frequency without aliasing."""
    strip_angles_deg: tuple[float, ...]
    """Angle from each strip to the next [deg]."""


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
        If a channel is missing, empty, in another unit, or holds no numbers.
    """
    sources = sorted(find_sources(recording, vessel), key=lambda source: _ORDER.index(source.kind.role))
    return tuple(report for source in sources for report in _inspected(source))


def _inspected(source: "Source[Any]") -> tuple[ChannelReport, ...]:
    limits = source.kind.limits(source)
    if limits is not None:
        return (_inspect_values(source, limits),)
    if source.kind.own_clock:
        return (_inspect_messages(source),)
    return (_inspect_pulses(source),) if isinstance(source.sensor, SpeedSensor) else ()


class _Extremes:
    """Smallest and largest count of the blocks that pass by, and their mean."""

    def __init__(self) -> None:
        self.lowest, self.highest = np.inf, -np.inf
        self._total, self._samples = 0.0, 0

    def watched(self, channel: "Channel") -> Iterator[Counts]:
        # a channel that cannot be used is looked at once more, from its beginning
        self._total, self._samples = 0.0, 0
        for block in blocks(channel, DEFAULT_BLOCK_SAMPLES):
            # fmin and fmax pass over what is not a number
            self.lowest = min(self.lowest, float(np.fmin.reduce(block)))
            self.highest = max(self.highest, float(np.fmax.reduce(block)))
            self._total += float(np.nansum(block, dtype=np.float64))
            self._samples += int(np.count_nonzero(np.isfinite(block)))
            yield block

    @property
    def mean(self) -> float:
        return self._total / self._samples if self._samples else np.nan


def _inspect_pulses(source: "Source[SpeedSensor]") -> ChannelReport:
    channel, sensor = source.channel, source.sensor
    extremes = _Extremes()
    pulses, problem = None, None
    faults: tuple[Repair, ...] = ()
    gaps: tuple[Gap, ...] = ()
    try:
        levels = pulse_levels(channel, edge=sensor.edge)
        train, strips = numbered_strips(find_edges(extremes.watched(channel), levels), sensor)
        gaps = pulse_gaps(channel, train, sensor.pulses_per_revolution)
        faults = pulse_repairs(channel, train, gaps)
        rate = train.number[-1] / (train.position[-1] - train.position[0]) * channel.rate_hz
        pulses = PulseReport(
            low=levels.low * channel.scale + channel.offset,
            high=levels.high * channel.scale + channel.offset,
            per_second=float(rate),
            strip_angles_deg=((360.0,) if strips is None else tuple((strips.angle_rev * 360.0).tolist())),
        )
    except SignalError as error:
        problem = str(error)
        _exhaust(extremes.watched(channel))
    return _report(source, extremes, pulses, faults, gaps, problem)


def _inspect_values(source: "Source[Any]", limits: FaultLimits) -> ChannelReport:
    channel = source.channel
    extremes = _Extremes()
    repairs: list[Repair] = []
    gaps = clock_gaps(channel)
    problem = None
    try:
        patcher = Patcher(channel=channel, limits=limits, repairs=repairs, gaps=gaps)
        _exhaust(patcher.patched(flagged(extremes.watched(channel), limits)))
        judge_saturation(channel, repairs)
    except SignalError as error:
        problem = str(error)
        _exhaust(extremes.watched(channel))
    return _report(source, extremes, None, tuple(repairs), tuple(gaps), problem)


def _inspect_messages(source: "Source[Any]") -> ChannelReport:
    extremes = _Extremes()
    _exhaust(extremes.watched(source.channel))
    try:
        reading = source.kind.read(source, clock_of(source.channel))
    except SignalError as error:
        return _report(source, extremes, None, (), (), str(error))
    return _report(source, extremes, None, tuple(reading.repairs), reading.gaps, None)


def _exhaust(passing: Iterable[object]) -> None:
    for _ in passing:
        pass


def _report(
    source: "Source[Any]",
    extremes: _Extremes,
    pulses: PulseReport | None,
    faults: tuple[Repair, ...],
    gaps: tuple[Gap, ...],
    problem: str | None,
) -> ChannelReport:
    channel = source.channel
    ends = [count * channel.scale + channel.offset for count in (extremes.lowest, extremes.highest)]
    return ChannelReport(
        channel=channel.name,
        use=source.kind.use,
        unit=channel.unit,
        rate_hz=channel.rate_hz,
        start_s=channel.start_s,
        duration_s=channel.duration_s,
        lowest=min(ends),
        highest=max(ends),
        mean=extremes.mean * channel.scale + channel.offset,
        pulses=pulses,
        faults=faults,
        gaps=tuple(sorted(gaps, key=lambda gap: gap.start_s)),
        problem=problem,
    )
