"""Covariance of the estimates from the exact gradients.

With weighted residuals of covariance ``V`` (the identity for maximum likelihood and for priors, ``W C W^T`` for
other weights,
zero for rows that only regularise) the estimate's covariance is ``A^-1 B A^-1`` with ``A = J J^T`` and ``B = J V
J^T`` (Huber, The
behavior of maximum likelihood estimates under nonstandard conditions, 1967). For maximum likelihood it is ``A^-1``,
the inverse of
the Fisher information.
"""

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.identify._objective import Objective

# Directions whose scaled information is below this share of the largest are not identifiable at all.
RANK_TOLERANCE = 1e-12


def estimate_covariance(objective: Objective, theta: FloatArray) -> FloatArray:
    """Return the covariance of the free parameters, shape (free, free); infinite variances where nothing is known.

    Parameters
    ----------
    theta
        Free parameters at the optimum, shape (free,).
    """
    _, jacobian = objective.residuals(theta[None, :])
    rows = jacobian[0]
    information = rows @ rows.T
    spread = rows @ _residual_covariance(objective, rows.shape[1]) @ rows.T
    scale = np.sqrt(np.diag(information))
    scale[scale == 0.0] = 1.0
    values, vectors = np.linalg.eigh(information / np.outer(scale, scale))
    known = values > RANK_TOLERANCE * values[-1]
    inverse = (vectors[:, known] / values[known]) @ vectors[:, known].T / np.outer(scale, scale)
    covariance: FloatArray = inverse @ spread @ inverse
    covariance = 0.5 * (covariance + covariance.T)
    lost = np.any(np.abs(vectors[:, ~known]) > 1e-3, axis=1)
    covariance[lost, lost] = np.inf
    return covariance


def _residual_covariance(objective: Objective, rows: int) -> FloatArray:
    """Return the covariance ``V`` of the weighted residuals, in their order, shape (rows, rows)."""
    lines, size = objective.data.shape
    blocks = objective.weights @ objective.covariance @ objective.weights.swapaxes(1, 2)
    covariance = np.zeros((rows, rows))
    place = np.arange(size)[None, :] * lines + np.arange(lines)[:, None]
    covariance[place[:, :, None], place[:, None, :]] = blocks
    count = objective.prior_rows.shape[0]
    if count:
        tail = np.arange(rows - count, rows)
        covariance[tail, tail] = objective.prior_counts
    return covariance
