"""FitPercent and the ceiling that the noise allows."""

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray


def fit_percent(measured: ComplexArray, model: ComplexArray) -> float:
    """Return ``100 (1 - |y - yh| / |y - mean y|)`` over the lines of one output (thesis eq. 2.41).

    Parameters
    ----------
    measured, model
        Response of one output, shape (lines,).
    """
    spread = np.linalg.norm(measured - measured.mean())
    return float(100.0 * (1.0 - np.linalg.norm(measured - model) / spread))


def fit_ceiling(measured: ComplexArray, variance: FloatArray) -> float:
    """Return the FitPercent that the true model would have on average: what the noise leaves.

    Parameters
    ----------
    measured
        Response of one output, shape (lines,).
    variance
        Sum of the variances of real and imaginary part, shape (lines,).
    """
    spread = np.linalg.norm(measured - measured.mean())
    return float(100.0 * (1.0 - np.sqrt(variance.sum()) / spread))
