"""Covariance of the estimates from the exact gradients.

With weighted residuals of covariance ``V`` (the identity for maximum likelihood and for priors, ``W C W^T`` for other
weights, zero for rows that only regularise) the estimate's covariance is ``A^-1 B A^-1`` with ``A = J J^T`` and
``B = J V J^T`` (Huber, The behavior of maximum likelihood estimates under nonstandard conditions, 1967). For maximum
likelihood it is ``A^-1``, the inverse of the Fisher information.
"""

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.identify._objective import Objective

# Directions whose scaled information is below this share of the largest are not identifiable at all.
RANK_TOLERANCE = 1e-12
# A number depends on such a direction when more than this share of its scaled slope lies in it.
LOST_SHARE = 1e-3


def estimate_covariance(objective: Objective, theta: FloatArray) -> FloatArray:
    """Return the covariance of the free parameters, shape (free, free); infinite variances where nothing is known.

    Parameters
    ----------
    theta
        Free parameters at the optimum, shape (free,).
    """
    covariance, unknown, _ = _known_part(objective, theta)
    lost = np.linalg.norm(unknown, axis=1) > LOST_SHARE
    covariance[lost, lost] = np.inf
    return covariance


def variance_along(objective: Objective, theta: FloatArray, slopes: FloatArray) -> float:
    """Return the variance of a function of the free parameters to first order; infinite where the data do not fix it.

    It is finite for a product such as ``v K_p`` although neither factor is known alone.

    Parameters
    ----------
    theta
        Free parameters at the optimum, shape (free,).
    slopes
        Derivatives of the function to the free parameters, shape (free,).
    """
    covariance, unknown, scale = _known_part(objective, theta)
    scaled = slopes / scale
    if np.linalg.norm(unknown.T @ scaled) > LOST_SHARE * np.linalg.norm(scaled):
        return float(np.inf)
    return float(slopes @ covariance @ slopes)


def _known_part(objective: Objective, theta: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the covariance within the identifiable directions, the others as columns, and the scale they are in."""
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
    return 0.5 * (covariance + covariance.T), vectors[:, ~known], scale


def _residual_covariance(objective: Objective, rows: int) -> FloatArray:
    """Return the covariance ``V`` of the weighted residuals, in their order, shape (rows, rows)."""
    covariance = np.zeros((rows, rows))
    first = 0
    for experiment in objective.experiments:
        block = experiment.residual_covariance()
        covariance[first : first + block.shape[0], first : first + block.shape[0]] = block
        first += block.shape[0]
    np.fill_diagonal(covariance[first:, first:], objective.prior_counts)
    return covariance
