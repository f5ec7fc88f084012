"""FitPercent and the ceiling that the noise allows."""

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray


def fit_percent(measured: ComplexArray, model: ComplexArray) -> float:
    """Return ``100 (1 - |y - yh| / |y - mean y|)`` over the lines of one output (thesis eq. 2.41); nan for one line.

    Parameters
    ----------
    measured, model
        Response of one output, shape (lines,).
    """
    return _percent(float(np.linalg.norm(measured - model)), measured)


def fit_ceiling(measured: ComplexArray, variance: FloatArray) -> float:
    """Return the FitPercent of the true model at the root mean square of the noise: what the noise leaves.

    The average over many tests is a little higher: by a tenth of what is missing to 100 where one line carries nearly
    all noise. It is nan for one line.

    ``measured``: response of one output, shape (lines,). ``variance``: sum of the variances of real and imaginary part,
    shape (lines,).
    """
    return _percent(float(np.sqrt(variance.sum())), measured)


def _percent(misfit: float, measured: ComplexArray) -> float:
    spread = float(np.linalg.norm(measured - measured.mean()))
    return 100.0 * (1.0 - misfit / spread) if spread > 0.0 else float(np.nan)
