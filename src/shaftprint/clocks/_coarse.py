"""Roughly how far two clocks are apart, by comparing what both loggers have seen from begin to end."""

from dataclasses import dataclass

import numpy as np
import scipy

from shaftprint.arrays import BoolArray, FloatArray
from shaftprint.errors import ClockError
from shaftprint.signals._content import Content

RATE_HZ = 5.0
"""Rate at which whole recordings are compared [Hz]; a drift of 200 ppm moves three hours by 2 s."""

# Recordings from here on are long: whole ones are compared at 5 Hz, then minute by minute; the shortest stretch that
# both of these must have seen [s].
LONG_S, SHORTEST_OF_LONG_S = 120.0, 60.0
SHORTEST_S = 5.0
"""Shortest recording of which the offset can be told [s]."""

# Rates at which short recordings are compared: a step stands out at a low one, a ringing shaft at a high one [Hz].
SHORT_RATES_HZ = (5.0, 10.0, 20.0, 50.0, 100.0)
# Neighbouring values of noise are not independent of each other: one in so many counts in a long recording.
INDEPENDENT = 10.0
# How much more likely, as a logarithm, the best place must be than any other, and than none; in short recordings there
# are hundreds of places in place of ten thousands, and what counts as one value is not assumed.
BY_FAR, BY_FAR_OF_SHORT = 25.0, 12.0
# Another place is one at which the comparison has been clearly worse in between.
VALLEY = 0.7


@dataclass(frozen=True, kw_only=True, slots=True)
class _Place:
    """The best shift at one rate."""

    rate_hz: float
    offset_s: float
    correlation: float
    gain: float
    """Logarithm of how much more likely it is than none."""
    lead: float
    """The same over the best other shift."""
    rival_s: float
    """How far that is away [s]."""


def is_short(other: Content, reference: Content) -> bool:
    """Return whether one of the recordings has less than two minutes."""
    return _shorter_s(other, reference) < LONG_S


def coarse_offset(other: Content, reference: Content) -> float:
    """Return what the reference clock reads more than the other [s], within about a second.

    The changes of both are correlated at every shift; the best must stand out.

    ``other``, ``reference``: what both have seen, at least 5 values a second. Raises ClockError if there is nothing in
    common, or the content repeats itself so that several shifts fit.
    """
    names = f"channels {reference.name} and {other.name}"
    shorter_s = _shorter_s(other, reference)
    if round(shorter_s, 1) < SHORTEST_S:
        raise ClockError(
            f"{names}: expected at least {SHORTEST_S:g} s in both recordings, found {shorter_s:.1f} s; use longer "
            "recordings."
        )
    rates_hz, by_far = [RATE_HZ], BY_FAR
    if shorter_s < LONG_S:
        fastest_hz = min(other.rate_hz, reference.rate_hz)
        by_far = BY_FAR_OF_SHORT
        rates_hz = [rate_hz for rate_hz in SHORT_RATES_HZ if rate_hz <= fastest_hz]
    place = max((_place(other, reference, rate_hz, shorter_s) for rate_hz in rates_hz), key=lambda place: place.gain)
    if place.gain < by_far:
        raise ClockError(
            f"{names}: expected the same movements in both, found a correlation of {place.correlation:.2f} at the best "
            "shift, no more than chance gives; choose channels that show the same, and a part of the test in which the "
            "speed moves."
        )
    if place.lead < by_far:
        raise ClockError(
            f"{names}: expected movements that occur once, found that a shift by {place.rival_s:.1f} s fits nearly as "
            "well; take in a step or a chirp besides the sines."
        )
    return place.offset_s


def _shorter_s(other: Content, reference: Content) -> float:
    return min(other.values.size / other.rate_hz, reference.values.size / reference.rate_hz)


def _place(other: Content, reference: Content, rate_hz: float, shorter_s: float) -> _Place:
    moved, still = _changes(other, rate_hz), _changes(reference, rate_hz)
    shared, count = correlation(still, moved)
    if shorter_s < LONG_S:
        least, independent = 0.5 * shorter_s * rate_hz, neighbours(moved, still)
    else:
        least, independent = SHORTEST_OF_LONG_S * rate_hz, INDEPENDENT
    shared = np.where(count >= least, np.abs(shared), 0.0)
    gain = -0.5 * count / independent * np.log1p(-np.minimum(shared**2, 1.0 - 1e-12))
    best = int(np.argmax(gain))
    elsewhere = ~_hill(shared, best, rate_hz)
    if shorter_s < LONG_S:
        # a place that leaves less to compare is no less likely for that
        gain = gain * count[best] / count
    rival = int(np.argmax(np.where(elsewhere, gain, 0.0)))
    return _Place(
        rate_hz=rate_hz,
        # lag zero is where the last of the moved meets the first of the still
        offset_s=(best - (moved.size - 1)) / rate_hz + reference.start_s - other.start_s,
        correlation=float(shared[best]),
        gain=float(gain[best]),
        lead=float(gain[best] - gain[rival]),
        rival_s=abs(rival - best) / rate_hz,
    )


def neighbours(moved: FloatArray, still: FloatArray) -> float:
    """Return how many neighbouring values count as one, from what each shows by itself (Bartlett, 1946)."""

    def own(values: FloatArray) -> FloatArray:
        spectrum = np.abs(np.fft.rfft(values - values.mean(), 2 * values.size)) ** 2
        lags = np.fft.irfft(spectrum)[: min(moved.size, still.size) // 2]
        return lags / lags[0] if lags[0] > 0.0 else lags

    return max(1.0 + 2.0 * float(own(moved)[1:] @ own(still)[1:]), 1.0)


def _changes(content: Content, rate_hz: float) -> FloatArray:
    """Return how a content changes from one value to the next at a common rate."""
    time_s = np.arange(content.start_s, content.time_s[-1], 1.0 / rate_hz)
    width = max(round(content.rate_hz / rate_hz), 1)
    smooth = scipy.signal.oaconvolve(content.values - content.values[0], np.full(width, 1.0 / width), mode="same")
    return np.diff(np.interp(time_s, content.time_s, smooth))


def correlation(still: FloatArray, moved: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the correlation where both overlap, and how many values do, for every shift."""
    ones, others = np.ones(still.size), np.ones(moved.size)

    def slid(a: FloatArray, b: FloatArray) -> FloatArray:
        return np.asarray(scipy.signal.correlate(a, b, mode="full", method="fft"))

    count = np.maximum(np.rint(slid(ones, others)), 1.0)
    energy = np.maximum(slid(still**2, others), 0.0) * np.maximum(slid(ones, moved**2), 0.0)
    floor = 1e-9 * np.sum(still**2) * np.sum(moved**2)
    found = slid(still, moved) / np.sqrt(np.maximum(energy, floor)) if floor > 0.0 else np.zeros(count.size)
    return np.clip(found, -1.0, 1.0), count


def _hill(shared: FloatArray, best: int, rate_hz: float) -> BoolArray:
    """Return the shifts that belong to the best: as far as the correlation does not rise again after a valley."""
    low = shared < VALLEY * shared[best]
    # a fast content swings within the drift of a long recording: two seconds belong to the best at least
    least = round(2.0 * rate_hz)
    falls_before = np.flatnonzero(low[: max(best - least, 0)])
    right = np.flatnonzero(low[best + least :])
    hill = np.zeros(shared.size, dtype=np.bool_)
    hill[
        falls_before[-1] + 1 if falls_before.size else 0 : best + least + (right[0] if right.size else shared.size)
    ] = True
    return hill
