"""All channels of a recording that the vessel file names, read two at a time, once."""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from shaftprint.errors import SignalError
from shaftprint.memory import give_back_memory
from shaftprint.signals._channel_signals import ChannelRole
from shaftprint.signals._clock import Clock, Mode, common_clock
from shaftprint.signals._held_samples import HeldSamples, held_samples
from shaftprint.signals.conditioning._condition import Reading
from shaftprint.signals.conditioning._runs import RunTally
from shaftprint.signals.kinds._kinds import find_sources
from shaftprint.signals.kinds._swaps import swapped_pulses

if TYPE_CHECKING:
    from shaftprint.recording._channel import Channel
    from shaftprint.recording._recording import Recording
    from shaftprint.signals.kinds._kind import Source
    from shaftprint.vessel._vessel import Vessel

# One thread computes while the other waits for the file; more would only queue for the file.
_THREADS = 2


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ChannelReadings:
    """What every channel of the vessel file gave or why it gave nothing, before a campaign says what was asked."""

    clock: Clock
    """The common grid."""
    sources: "tuple[Source[Any], ...]"
    """What was read, in the order of the kinds."""
    by_name: Mapping[str, Reading]
    """What each gave, without those that failed."""
    problems: Mapping[str, SignalError]
    """Why the others gave nothing."""
    held: Mapping[str, HeldSamples] = field(default_factory=dict)
    """Which of them keep their last value, and how."""
    missing: tuple[str, ...] = ()
    """Why channels of the vessel file were not read, where a speed alone was to do."""


def read_channels(
    recording: "Recording",
    vessel: "Vessel",
    *,
    mode: Mode = "shaftprint",
    rate_hz: float = 200.0,
    chunk_s: float | None = None,
    progress: Callable[[float], None] | None = None,
    partly: bool = False,
) -> ChannelReadings:
    """Read every channel that the vessel file names.

    ``recording``, ``vessel``, ``mode``, ``rate_hz``, ``chunk_s``, ``progress``: as for `prepare_signals`. ``partly``:
    whether a speed alone will do, as in a trial of a pick-up; else every channel has to be there. Raises SignalError if
    a channel is missing, empty, or in another unit.
    """
    sources, missing = find_sources(recording, vessel, partly=partly)
    clock = common_clock(logger_channels(sources), mode=mode, rate_hz=rate_hz, chunk_s=chunk_s, progress=progress)
    stated_s = {source.name: source.kind.stated_hold_s(source) for source in sources}
    tallies = {source.name: RunTally(source.channel) for source in sources if stated_s[source.name] is not None}
    by_name: dict[str, Reading] = {}
    problems: dict[str, SignalError] = {}
    pool = ThreadPoolExecutor(max_workers=_THREADS)
    try:
        jobs = {source.name: pool.submit(source.kind.read, _watched(source, tallies), clock) for source in sources}
        for name, job in jobs.items():
            try:
                by_name[name] = job.result()
            except SignalError as error:
                problems[name] = error
    finally:
        pool.shutdown(cancel_futures=True)
    problems |= swapped_pulses(sources, problems, clock)
    # edges of pulses are gone, the speed is there
    give_back_memory()
    kept = {name: held_samples(tally.runs(), stated_s=stated_s[name] or 0.0) for name, tally in tallies.items()}
    held = {name: one for name, one in kept.items() if one is not None}
    return ChannelReadings(clock=clock, sources=sources, by_name=by_name, problems=problems, held=held, missing=missing)


def _watched(source: "Source[Any]", tallies: "Mapping[str, RunTally]") -> "Source[Any]":
    """Return a source whose runs of equal samples are counted as it is read."""
    tally = tallies.get(source.name)
    return source if tally is None else replace(source, channel=tally.watched)


def logger_channels(sources: "Sequence[Source[Any]]") -> "list[Channel]":
    """Return the channels of the logger, which span the grid; side signals come seldom."""
    return [source.channel for source in sources if source.kind.role is not ChannelRole.SIDE]
