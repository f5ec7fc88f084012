"""Roughly how far two clocks are apart, by comparing what both loggers have seen from begin to end."""

import numpy as np
import scipy

from shaftprint.arrays import BoolArray, FloatArray
from shaftprint.errors import ClockError
from shaftprint.signals._content import Content

RATE_HZ = 5.0
"""Rate at which whole recordings are compared [Hz]; a drift of 200 ppm moves three hours by 2 s."""

# Shortest stretch that both must have seen.
SHORTEST_S = 60.0
# Neighbouring values of noise are not independent of each other: one in so many counts.
INDEPENDENT = 10.0
# How much more likely, as a logarithm, the best place must be than any other, and than none.
BY_FAR = 25.0
# Another place is one at which the comparison has been clearly worse in between.
VALLEY = 0.7


def coarse_offset(other: Content, reference: Content) -> float:
    """Return what the reference clock reads more than the other [s], within about a second.

    The changes of both are correlated at every shift; the best must stand out.

    Parameters
    ----------
    other, reference
        What both have seen, at least 5 values a second.

    Raises
    ------
    ClockError
        If there is nothing in common, or the content repeats itself so that several shifts fit.
    """
    moved, still = _changes(other), _changes(reference)
    shared, count = _correlation(still, moved)
    least = SHORTEST_S * RATE_HZ
    if min(moved.size, still.size) < least:
        raise ClockError(
            f"channels {reference.name} and {other.name}: expected at least {SHORTEST_S:g} s in both recordings, "
            f"found {min(moved.size, still.size) / RATE_HZ:.0f} s; use longer recordings."
        )
    shared = np.where(count >= least, np.abs(shared), 0.0)
    gain = -0.5 * count / INDEPENDENT * np.log1p(-np.minimum(shared**2, 1.0 - 1e-12))
    best = int(np.argmax(gain))
    if gain[best] < BY_FAR:
        raise ClockError(
            f"channels {reference.name} and {other.name}: expected the same movements in both, found a correlation of "
            f"{shared[best]:.2f} at the best shift, no more than chance gives; choose channels that show the same, and "
            "a part of the test in which the speed moves."
        )
    elsewhere = ~_hill(shared, best)
    rival = int(np.argmax(np.where(elsewhere, gain, 0.0)))
    if gain[best] - gain[rival] < BY_FAR:
        raise ClockError(
            f"channels {reference.name} and {other.name}: expected movements that occur once, found that a shift by "
            f"{abs(rival - best) / RATE_HZ:.1f} s fits nearly as well; take in a step or a chirp besides the sines."
        )
    # lag zero is where the last of the moved meets the first of the still
    return (best - (moved.size - 1)) / RATE_HZ + reference.start_s - other.start_s


def _changes(content: Content) -> FloatArray:
    """Return how a content changes from one value to the next at the common rate."""
    time_s = np.arange(content.start_s, content.time_s[-1], 1.0 / RATE_HZ)
    width = max(round(content.rate_hz / RATE_HZ), 1)
    smooth = scipy.signal.oaconvolve(content.values - content.values[0], np.full(width, 1.0 / width), mode="same")
    return np.diff(np.interp(time_s, content.time_s, smooth))


def _correlation(still: FloatArray, moved: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the correlation where both overlap, and how many values do, for every shift."""
    ones, others = np.ones(still.size), np.ones(moved.size)

    def slid(a: FloatArray, b: FloatArray) -> FloatArray:
        return np.asarray(scipy.signal.correlate(a, b, mode="full", method="fft"))

    count = np.maximum(np.rint(slid(ones, others)), 1.0)
    energy = np.maximum(slid(still**2, others), 0.0) * np.maximum(slid(ones, moved**2), 0.0)
    floor = 1e-9 * np.sum(still**2) * np.sum(moved**2)
    correlation = slid(still, moved) / np.sqrt(np.maximum(energy, floor)) if floor > 0.0 else np.zeros(count.size)
    return np.clip(correlation, -1.0, 1.0), count


def _hill(shared: FloatArray, best: int) -> BoolArray:
    """Return the shifts that belong to the best: as far as the correlation does not rise again after a valley."""
    low = shared < VALLEY * shared[best]
    # a fast content swings within the drift of a long recording: two seconds belong to the best at least
    least = round(2.0 * RATE_HZ)
    falls_before = np.flatnonzero(low[: max(best - least, 0)])
    right = np.flatnonzero(low[best + least :])
    hill = np.zeros(shared.size, dtype=np.bool_)
    hill[
        falls_before[-1] + 1 if falls_before.size else 0 : best + least + (right[0] if right.size else shared.size)
    ] = True
    return hill
