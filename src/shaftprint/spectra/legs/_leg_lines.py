"""Every line of a leg: amplitudes in all channels, and the covariance of their noise.

The propeller takes ``load (1 + n)^2`` of the torque, which the structures know as ``load (1 + 2 n)``. The square of a
sum of lines falls on sums and differences of all of them. It is known, since the speed is measured: it is taken out of
the torque in time, with the load 1 that the leg has by definition. Left in, it moved ``tau_dn`` by five standard
deviations in a simulated tug.

The noise is that of the bins between the lines, which differ from period to period (Pintelon and Schoukens, "System
Identification: A Frequency Domain Approach", chapter on non-parametric noise models from periodic excitation). The 36
nearest to a line are averaged as a matrix: the factor by which an estimated covariance is enlarged as a weight,
``n / (n - 2)``, is 1.06 then, and 1.2 with 12.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray, IntArray
from shaftprint.spectra.legs._leg_window import LegWindow
from shaftprint.spectra.lines import LineMeasurement, LineNoise, LineVariances, Window
from shaftprint.spectra.records import pooled_noise

if TYPE_CHECKING:
    from shaftprint.campaign import Leg

_NOISE_BINS = 36
# As many bins beside a line as the thesis' local ratio takes on both sides together.
_LOCAL_BINS = 40
_NOT_FITTED = 2


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LegLines:
    """What one leg tells, line by line."""

    window: LegWindow
    """Its whole periods, the torque without the square of the speed."""
    harmonics: tuple[int, ...]
    """Lines, ascending."""
    lines: tuple[LineMeasurement, ...]
    """What each of them tells."""


def measure_leg(leg: "Leg", window: LegWindow, *, excitation: str, speed: str) -> LegLines:
    """Measure every line of a leg in all channels.

    Parameters
    ----------
    leg
        The leg of the campaign.
    window
        Its whole periods.
    excitation
        Name of the channel that is moved.
    speed
        Name of the speed whose square is in the torque.
    """
    values = window.values.copy()
    values[window.channels.index("M_s")] -= (window.of(speed) - 1.0) ** 2
    values -= _drift(values)
    linear = LegWindow(periods=window.periods, clock_ratio=window.clock_ratio, channels=window.channels, values=values)
    harmonics = tuple(harmonic for harmonic in leg.lines if 2 * harmonic < values.shape[2])
    spectrum, by_period = linear.spectrum(), linear.by_period()
    periods = window.periods.periods
    frequency = np.array(harmonics) / window.periods.period_s
    number = np.arange(spectrum.shape[1])
    beside = np.flatnonzero(number % periods != 0).astype(np.int64)
    beside_hz = beside / (periods * window.periods.period_s)
    noise, samples = pooled_noise(spectrum[:, beside], beside_hz, frequency, fewest=_NOISE_BINS)
    overall = values.reshape(len(values), -1).var(axis=1) / len(harmonics)
    lines = []
    for row, harmonic in enumerate(harmonics):
        amplitude = spectrum[:, harmonic * periods]
        lines.append(
            LineMeasurement(
                window=Window(
                    line=f"{leg.name}/{harmonic}",
                    frequency_hz=float(frequency[row]),
                    start_s=window.periods.start_s,
                    periods=harmonic * periods,
                ),
                channels=window.channels,
                excitation=excitation,
                amplitude=amplitude,
                harmonic=np.full((_NOT_FITTED, len(values)), np.nan + 0j),
                harmonic_variance=np.full((_NOT_FITTED, len(values)), np.nan),
                mean=window.values.mean(axis=(1, 2)),
                noise=LineNoise(covariance=noise[row], complex_samples=float(samples[row])),
                variances=LineVariances(
                    signal=0.5 * np.abs(amplitude) ** 2,
                    local=_local(spectrum, beside, harmonic * periods),
                    # of a sum of lines each answers for its share, so that all together answer for the whole
                    overall=overall,
                ),
                stretches=by_period[:, :, harmonic],
                excitation_frequency_hz=float(frequency[row]),
            )
        )
    return LegLines(window=linear, harmonics=harmonics, lines=tuple(lines))


def _drift(values: FloatArray) -> FloatArray:
    """Return the straight line through the means of the periods, shape of ``values``."""
    _, periods, length = values.shape
    centred = np.arange(periods) - 0.5 * (periods - 1)
    slope = values.mean(axis=2) @ centred / (centred @ centred * length)
    place = np.arange(periods * length).reshape(periods, length) - 0.5 * (periods * length - 1)
    drift: FloatArray = slope[:, np.newaxis, np.newaxis] * place
    return drift


def _local(spectrum: ComplexArray, beside: IntArray, line: int) -> FloatArray:
    """Return the variance in the bins beside a line, shape (channels,)."""
    middle = int(np.searchsorted(beside, line))
    first = min(max(middle - _LOCAL_BINS // 2, 0), max(beside.size - _LOCAL_BINS, 0))
    near = spectrum[:, beside[first : first + _LOCAL_BINS]]
    variance: FloatArray = 0.5 * (np.abs(near) ** 2).sum(axis=1)
    return variance
