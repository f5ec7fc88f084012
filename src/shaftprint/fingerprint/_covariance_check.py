"""Whether what stands in a fingerprint as a covariance can be one: a file may hold anything."""

from collections.abc import Sequence

import numpy as np

from shaftprint.arrays import FloatArray

# Rounding in seventeen digits, of matrices whose parameters are hardly told apart, stays far below this.
_ROUNDING = 1e-6


def covariance_fault(rows: Sequence[Sequence[float]], std: Sequence[float]) -> str:
    """Return in words why a matrix cannot be the covariance of parameters; empty where it can.

    ``rows``: the matrix. ``std``: standard deviation of each parameter; of one that is not finite or zero nothing is
    asked.
    """
    size, lengths = len(std), sorted({len(row) for row in rows})
    if len(rows) != size or (rows and lengths != [size]):
        shape = f"{len(rows)} rows of {', '.join(str(length) for length in lengths) or 'nothing'}"
        return f"expected {size} rows of {size}, one for each parameter, found {shape}"
    determined = [index for index, value in enumerate(std) if np.isfinite(value) and value > 0.0]
    matrix = np.array(rows, dtype=np.float64).reshape(size, size)[np.ix_(determined, determined)]
    variance = np.diag(matrix)
    if not np.all(np.isfinite(matrix)) or not np.all(variance > 0.0):
        return "expected finite numbers and positive variances where a standard deviation is known, found others"
    scale = np.sqrt(variance)
    with np.errstate(all="ignore"):
        correlation = matrix / scale[:, None] / scale
    if determined and not _is_correlation(correlation):
        return "expected a symmetric matrix without a negative variance in any direction, found another"
    return ""


def _is_correlation(matrix: FloatArray) -> bool:
    # the first also keeps what is not finite away from the second
    if not np.all(np.abs(matrix) <= 1.0 + _ROUNDING) or np.abs(matrix - matrix.T).max() > _ROUNDING:
        return False
    return bool(np.linalg.eigvalsh(matrix).min() >= -_ROUNDING * len(matrix))
