"""The low-pass that data and model go through alike before they are compared: linear phase, taken off again."""

import numpy as np
import scipy

from shaftprint.arrays import FloatArray

# Transition from pass to stop takes about 3.3 / length of a Hamming window: half of the cut-off frequency here.
_LENGTH_TIMES_CUT_OFF = 6.6


def low_pass(values: FloatArray, rate_hz: float, highest_hz: float) -> FloatArray:
    """Return signals without what is faster than a frequency, neither late nor early, shape of ``values``.

    The ends are continued by their last value, so that half a filter's length from either end counts less.

    Parameters
    ----------
    values
        Signals along the last axis, shape (..., samples).
    rate_hz, highest_hz
        Sample rate and frequency at which half of the amplitude is left [Hz].
    """
    if highest_hz >= rate_hz / 2.0:
        return values
    half = int(np.ceil(0.5 * _LENGTH_TIMES_CUT_OFF * rate_hz / highest_hz))
    taps = scipy.signal.firwin(2 * half + 1, highest_hz, fs=rate_hz)
    wide = np.pad(values, [(0, 0)] * (values.ndim - 1) + [(half, half)], mode="edge")
    return np.asarray(
        scipy.signal.oaconvolve(wide, taps.reshape((1,) * (values.ndim - 1) + (-1,)), mode="valid", axes=-1)
    )
