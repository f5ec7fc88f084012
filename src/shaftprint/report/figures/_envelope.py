"""Long signals drawn with the smallest and largest sample of each stretch, so that files stay small and spikes stay.

Millions of samples on a page of a thousand dots: each stretch of samples is replaced by its smallest and its largest
one, in the order in which they came. No spike is lost, whatever its length.
"""

import itertools
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray

if TYPE_CHECKING:
    from shaftprint.recording._channel import Channel

STRETCHES = 1200
# Samples that are kept for each period of the highest frequency of a signal without anything faster.
SAMPLES_A_PERIOD = 6.0
_CHUNK = 1 << 18


def envelope(time_s: FloatArray, values: FloatArray, *, stretches: int = STRETCHES) -> tuple[FloatArray, FloatArray]:
    """Return times and values of the smallest and the largest sample of each stretch.

    ``time_s``, ``values``: samples in the order of time, shape (samples,). ``stretches``: number of stretches; a signal
    of at most twice as many samples comes back as it is. Returns times and values, shape (at most 2 * stretches,), in
    the order of time.
    """
    places = extremes(values, stretches=stretches)
    return time_s[places], values[places]


def extremes(values: NDArray[Any], *, stretches: int = STRETCHES) -> NDArray[np.intp]:
    """Return which samples are the smallest and the largest of each stretch, shape (at most 2 * stretches,).

    ``values``: samples in the order of time, shape (samples,). ``stretches``: number of stretches; of a signal of at
    most twice as many samples all are returned.
    """
    if values.size <= 2 * stretches:
        return np.arange(values.size)
    edges = np.linspace(0, values.size, stretches + 1).astype(np.intp)
    places = np.empty(2 * stretches, dtype=np.intp)
    for stretch, (first, last) in enumerate(itertools.pairwise(edges)):
        piece = values[first:last]
        pair = (first + np.argmin(piece), first + np.argmax(piece))
        places[2 * stretch : 2 * stretch + 2] = sorted(pair)
    return places


def worthwhile(time_s: FloatArray, highest_hz: float) -> slice:
    """Return which samples of an evenly sampled signal without anything faster than a frequency are worth drawing."""
    if time_s.size < 2:
        return slice(None)
    rate_hz = (time_s.size - 1) / float(time_s[-1] - time_s[0])
    return slice(None, None, max(1, int(rate_hz // (SAMPLES_A_PERIOD * highest_hz))))


def channel_envelope(channel: "Channel", *, stretches: int = STRETCHES) -> tuple[FloatArray, FloatArray]:
    """Return times and values of the smallest and largest sample of each stretch of a raw channel, read in pieces.

    ``channel``: channel of a recording that is open. ``stretches``: number of stretches over the whole channel, at
    least. Returns times [s] and values in the channel's unit, in the order of time.
    """
    pieces = []
    for first in range(0, channel.count, _CHUNK):
        last = min(first + _CHUNK, channel.count)
        share = int(np.ceil(stretches * (last - first) / channel.count))
        # values of the few that are drawn alone: the rest stay counts
        counts = channel.read(first, last)
        places = extremes(counts, stretches=share)
        pieces.append((channel.time_s(first, last)[places], channel.scaled(counts[places])))
    return np.concatenate([time for time, _ in pieces]), np.concatenate([value for _, value in pieces])
