"""A continuous channel from raw counts to its unit on the grid: faults replaced, rate lowered."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

from shaftprint.arrays import FloatArray
from shaftprint.signals._channels import Advance, blocks
from shaftprint.signals._gaps import Gap, bridge, clock_gaps
from shaftprint.signals._signals import Repair
from shaftprint.signals.conditioning._decimate import SampleGrid, decimated, reach_samples
from shaftprint.signals.conditioning._outliers import FaultLimits, flagged
from shaftprint.signals.conditioning._patch import Patcher
from shaftprint.signals.conditioning._thesis import previous_neighbours

if TYPE_CHECKING:
    from shaftprint.recording import Channel


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

    Parameters
    ----------
    channel
        What to read.
    limits
        What counts as a fault.
    grid
        Instants, in samples of the channel.
    mode
        ``"shaftprint"``: straight lines over faults, low-pass filter; ``"thesis"``: mean of the
        neighbours, previous neighbour.
    block_samples
        Samples that are read at a time; the result does not depend on it.
    advance
        Is told the number of samples after each block.

    Raises
    ------
    SignalError
        If the grid is finer than the samples.
    """
    thesis = mode == "thesis"
    repairs: list[Repair] = []
    patcher = Patcher(channel=channel, limits=limits, mean_of_neighbours=thesis, repairs=repairs)
    samples = patcher.patched(flagged(blocks(channel, block_samples, advance), limits))
    values = previous_neighbours(samples, grid) if thesis else decimated(samples, grid, channel=channel.name)
    values *= channel.scale
    values += channel.offset
    gaps = [*patcher.gaps, *clock_gaps(channel)]
    # what lies one step of the grid beyond the filter may be an instant of the gap by rounding
    reach_s = (reach_samples(grid.step) + grid.step) / channel.rate_hz
    reaching = sorted((replace(gap, reach_s=reach_s) for gap in gaps), key=lambda gap: gap.start_s)
    rate_hz = channel.rate_hz / grid.step
    bridge(values, reaching, start_s=channel.start_s + grid.first / channel.rate_hz, rate_hz=rate_hz)
    return Reading(values=values, repairs=repairs, gaps=tuple(reaching))
