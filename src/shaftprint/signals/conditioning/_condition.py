"""A continuous channel from raw counts to its unit on the grid: faults replaced, rate lowered."""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal, Self

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray
from shaftprint.signals._channels import Advance, Counts, blocks
from shaftprint.signals._gaps import Gap, bridge, clock_gaps
from shaftprint.signals._signals import Repair
from shaftprint.signals.conditioning._cut_off import CutOff
from shaftprint.signals.conditioning._decimate import SampleGrid, decimated, reach_samples
from shaftprint.signals.conditioning._outliers import FaultLimits, flagged
from shaftprint.signals.conditioning._patch import Patcher
from shaftprint.signals.conditioning._thesis import previous_neighbours

if TYPE_CHECKING:
    from shaftprint.recording._channel import Channel


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SentValues:
    """Messages that a spline has joined."""

    time_s: FloatArray
    """When their values were taken [s], ascending, shape (messages,)."""
    values: FloatArray
    """The values, in the unit of those on the grid, shape (messages,)."""
    rate_hz: float
    """Messages a second, as a rule [Hz]."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Reading:
    """A channel that was read: on the grid, but for one with a clock of its own."""

    values: FloatArray
    """Values, straight lines in gaps, shape (samples,)."""
    repairs: Sequence[Repair]
    """What was replaced, in order of time."""
    gaps: tuple[Gap, ...]
    """What is missing, in order of time."""
    findings: tuple[str, ...] = ()
    """What the reader should know."""
    sent: SentValues | None = None
    """The messages that were joined; None of samples at a rate."""

    @property
    def value_rate_hz(self) -> float:
        """Values a second that a spline has joined [Hz]; infinite of samples at a rate."""
        return math.inf if self.sent is None else self.sent.rate_hz

    def of(self, quantity: Callable[[FloatArray], FloatArray], *, earlier_s: float = 0.0) -> Self:
        """Return what the values mean, and the gaps so much earlier [s]."""
        sent = self.sent and replace(self.sent, values=quantity(self.sent.values))
        gaps = tuple(gap.earlier(earlier_s) for gap in self.gaps)
        return replace(self, values=quantity(self.values), gaps=gaps, sent=sent)


def conditioned(
    channel: "Channel",
    limits: FaultLimits,
    grid: SampleGrid,
    *,
    mode: Literal["shaftprint", "thesis"],
    block_samples: int,
    advance: Advance | None = None,
) -> Reading:
    """Return a channel on the grid, in its own unit, with what was replaced and what is missing.

    ``channel``: what to read. ``limits``: what counts as a fault. ``grid``: instants, in samples of the channel.
    ``mode``: ``"shaftprint"``: straight lines over faults, low-pass filter; ``"thesis"``: mean of the neighbours,
    previous neighbour. ``block_samples``: samples that are read at a time; the result does not depend on it.
    ``advance``: is told the number of samples after each block. Raises SignalError if the grid is finer than the
    samples.
    """
    thesis = mode == "thesis"
    repairs: list[Repair] = []
    patcher = Patcher(channel=channel, limits=limits, mean_of_neighbours=thesis, repairs=repairs)
    ends = CutOff(-1), CutOff(1)
    codes = flagged(blocks(channel, block_samples, advance), limits)
    samples = patcher.patched(_watched(codes, ends) if limits.hold_samples else codes)
    values = previous_neighbours(samples, grid) if thesis else decimated(samples, grid, channel=channel.name)
    lowest, highest = (end.level(limits.hold_samples) for end in ends)
    if lowest is not None or highest is not None:
        # read again: with rails there, crests that are cut off are no telemetry that holds its value
        rails = replace(
            limits,
            lowest=limits.lowest if lowest is None else lowest,
            highest=limits.highest if highest is None else highest,
        )
        return conditioned(channel, rails, grid, mode=mode, block_samples=block_samples)
    values *= channel.scale
    values += channel.offset
    gaps = [*patcher.gaps, *clock_gaps(channel)]
    # what lies one step of the grid beyond the filter may be an instant of the gap by rounding
    reach_s = (reach_samples(grid.step) + grid.step) / channel.rate_hz
    reaching = sorted((replace(gap, reach_s=reach_s) for gap in gaps), key=lambda gap: gap.start_s)
    rate_hz = channel.rate_hz / grid.step
    bridge(values, reaching, start_s=channel.start_s + grid.first / channel.rate_hz, rate_hz=rate_hz)
    return Reading(values=values, repairs=repairs, gaps=tuple(reaching))


def _watched(
    samples: Iterable[tuple[Counts, NDArray[np.uint8]]], ends: Iterable[CutOff]
) -> Iterator[tuple[Counts, NDArray[np.uint8]]]:
    """Yield the samples again; the ends of the channel see them go by."""
    for counts, codes in samples:
        for end in ends:
            end.add(counts, codes)
        yield counts, codes
