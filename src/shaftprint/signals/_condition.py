"""A continuous channel from raw counts to its unit on the grid: faults replaced, rate lowered."""

from typing import TYPE_CHECKING, Literal

from shaftprint.arrays import FloatArray
from shaftprint.signals._channels import Advance, blocks
from shaftprint.signals._decimate import Grid, decimated
from shaftprint.signals._outliers import FaultLimits, flagged
from shaftprint.signals._patch import Patcher
from shaftprint.signals._signals import Repair
from shaftprint.signals._thesis import previous_neighbours

if TYPE_CHECKING:
    from shaftprint.recording import Channel


def conditioned(
    channel: "Channel",
    limits: FaultLimits,
    grid: Grid,
    *,
    mode: Literal["shaftprint", "thesis"],
    block_samples: int,
    advance: Advance | None = None,
) -> tuple[FloatArray, list[Repair]]:
    """Return a channel on the grid, in its own unit, and what was replaced.

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

    Returns
    -------
    values
        Shape (grid.count,), in the unit of the channel.
    repairs
        In order of time.

    Raises
    ------
    SignalError
        If a value is not a number or the grid is finer than the samples.
    """
    thesis = mode == "thesis"
    repairs: list[Repair] = []
    patcher = Patcher(channel=channel, limits=limits, mean_of_neighbours=thesis, repairs=repairs)
    samples = patcher.patched(flagged(blocks(channel, block_samples, advance), limits))
    values = previous_neighbours(samples, grid) if thesis else decimated(samples, grid, channel=channel.name)
    values *= channel.scale
    values += channel.offset
    return values, repairs
