"""Samples that cannot be true: spikes, holds, rail values and what is no number, found as the blocks go by.

A spike is found by the Hampel identifier (Hampel, "The influence curve and its role in robust
estimation", 1974) with a floor: a sample is suspect when it lies further from the median of its window
than both the floor and so many standard deviations, estimated from the median absolute deviation (MAD).
No second median is needed: ``MAD < d`` just when more than half of the window lies nearer than ``d``.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray
from shaftprint.signals._channels import Counts, spots

if TYPE_CHECKING:
    from shaftprint.recording._channel import Channel

GOOD, SPIKE, HOLD, RAIL, MISSING = range(5)
"""Codes of samples, from least to most certain fault."""

SIGMA_PER_MAD = 1.4826
"""Standard deviation over median absolute deviation of a normal distribution."""

# Five samples on each side at 2000 Hz: short against the firing of the engine (12 to 17 ms), which is
# therefore nearly straight within the window.
_HALF_WINDOW = 5
_SIGMAS = 3.0
# The floor is this many times the distance from the median that one good sample in a hundred exceeds:
# the load at full speed is twice that of the working point, and so is its noise.
_FLOOR, _QUANTILE = 5.0, 0.99
_LEAST_STEPS = 4.0

# Shorter than any dropout, longer than noise of a few counts stands still.
_HOLD_SAMPLES = 10
_HOLD_OVER_USUAL = 3
# A channel that often repeats its value for longer has no noise that a hold could be told from.
_STANDS_STILL = 16
# A change by more steps than this is none to the next step.
_ONE_STEP = 1.5


@dataclass(frozen=True, kw_only=True, slots=True)
class FaultLimits:
    """What counts as a fault in one channel, in counts and samples."""

    floor: float
    """Smallest deviation from the median that is suspect [counts]."""
    sigmas: float = _SIGMAS
    """Smallest deviation in standard deviations of its window."""
    half_window: int = _HALF_WINDOW
    """Samples of the window on each side."""
    hold_samples: int = 0
    """Smallest number of equal samples in a row that is a hold; 0 where holds are not looked for."""
    lowest: float = -np.inf
    """Rail: this value and below it [counts]."""
    highest: float = np.inf
    """Rail: this value and above it [counts]."""

    @property
    def margin(self) -> int:
        """Samples on each side that decide about a sample."""
        return max(self.half_window, self.hold_samples)


def fault_limits(channel: "Channel", *, holds: bool, lowest: float = -np.inf, highest: float = np.inf) -> FaultLimits:
    """Return limits that fit the noise of a channel, found from stretches all over it.

    ``holds``: whether to look for holds; it is done only where the channel has noise that never stands still.
    ``lowest``, ``highest``: rails [counts].
    """
    distances, step, longest = [], np.inf, []
    for counts in spots(channel):
        values = counts.astype(np.float64)
        distances.append(_distances(values))
        change = np.abs(np.diff(values))
        step = min(step, float(np.min(change[change > 0.0], initial=np.inf)))
        longest.append(_usual_run(values, step))
    usual = float(np.quantile(np.concatenate(distances), _QUANTILE))
    least = _LEAST_STEPS * step if np.isfinite(step) else 0.0
    # of most spots: a gauge that died half way still has noise before
    run = sorted(longest)[(len(longest) - 1) // 2]
    hold = max(_HOLD_SAMPLES, _HOLD_OVER_USUAL * run) if holds and run <= _STANDS_STILL else 0
    return FaultLimits(floor=max(_FLOOR * usual, least), hold_samples=hold, lowest=lowest, highest=highest)


def flagged(samples: Iterable[Counts], limits: FaultLimits) -> Iterator[tuple[Counts, NDArray[np.uint8]]]:
    """Yield the samples again with a code each; the codes do not depend on the cut into blocks.

    At both ends the channel is mirrored, so that every sample has a whole window.
    """
    margin = limits.margin
    held: NDArray[Any] = np.empty(0)
    mirrored = False
    for block in samples:
        held = np.concatenate([held, block]) if held.size else block
        if not mirrored and held.size > margin:
            held, mirrored = np.concatenate([held[margin:0:-1], held]), True
        if mirrored and held.size > 2 * margin:
            yield held[margin:-margin], sample_codes(held, limits)
            held = held[-2 * margin :]
    if held.size:
        if not mirrored:
            held = np.pad(held, (margin, 0), mode="reflect")
        held = np.pad(held, (0, margin), mode="reflect")
        yield held[margin:-margin], sample_codes(held, limits)


def sample_codes(values: Counts, limits: FaultLimits) -> NDArray[np.uint8]:
    """Return the code of every sample but the margins, shape (values.size - 2 margin,)."""
    margin, half = limits.margin, limits.half_window
    codes = np.zeros(values.size - 2 * margin, dtype=np.uint8)
    inner: Counts = values[margin - half : values.size - margin + half]
    mark_spikes(inner, half, limits.floor, limits.sigmas * SIGMA_PER_MAD, codes)
    if limits.hold_samples:
        mark_holds(values, margin, limits.hold_samples, codes)
    if np.isfinite(limits.lowest) or np.isfinite(limits.highest):
        middle = values[margin : values.size - margin]
        codes[(middle <= limits.lowest) | (middle >= limits.highest)] = RAIL
    if values.dtype != np.int16:
        codes[np.isnan(values[margin : values.size - margin])] = MISSING
    return codes


def mark_spikes(values: Counts, half: int, floor: float, mads: float, codes: NDArray[np.uint8]) -> None:
    """Mark samples further from the median of their window than the floor and so many MADs.

    Nearly all samples are let go unsorted: where the values of more than half of a window, the sample among them, lie
    within the floor of each other, so does the median.
    """
    highest, lowest = (_over(extreme, values, half + 1) for extreme in (np.maximum, np.minimum))
    span: NDArray[Any] = highest - lowest
    if values.dtype == np.int16:
        # a difference of two numbers of 16 bits is one of 16 bits without a sign
        span, floor = span.view(np.uint16), min(np.floor(floor), 65535.0)
    is_near = _over(np.logical_or, span <= span.dtype.type(floor), half + 1)
    looked = np.flatnonzero(~is_near)
    if not looked.size:
        return
    windows = np.lib.stride_tricks.sliding_window_view(values, 2 * half + 1)[looked].astype(np.float64)
    median = np.partition(windows, half, axis=1)[:, half]
    distance = np.abs(windows[:, half] - median)
    nearer = np.abs(windows - median[:, np.newaxis]) * mads < distance[:, np.newaxis]
    codes[looked[(distance > floor) & (nearer.sum(axis=1) > half)]] = SPIKE


def mark_holds(values: Counts, margin: int, shortest: int, codes: NDArray[np.uint8]) -> None:
    """Mark samples that belong to a run of at least ``shortest`` equal ones."""
    if values.size < shortest:
        return
    begins = _over(np.logical_and, values[1:] == values[:-1], shortest - 1)
    if begins.any():
        is_held = _over(np.logical_or, np.pad(begins, shortest - 1), shortest)
        codes[is_held[margin : values.size - margin]] = HOLD


def _over(combined: np.ufunc, values: NDArray[Any], width: int) -> NDArray[Any]:
    """Return what an operation makes of so many neighbours, where one may count twice, shape (values - width + 1,)."""
    reach = 1
    while reach < width:
        step = min(reach, width - reach)
        values = combined(values[:-step], values[step:])
        reach += step
    return values


def _distances(values: FloatArray) -> FloatArray:
    """Return how far each sample is from the median of its window, without the ends."""
    if values.size <= 2 * _HALF_WINDOW:
        return np.zeros(1)
    windows = np.lib.stride_tricks.sliding_window_view(values, 2 * _HALF_WINDOW + 1)
    medians = np.partition(windows, _HALF_WINDOW, axis=1)[:, _HALF_WINDOW]
    return np.abs(values[_HALF_WINDOW:-_HALF_WINDOW] - medians)


def _usual_run(values: FloatArray, step: float) -> int:
    """Return the length of a run of equal values that only one in a thousand exceeds.

    A run that ends in a jump of several steps is none of a channel that stands still by nature: it is what is looked
    for, however often it comes.
    """
    change = np.abs(np.diff(values))
    borders = np.flatnonzero(change)
    if borders.size < 2:
        return _STANDS_STILL + 1
    lengths, jumps = np.diff(borders), change[borders[1:]] > _ONE_STEP * step
    usual = lengths[(lengths < _HOLD_SAMPLES) | ~jumps]
    return int(np.quantile(usual, 0.999)) if 2 * usual.size > lengths.size else _STANDS_STILL + 1
