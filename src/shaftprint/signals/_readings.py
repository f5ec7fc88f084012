"""What was read of a recording, as far as a test can be made of it."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from shaftprint.errors import SignalError
from shaftprint.reasons import Reason
from shaftprint.signals._channel_readings import ChannelReadings
from shaftprint.signals._gaps import Coverage, Gap, within
from shaftprint.signals._held_samples import held_reasons
from shaftprint.signals._signals import Repair
from shaftprint.signals.conditioning._condition import Reading
from shaftprint.signals.kinds._speed_reading import SpeedReading

if TYPE_CHECKING:
    from shaftprint.arrays import FloatArray
    from shaftprint.signals._clock import Clock
    from shaftprint.signals.kinds._kind import Source


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Readings:
    """Everything that was read, before it is put together."""

    clock: "Clock"
    """The common grid."""
    sources: "tuple[Source[Any], ...]"
    """What was read, in the order of the kinds."""
    by_name: Mapping[str, Reading]
    """What each of them gave."""
    gaps: tuple[Gap, ...]
    """Where a channel of the grid says nothing, in order of time."""
    findings: tuple[str, ...]
    """What the reader should know of the channels."""
    reasons: tuple[Reason, ...] = ()
    """What speaks against numbers that are made of them."""

    @property
    def pick_ups(self) -> tuple[SpeedReading, ...]:
        """The speed channels; the first is the one that is identified."""
        return tuple(reading for reading in self.by_name.values() if isinstance(reading, SpeedReading))

    @property
    def set_point(self) -> "FloatArray":
        """Values of the set point, which become a speed by its line, shape (samples,)."""
        return self.by_name["n_set"].values

    @property
    def torque_nm(self) -> "FloatArray":
        """Shaft torque [N m], shape (samples,)."""
        return self.by_name["M_s"].values

    @property
    def repairs(self) -> tuple[Repair, ...]:
        """What was repaired, in order of time."""
        repairs = [repair for reading in self.by_name.values() for repair in reading.repairs]
        return tuple(sorted(repairs, key=lambda repair: repair.time_s))

    @property
    def coverage(self) -> Coverage:
        """What the grid covers."""
        clock = self.clock
        return Coverage.of_grid(start_s=clock.start_s, samples=clock.count, rate_hz=clock.rate_hz, gaps=self.gaps)


def usable_readings(channels: ChannelReadings) -> Readings:
    """Return what a test can be made of; a spare sensor that fails is left out.

    Raises SignalError if a channel that is no spare cannot be used.
    """
    read, sources, clock = channels.by_name, channels.sources, channels.clock
    by_name: dict[str, Reading] = {}
    failed: list[str] = []
    for source in sources:
        if not source.spare:
            by_name[source.name] = _usable(source, channels)
    gaps = [gap for s in sources if s.name in by_name and not s.kind.own_clock for gap in read[s.name].gaps]
    for source in sources:
        if source.spare:
            try:
                by_name[source.name] = _without_gaps_of_its_own(_usable(source, channels), gaps)
            except SignalError as error:
                failed.append(f"{source.name} was left out: {error}")
    used = tuple(source for source in sources if source.name in by_name)
    readings = {source.name: by_name[source.name] for source in used}
    pick_ups = [reading for reading in readings.values() if isinstance(reading, SpeedReading)]
    others = [reading for reading in readings.values() if not isinstance(reading, SpeedReading)]
    needed = [source.name for source in used if not source.spare]
    spare = [source.name for source in used if source.spare and source.name in channels.held]
    return Readings(
        clock=clock,
        sources=used,
        by_name=readings,
        gaps=tuple(sorted((gap for gap in gaps if gap.last_s > clock.start_s), key=lambda gap: gap.start_s)),
        findings=(*_findings(others), *failed, *_findings(pick_ups), *(channels.held[name].sentence for name in spare)),
        reasons=tuple(held_reasons({name: one for name, one in channels.held.items() if name in needed})),
    )


def _usable(source: "Source[Any]", channels: ChannelReadings) -> Reading:
    """Return what a channel gave, with what the reader should know of it.

    Raises SignalError if it cannot be used.
    """
    if source.name in channels.problems:
        raise channels.problems[source.name]
    reading = channels.by_name[source.name]
    return replace(reading, findings=source.kind.judge(source, reading))


def _findings(readings: Iterable[Reading]) -> Iterator[str]:
    return (finding for reading in readings for finding in reading.findings)


def _without_gaps_of_its_own(reading: Reading, gaps: Sequence[Gap]) -> Reading:
    """Return what a spare sensor gives if it misses nothing but what the other channels miss too.

    Raises SignalError if it has a gap of its own: that must not cost the windows of the first sensor.
    """
    for gap in reading.gaps:
        if not within(gap, gaps):
            raise SignalError(f"{gap.sentence}; check the pick-up.")
    return reading
