"""The low-pass that data and model go through alike before they are compared: linear phase, taken off again."""

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray

# Transition from pass to stop takes about 3.3 / length of a Hamming window: half of the cut-off frequency here.
_LENGTH_TIMES_CUT_OFF = 6.6
# A block of the convolution is so many times as long as the filter.
_BLOCK_OF_TAPS = 8


def reach_of_low_pass(rate_hz: float, highest_hz: float) -> int:
    """Return how many samples on either side of one go into it."""
    return int(np.ceil(0.5 * _LENGTH_TIMES_CUT_OFF * rate_hz / highest_hz))


def low_pass(values: FloatArray, rate_hz: float, highest_hz: float, *, out: FloatArray | None = None) -> FloatArray:
    """Return signals without what is faster than a frequency, neither late nor early, shape of ``values``.

    The ends are continued by their last value, so that half a filter's length from either end counts less.

    ``values``: signals along the last axis, shape (..., samples). ``rate_hz``, ``highest_hz``: sample rate and
    frequency at which half of the amplitude is left [Hz]. ``out``: where the result goes; ``values`` itself may be
    given.
    """
    if highest_hz >= rate_hz / 2.0:
        return values
    half = reach_of_low_pass(rate_hz, highest_hz)
    # a windowed sinc (Oppenheim and Schafer, "Discrete-Time Signal Processing", section 7.5)
    taps = np.sinc(2.0 * highest_hz / rate_hz * np.arange(-half, half + 1)) * np.hamming(2 * half + 1)
    taps /= taps.sum()
    size = 1 << (_BLOCK_OF_TAPS * taps.size).bit_length()
    response = np.fft.rfft(taps, size)
    smooth = np.empty_like(values) if out is None else out
    # one signal after the other: the transforms of all together would need several times their memory
    for row in np.ndindex(values.shape[:-1]):
        smooth[row] = _convolved(np.pad(values[row], half, mode="edge"), response, size, taps.size)
    return smooth


def _convolved(values: FloatArray, response: ComplexArray, size: int, taps: int) -> FloatArray:
    """Return where taps lie wholly on values, shape (values - taps + 1,): block by block, overlaps saved.

    The response is that of the taps at the frequencies of a block of ``size`` samples.
    """
    new = size - taps + 1
    out = np.empty(values.size - taps + 1)
    for first in range(0, out.size, new):
        block = np.fft.irfft(np.fft.rfft(values[first : first + size], size) * response, size)
        part = out[first : first + new]
        part[:] = block[taps - 1 : taps - 1 + part.size]
    return out
