"""Is what is left of the noise white? The portmanteau test of several outputs."""

from collections.abc import Sequence

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.distributions import chi_square_tail


def whiteness_p_value(whitened: FloatArray, *, lags: int, fitted: int, lengths: Sequence[int] | None = None) -> float:
    """Return the probability of correlations as large as these, or larger, if the samples are independent.

    ``N^2 sum_k tr(C_k^T C_0^-1 C_k C_0^-1) / (N - k)`` over the lags is a chi-square of ``m^2 (lags - fitted)`` degrees
    of freedom (Ljung and Box, On a measure of lack of fit in time series models, 1978; Hosking, The multivariate
    portmanteau statistic, 1980).

    Parameters
    ----------
    whitened
        Shape (samples, outputs).
    lags
        Number of lags, more than ``fitted``.
    fitted
        Order of the autoregression that was estimated from the same samples.
    lengths
        Lengths of the stretches that stand one after the other; nothing is correlated across a gap.
    """
    count, outputs = whitened.shape
    borders = np.cumsum([count] if lengths is None else lengths)[:-1]
    parts = np.split(whitened, borders)
    inverse = np.linalg.inv(whitened.T @ whitened / count)
    total = 0.0
    for lag in range(1, lags + 1):
        pairs = [(part[lag:], part[: part.shape[0] - lag]) for part in parts if part.shape[0] > lag]
        number = sum(ahead.shape[0] for ahead, _ in pairs)
        if number == 0:
            continue
        covariance = sum((ahead.T @ behind for ahead, behind in pairs), np.zeros((outputs, outputs))) / count
        total += count**2 / number * float(np.trace(covariance.T @ inverse @ covariance @ inverse))
    return chi_square_tail(total, outputs**2 * (lags - fitted))
