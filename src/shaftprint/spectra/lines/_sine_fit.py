"""Least-squares sine at a known frequency over whole periods, with drift and harmonics."""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.spectra.lines._line_fit import LineFit, SineMethod, WindowSamples

# Below this number of periods a parabola is too much like the sine itself.
_PERIODS_FOR_PARABOLA = 4


@dataclass(frozen=True, kw_only=True, slots=True)
class WholePeriodSine(SineMethod):
    """Fit offset, drift, the sine and its harmonics together by least squares: the default.

    The fit needs neither a whole number of samples a period nor a whole number of samples in the window, so
    nothing leaks. Drift is a straight line, from four periods on a parabola: a slow change of the propeller
    load looks like one. Harmonics sit in the same fit because they are not orthogonal to the sine on a
    window that is not a whole number of samples.
    """

    harmonics: int = 3
    """Highest harmonic in the fit; those above half the sample rate are left out."""

    def fit(self, samples: WindowSamples) -> LineFit:
        """Measure the sine; see `SineMethod.fit`."""
        window = samples.window
        orders = max(1, min(self.harmonics, int(0.5 * samples.rate_hz / window.frequency_hz - 1e-9)))
        powers = _harmonic_waves(samples, orders)
        drift = _drift_columns(samples)
        basis = np.concatenate([drift, powers.real, powers.imag])
        mean = samples.values.mean(axis=1)
        deviation = samples.values - mean[:, np.newaxis]
        # the columns are orthogonal but for a few per cent, so that the normal equations lose no digits
        solution = np.linalg.solve(basis @ basis.T, basis @ deviation.T)
        offset, cosine, sine = np.split(solution, [len(drift), len(drift) + orders])
        return LineFit(
            samples=samples,
            amplitude=cosine - 1j * sine,
            mean=mean + offset[0],
            residual=deviation - solution.T @ basis,
        )


def _harmonic_waves(samples: WindowSamples, orders: int) -> ComplexArray:
    omega_rad_s = 2.0 * np.pi * samples.window.frequency_hz
    waves = np.empty((orders, samples.time_s.size), dtype=np.complex128)
    waves[0] = np.exp(1j * omega_rad_s * samples.time_s)
    for order in range(1, orders):
        np.multiply(waves[order - 1], waves[0], out=waves[order])
    return waves


def _drift_columns(samples: WindowSamples) -> FloatArray:
    """Legendre polynomials over the window: their mean is 0, so that the offset stays the mean."""
    scaled_time = 2.0 * samples.time_s / samples.window.duration_s - 1.0
    columns = [np.ones_like(scaled_time), scaled_time]
    if samples.window.periods >= _PERIODS_FOR_PARABOLA:
        columns.append(1.5 * scaled_time**2 - 0.5)
    return np.stack(columns)
