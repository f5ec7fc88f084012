"""Edges of a digital channel at times of their own, as a channel of pulses.

The flank between two samples is a straight line that crosses the middle of the levels when the edge came, so that what
looks for edges between samples finds it again. Between flanks samples stand on the levels.
"""

import math

import numpy as np

from shaftprint.arrays import FloatArray, IntArray
from shaftprint.recording._channel import Channel, Counts

# So many samples from edge to edge; those that come closer than this share of the others set no rate.
_SAMPLES, _CLOSE = 8.0, 0.05
_LOWEST_HZ, _HIGHEST_HZ = 1e3, 1e6
_DIGITS = 2
# Edges within so many samples are one edge that bounced, or a needle that is none.
_APART = 2.0
# Counts of the high level: a flank is known to so small a part of a sample.
_HIGH = 20_000
# Samples on the first and on the last level, so that the first and the last edge have both.
_ENDS = 4.0


def pulses_at(name: str, edge_s: FloatArray, *, first_level: int, start_s: float, stop_s: float) -> Channel:
    """Return a channel of pulses between 0 and 1 V with flanks at some edges.

    ``name``: name of the channel. ``edge_s``: when the level changes [s], shape (edges,), ascending. ``first_level``:
    level before the first edge, 0 or 1. ``start_s``, ``stop_s``: from when to when the channel was watched [s].
    """
    rate_hz = _rate_hz(edge_s)
    if edge_s.size:
        start_s = min(start_s, float(edge_s[0]) - _ENDS / rate_hz)
        stop_s = max(stop_s, float(edge_s[-1]) + _ENDS / rate_hz)
    place = _without_needles((edge_s - start_s) * rate_hz)

    def read(start: int, stop: int) -> Counts:
        # the flanks of edges before the first and behind the last sample may reach to them
        first, last = np.searchsorted(place, [start - 1, stop]).tolist()
        return _levels(place[first:last], (first_level + first) % 2, start, stop)

    count = math.floor((stop_s - start_s) * rate_hz) + 1
    return Channel(
        name=name,
        unit="V",
        rate_hz=rate_hz,
        start_s=start_s,
        count=count,
        source=read,
        scale=1.0 / _HIGH,
        is_of_edges=True,
    )


def _levels(place: FloatArray, first_level: int, start: int, stop: int) -> Counts:
    """Return the counts of the samples [start, stop) with edges at some places, the level before them given."""
    samples = np.arange(start, stop)
    level = ((first_level + np.searchsorted(place, samples)) % 2).astype(np.float64)
    before: IntArray = np.floor(place).astype(np.int64)
    share = place - before
    rises = np.where((first_level + np.arange(place.size)) % 2 == 0, 1.0, -1.0)
    # the sample that is nearer to the edge leaves its level
    late = share >= 0.5
    nearer = np.where(late, before + 1, before) - start
    moved = np.where(late, 0.5 / np.maximum(share, 0.5) - 1.0, (0.5 - share) / (1.0 - share)) * rises
    inside = (nearer >= 0) & (nearer < samples.size)
    level[nearer[inside]] += moved[inside]
    return np.rint(_HIGH * level).astype(np.int16)


def _rate_hz(edge_s: FloatArray) -> float:
    """Return a sample rate at which flanks do not touch [Hz], a round number."""
    apart = np.diff(edge_s)
    apart = apart[apart > 0.0]
    if not apart.size:
        return _LOWEST_HZ
    least_hz = min(max(_SAMPLES / float(np.quantile(apart, _CLOSE)), _LOWEST_HZ), _HIGHEST_HZ)
    step = 10.0 ** (math.floor(math.log10(least_hz)) + 1 - _DIGITS)
    return math.ceil(least_hz / step) * step


def _without_needles(place: FloatArray) -> FloatArray:
    """Return the edges without those that follow each other at once: of an odd number the first is kept, else none."""
    if not place.size:
        return place
    begins = np.flatnonzero(np.diff(place, prepend=-np.inf) > _APART)
    many = np.diff(np.append(begins, place.size))
    kept: FloatArray = place[begins[many % 2 == 1]]
    return kept
