"""Covariance of the estimates from the exact gradients.

With weighted residuals of covariance ``V`` (the identity for likelihoods and for priors, ``W C W^T`` for other weights,
zero for rows that only regularise) the estimate's covariance is ``A^-1 B A^-1`` with ``A = J J^T`` and ``B = J V J^T``
(Huber, The behavior of maximum likelihood estimates under nonstandard conditions, 1967). For a likelihood it is
``A^-1``: the inverse of the observed information, which with known covariances and no bad lines is Fisher's.
"""

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.identify.fit._pseudo_inverse import PseudoInverse
from shaftprint.identify.likelihood._objective import Objective


def estimate_covariance(objective: Objective, theta: FloatArray, *, expected: bool = False) -> FloatArray:
    """Return the covariance of the free parameters, shape (free, free); infinite variances where nothing is known.

    ``theta``: free parameters at the optimum, shape (free,). ``expected``: whether to average over the noise instead of
    taking the data as they are: for a test that is planned.
    """
    covariance, information = known_covariance(objective, theta, expected=expected)
    lost = information.lost
    covariance[lost, lost] = np.inf
    return covariance


def variance_along(objective: Objective, theta: FloatArray, slopes: FloatArray, *, expected: bool = False) -> float:
    """Return the variance of a function of the free parameters to first order; infinite where the data do not fix it.

    It is finite for a product such as ``v K_p`` although neither factor is known alone.

    ``theta``: free parameters at the optimum, shape (free,). ``slopes``: derivatives of the function to the free
    parameters, shape (free,). ``expected``: see ``estimate_covariance``.
    """
    return known_variance(slopes, *known_covariance(objective, theta, expected=expected))


def known_variance(slopes: FloatArray, covariance: FloatArray, information: PseudoInverse) -> float:
    """Return ``variance_along`` from what ``known_covariance`` gives, which serves many functions."""
    return float(slopes @ covariance @ slopes) if information.knows(slopes) else float(np.inf)


def known_covariance(
    objective: Objective, theta: FloatArray, *, expected: bool = False
) -> tuple[FloatArray, PseudoInverse]:
    """Return the covariance within the identifiable directions, and which they are."""
    rows, noise = objective.sensitivity(theta, expected=expected)
    information = PseudoInverse.of(rows)
    half = information.inverse @ noise
    return half @ half.T, information
