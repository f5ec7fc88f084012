"""The two ways of the past to measure a sine, kept for comparison."""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import ComplexArray
from shaftprint.spectra.lines._line_fit import LineFit, SineMethod, WindowSamples


@dataclass(frozen=True, kw_only=True, slots=True)
class ExactBin(SineMethod):
    """Pick the DFT bin of the line: the thesis' way (Fingerprinting II, section 3.3.1).

    Bin ``i`` of the transform of a window of ``i`` periods. The window is rounded to whole samples, so the line
    sits beside the bin by up to ``i / samples`` of a bin and leaks; drift leaks too.
    """

    def fit(self, samples: WindowSamples) -> LineFit:
        """Measure the sine; see `SineMethod.fit`."""
        spectrum = np.fft.rfft(samples.values, axis=1)
        chosen = np.full(len(samples.values), samples.window.periods)
        return _fit_of_bins(samples, spectrum, chosen)


@dataclass(frozen=True, kw_only=True, slots=True)
class HighestPeak(SineMethod):
    """Pick the highest peak of each channel's DFT: the way before the thesis.

    Wrong wherever noise at any frequency is stronger than the response to the line (thesis section 3.3).
    """

    def fit(self, samples: WindowSamples) -> LineFit:
        """Measure the sine; see `SineMethod.fit`."""
        spectrum = np.fft.rfft(samples.values, axis=1)
        chosen = 1 + np.argmax(np.abs(spectrum[:, 1:]), axis=1)
        return _fit_of_bins(samples, spectrum, chosen)


def _fit_of_bins(
    samples: WindowSamples, spectrum: ComplexArray, chosen: np.ndarray[tuple[int, ...], np.dtype]
) -> LineFit:
    """Take one bin out of each channel's spectrum; phases count from the start of the window."""
    count = samples.time_s.size
    channel = np.arange(len(spectrum))
    amplitude = spectrum[channel, chosen] * (2.0 / count)
    # the first sample lies up to one sample after the start of the window
    shift = np.exp(-2j * np.pi * chosen * (samples.rate_hz / count) * samples.time_s[0])
    mean = spectrum[:, 0].real / count
    residual = spectrum.copy()
    residual[:, 0] = 0.0
    residual[channel, chosen] = 0.0
    return LineFit(
        samples=samples,
        amplitude=(amplitude * shift)[np.newaxis],
        mean=mean,
        residual=np.fft.irfft(residual, n=count, axis=1),
    )
