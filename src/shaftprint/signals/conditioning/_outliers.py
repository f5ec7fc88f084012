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
from shaftprint.kernels._compiled import compiled
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

# Samples that are compared together: they stay in the fastest cache.
_STRIP = 1024

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
    inner: NDArray[Any] = values[margin - half : values.size - margin + half]
    floor: np.floating[Any] = np.float64(limits.floor)
    if values.dtype == np.int16:
        # exact, and twice as many values go through the processor at a time
        inner, floor = inner.astype(np.float32), np.float32(np.floor(floor))
    mark_spikes(inner, half, floor, limits.sigmas * SIGMA_PER_MAD, codes)
    if limits.hold_samples:
        mark_holds(values, margin, limits.hold_samples, codes)
    if np.isfinite(limits.lowest) or np.isfinite(limits.highest):
        middle = values[margin : values.size - margin]
        codes[(middle <= limits.lowest) | (middle >= limits.highest)] = RAIL
    if values.dtype != np.int16:
        codes[np.isnan(values[margin : values.size - margin])] = MISSING
    return codes


@compiled(nogil=True)
def mark_spikes(values, half: int, floor, mads: float, codes) -> None:  # type: ignore[no-untyped-def]
    """Mark samples further from the median of their window than the floor and so many MADs.

    Nearly all samples are let go by counting alone: if more than half of the window lies above
    ``value - floor`` so does the median, and the same below.
    """
    window = 2 * half + 1
    one, none = np.float32(1), np.float32(0)
    above = np.empty(_STRIP, dtype=np.float32)
    below = np.empty(_STRIP, dtype=np.float32)
    ordered = np.empty(window, dtype=values.dtype)
    for first in range(0, codes.size, _STRIP):
        length = min(_STRIP, codes.size - first)
        centre = values[first + half : first + half + length]
        above[:] = none
        below[:] = none
        for j in range(window):
            neighbour = values[first + j : first + j + length]
            # written without branches: the compiler then compares sixteen samples at a time
            for i in range(length):
                difference = neighbour[i] - centre[i]
                above[i] += one if difference >= -floor else none
                below[i] += one if difference <= floor else none
        for i in range(length):
            if above[i] > half and below[i] > half:
                continue
            for j in range(window):
                other = values[first + i + j]
                k = j
                while k > 0 and ordered[k - 1] > other:
                    ordered[k] = ordered[k - 1]
                    k -= 1
                ordered[k] = other
            median = ordered[half]
            distance = abs(centre[i] - median)
            near = 0
            for j in range(window):
                if abs(ordered[j] - median) * mads < distance:
                    near += 1
            if near > half:
                codes[first + i] = SPIKE


@compiled(nogil=True)
def mark_holds(values, margin: int, shortest: int, codes) -> None:  # type: ignore[no-untyped-def]
    """Mark samples that belong to a run of at least ``shortest`` equal ones."""
    begin = 0
    for k in range(1, values.size + 1):
        if k == values.size or values[k] != values[begin]:
            if k - begin >= shortest:
                for i in range(max(begin, margin), min(k, values.size - margin)):
                    codes[i - margin] = HOLD
            begin = k


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
