"""Covariance of the estimates from the exact gradients.

With weighted residuals of covariance ``V`` (the identity for likelihoods and for priors, ``W C W^T`` for other weights,
zero for rows that only regularise) the estimate's covariance is ``A^-1 B A^-1`` with ``A = J J^T`` and ``B = J V J^T``
(Huber, The behavior of maximum likelihood estimates under nonstandard conditions, 1967). For a likelihood it is
``A^-1``: the inverse of the observed information, which with known covariances and no bad lines is Fisher's.
"""

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.identify._objective import Objective

# Directions whose scaled information is below this share of the largest are not identifiable at all.
RANK_TOLERANCE = 1e-12
# A number depends on such a direction when more than this share of its scaled slope lies in it.
LOST_SHARE = 1e-3


def estimate_covariance(objective: Objective, theta: FloatArray, *, expected: bool = False) -> FloatArray:
    """Return the covariance of the free parameters, shape (free, free); infinite variances where nothing is known.

    Parameters
    ----------
    theta
        Free parameters at the optimum, shape (free,).
    expected
        Whether to average over the noise instead of taking the data as they are: for a test that is planned.
    """
    covariance, unknown, _ = _known_part(objective, theta, expected=expected)
    lost = np.linalg.norm(unknown, axis=1) > LOST_SHARE
    covariance[lost, lost] = np.inf
    return covariance


def variance_along(objective: Objective, theta: FloatArray, slopes: FloatArray, *, expected: bool = False) -> float:
    """Return the variance of a function of the free parameters to first order; infinite where the data do not fix it.

    It is finite for a product such as ``v K_p`` although neither factor is known alone.

    Parameters
    ----------
    theta
        Free parameters at the optimum, shape (free,).
    slopes
        Derivatives of the function to the free parameters, shape (free,).
    expected
        See ``estimate_covariance``.
    """
    covariance, unknown, scale = _known_part(objective, theta, expected=expected)
    scaled = slopes / scale
    if np.linalg.norm(unknown.T @ scaled) > LOST_SHARE * np.linalg.norm(scaled):
        return float(np.inf)
    return float(slopes @ covariance @ slopes)


def _known_part(
    objective: Objective, theta: FloatArray, *, expected: bool
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the covariance within the identifiable directions, the others as columns, and the scale they are in."""
    rows, noise = objective.sensitivity(theta, expected=expected)
    information, spread = rows @ rows.T, rows @ noise @ rows.T
    scale = np.sqrt(np.diag(information))
    scale[scale == 0.0] = 1.0
    values, vectors = np.linalg.eigh(information / np.outer(scale, scale))
    known = values > RANK_TOLERANCE * values[-1]
    inverse = (vectors[:, known] / values[known]) @ vectors[:, known].T / np.outer(scale, scale)
    covariance: FloatArray = inverse @ spread @ inverse
    return 0.5 * (covariance + covariance.T), vectors[:, ~known], scale
