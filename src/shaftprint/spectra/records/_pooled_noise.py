"""Noise under lines from what is seen beside them."""

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.spectra.lines._noise import Neighbours, equivalent_samples, levelled

_FEWEST_SAMPLES = 12
_SAMPLES_A_CHANNEL = 3
# Within this distance in octaves times ln 2, noise is taken as flat: at a slope of f^-2 it errs by less than 1 %.
_FLAT = 0.1


def pooled_noise(
    samples: ComplexArray, frequency_hz: FloatArray, lines_hz: FloatArray, *, fewest: int
) -> tuple[ComplexArray, FloatArray]:
    """Return the covariance of the noise at lines, with the number of complex samples behind each.

    The samples nearest to a line are averaged as a matrix; where they reach far in terms of octaves, each channel is
    brought to the line first by the slope ``S ~ f^-a`` found among them.

    ``samples``: independent complex samples of the noise, shape (channels, samples). ``frequency_hz``: frequency of
    each sample [Hz], ascending, shape (samples,). ``lines_hz``: frequency of each line [Hz], shape (lines,).
    ``fewest``: number of samples to take; never less than 12, nor than three a channel, where there are so many.
    Returns ``E[e e^H]``, shape (lines, channels, channels), and the number of complex samples, shape (lines,).
    """
    channels, total = samples.shape
    count = min(max(fewest, _FEWEST_SAMPLES, _SAMPLES_A_CHANNEL * channels), total)
    middle = (np.searchsorted(frequency_hz, lines_hz) + np.searchsorted(frequency_hz, lines_hz, side="right")) // 2
    first = np.clip(middle - count // 2, 0, total - count)
    covariance = np.empty((lines_hz.size, channels, channels), dtype=np.complex128)
    number = np.full(lines_hz.size, float(count))
    for line, (start, line_hz) in enumerate(zip(first, lines_hz, strict=True)):
        near = slice(start, start + count)
        chosen, frequency = samples[:, near], frequency_hz[near]
        log_ratio = np.log(frequency / line_hz)
        if np.abs(log_ratio).max() > _FLAT:
            neighbours = Neighbours(bins=frequency, log_ratio=log_ratio, weight=np.ones(count))
            chosen = levelled(chosen, neighbours)
            number[line] = equivalent_samples(neighbours)
        covariance[line] = chosen @ chosen.conj().T / count
    return covariance, number
