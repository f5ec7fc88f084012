"""Two contents filtered so that what they share stands out and what is left over is white.

The slower content is divided by the root of the spectrum of what the faster one does not explain, the faster one is
multiplied by its share too: the generalised correlation with the weights of maximum likelihood (Knapp and Carter, "The
generalized correlation method for estimation of time delay", 1976, equation 32; Hannan and Thomson, 1971).
"""

from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray

SEGMENT_S = 60.0
# Lines that are averaged where there are few segments.
NEIGHBOURS = 5
# One line in twenty passes by chance alone.
CHANCE = 3.0
# Lines weaker than this share of the strongest are taken to be that strong; nothing is divided by zero.
FLOOR, TINY = 1e-12, 1e-300


def shared_band(
    slow: FloatArray, fast: FloatArray, rate_hz: float, *, chance: float = CHANCE
) -> tuple[FloatArray, FloatArray]:
    """Return both contents filtered, each of shape (samples,).

    ``slow``, ``fast``: contents at the same instants, as nearly as the map of the clocks is known, shape (samples,).
    ``rate_hz``: their rate [Hz]. ``chance``: coherence up to so many times what chance gives tells nothing.
    """
    length = min(round(SEGMENT_S * rate_hz), slow.size // 3)
    straight_slow, straight_fast = scipy.signal.detrend(slow), scipy.signal.detrend(fast)
    frequency_hz, both = scipy.signal.csd(straight_fast, straight_slow, rate_hz, nperseg=length)
    both = _smooth(both)
    own_slow = _smooth(scipy.signal.welch(straight_slow, rate_hz, nperseg=length)[1])
    own_fast = _smooth(scipy.signal.welch(straight_fast, rate_hz, nperseg=length)[1])
    segments = max(2.0 * slow.size / length - 1.0, 1.0) * NEIGHBOURS / 2.0
    likely = own_slow * own_fast
    coherence = np.abs(both) ** 2 / np.maximum(likely, FLOOR * likely.max() + TINY)
    # without anything shared it is not zero but one over the number of averages
    shared = np.clip((coherence * segments - 1.0) / (segments - 1.0), 0.0, 1.0 - 1e-6)
    shared[coherence < chance / segments] = 0.0
    white = 1.0 / np.sqrt(np.maximum(own_slow * (1.0 - shared), FLOOR * own_slow.max() + TINY))
    share = np.sqrt(shared * own_slow / np.maximum(own_fast, FLOOR * own_fast.max() + TINY))
    every = np.fft.rfftfreq(2 * slow.size, 1.0 / rate_hz)
    return (
        _filtered(slow, np.interp(every, frequency_hz, white)),
        _filtered(fast, np.interp(every, frequency_hz, white * share)),
    )


def _smooth(spectrum: NDArray[Any]) -> NDArray[Any]:
    """Return the mean over neighbouring lines."""
    padded = np.pad(spectrum, NEIGHBOURS // 2, mode="edge")
    return np.convolve(padded, np.full(NEIGHBOURS, 1.0 / NEIGHBOURS), mode="valid")


def _filtered(values: FloatArray, gain: FloatArray) -> FloatArray:
    """Return a content with every line multiplied by a gain; it is mirrored at its end, so that nothing jumps."""
    mirrored = np.concatenate([values, values[::-1]])
    return np.fft.irfft(gain * np.fft.rfft(mirrored), mirrored.size)[: values.size]
