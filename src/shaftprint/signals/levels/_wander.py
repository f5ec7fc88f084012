"""Least squares through a disturbance that wanders: coefficients with standard deviations from few neighbouring means.

What disturbs a ship at the quay, recirculating water or a demand that drifts, is as slow as the parts of a test are
long: neighbouring means err alike, and their scatter over the root of their number is far too small. The disturbance is
taken as a stationary Gaussian process with an exponential autocorrelation (first order; G. E. Uhlenbeck and L. S.
Ornstein, "On the theory of the Brownian motion", Physical Review 36, 1930) of unknown size and correlation time ``T``,
with white noise of unknown share beside it, both averaged over each window. Coefficients and size are marginalised at
each ``T`` and share with the usual prior of no knowledge, which gives the factor ``(n - p) / (n - p - 2)`` of a short
series (JCGM 101:2008, 6.4.9.4), then ``T`` over a logarithmic grid and the share over a few. A wander slower than half
of the time that is looked at cannot be told from a constant: it is not in the numbers.
"""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import SignalError

_TIMES = 24
_SHORTEST_SHARE, _LONGEST_SHARE = 0.25, 0.5
# Variance of the white noise in ten seconds over that of the wander.
_WHITE_SHARES, _WHITE_S = (0.0, 0.1, 0.4, 1.6), 10.0
# With fewer windows beyond the coefficients a variance has no expectation.
FEWEST_BEYOND = 3
# A column that is smaller than this share of the first says nothing.
_NOTHING = 1e-9


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Line:
    """Coefficients of a fit through a disturbance that wanders."""

    value: FloatArray
    """Coefficients, shape (columns,)."""
    covariance: FloatArray
    """Their covariance, shape (columns, columns)."""

    @property
    def std(self) -> FloatArray:
        """Standard deviations, shape (columns,)."""
        return np.asarray(np.sqrt(np.diag(self.covariance)))


def fit_through_wander(values: FloatArray, columns: FloatArray, start_s: FloatArray, stop_s: FloatArray) -> Line:
    """Fit ``values = columns @ coefficients`` by generalised least squares.

    ``values``: mean over each window, shape (windows,). ``columns``: what each coefficient is multiplied by in each
    window, shape (windows, columns), the first of them not zero; a column of zeros has the coefficient 0 with the
    standard deviation 0. ``start_s``, ``stop_s``: when the windows begin and end [s], shape (windows,). Raises
    SignalError if there are fewer than three windows more than columns that are not zero.
    """
    size = np.abs(columns).max(axis=0, initial=0.0)
    nonzero = np.flatnonzero(size > _NOTHING * size[0])
    if values.size - nonzero.size < FEWEST_BEYOND:
        raise SignalError(
            f"expected at least {FEWEST_BEYOND + nonzero.size} stretches of time to tell {nonzero.size} numbers from a "
            f"load or demand that wanders, found {values.size}; record longer at the working point."
        )
    scale = float(np.abs(values).max()) or 1.0
    design = columns[:, nonzero] / size[nonzero]
    fits = [
        _given_disturbance(values / scale, design, lower)
        for lower in _disturbances(start_s, stop_s, float(np.min(stop_s - start_s)))
    ]
    logs = np.array([fit[2] for fit in fits])
    share = np.exp(logs - logs.max())
    share /= share.sum()
    coefficients = np.array([fit[0] for fit in fits])
    mean = share @ coefficients
    apart = coefficients - mean
    spread = np.tensordot(share, np.array([fit[1] for fit in fits]), axes=1) + (apart * share[:, None]).T @ apart
    unit = scale / size[nonzero]
    value, covariance = np.zeros(size.size), np.zeros((size.size, size.size))
    value[nonzero], covariance[np.ix_(nonzero, nonzero)] = mean * unit, spread * np.outer(unit, unit)
    return Line(value=value, covariance=covariance)


def _given_disturbance(
    values: FloatArray, design: FloatArray, lower: FloatArray
) -> tuple[FloatArray, FloatArray, float]:
    """Return coefficients, their covariance and the logarithm of the likelihood for a shape of the disturbance.

    ``lower``: cholesky factor of the covariance of the windows up to its size.
    """
    solved = np.linalg.solve(lower, np.column_stack([design, values]))
    white, level = solved[:, -1], solved[:, :-1]
    information = level.T @ level
    coefficients = np.linalg.solve(information, level.T @ white)
    freedom = values.size - coefficients.size
    square = max(float(np.sum((white - level @ coefficients) ** 2)), np.finfo(float).tiny)
    likelihood = (
        -np.log(np.diag(lower)).sum() - 0.5 * np.linalg.slogdet(information)[1] - 0.5 * freedom * np.log(square)
    )
    return coefficients, square / (freedom - 2) * np.linalg.inv(information), float(likelihood)


def _disturbances(start_s: FloatArray, stop_s: FloatArray, shortest_s: float) -> list[FloatArray]:
    """Return the Cholesky factor of the covariance of the windows for every correlation time and white share."""
    longest_s = _LONGEST_SHARE * float(np.max(stop_s) - np.min(start_s))
    length = stop_s - start_s
    factors: list[FloatArray] = []
    for time_s in np.geomspace(_SHORTEST_SHARE * shortest_s, longest_s, _TIMES):
        wander = window_covariance(start_s, stop_s, time_s)
        white = np.diag(_WHITE_S / length)
        factors += [np.asarray(np.linalg.cholesky(wander + share * white)) for share in _WHITE_SHARES]
    return factors


def window_covariance(start_s: FloatArray, stop_s: FloatArray, time_s: float) -> FloatArray:
    """Return the covariance of window means of a process of variance 1 and autocorrelation ``exp(-t / T)``.

    The double integral of the autocorrelation over two windows, by its second antiderivative ``T |t| + T^2 exp(-t/T)``.
    """

    def twice(lag_s: FloatArray) -> FloatArray:
        away = np.abs(lag_s)
        return np.asarray(time_s * away + time_s**2 * np.exp(-away / time_s))

    begins, ends = start_s[:, np.newaxis], stop_s[:, np.newaxis]
    both = twice(ends - start_s) - twice(begins - start_s) - twice(ends - stop_s) + twice(begins - stop_s)
    length = stop_s - start_s
    return np.asarray(both / np.outer(length, length))
