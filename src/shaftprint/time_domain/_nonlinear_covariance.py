"""Uncertainty of a fit whose noise is not the same all the time.

While a limit acts the governor does not answer, and disturbances grow as they do without one; and noise grows with the
load. A stationary noise model gives the right estimates all the same, but not their scatter. So the slope of the
likelihood is summed over blocks longer than the memory of the loop, and the scatter of these sums, not that of the
model, is taken for its variance: ``H^-1 (sum_b g_b g_b^T) H^-1`` (White, Maximum likelihood estimation of misspecified
models, 1982). Few blocks tell of a parameter that few steps show; a standard deviation is therefore never less than
that of the noise model.
"""

from dataclasses import replace

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.identify import Identification
from shaftprint.time_domain._output_error import OutputError

BLOCK_S = 4.0


def with_scatter_of_blocks(found: Identification) -> Identification:
    """Return a fit with standard deviations from the scatter of its slopes, where these are larger.

    Correlations stay those of the noise model.
    """
    objective = found.objective
    theta = found.values[list(objective.free)]
    rows, noise = objective.sensitivity(theta, expected=False)
    variance = noise @ noise.T
    for term in objective.terms:
        if isinstance(term, OutputError):
            own, _ = objective.sensitivity_to(term, theta, expected=False)
            sums = _block_slopes(term, theta[list(term.columns)])
            slopes = np.zeros((theta.size, sums.shape[1]))
            slopes[list(term.columns)] = sums
            variance = variance - own @ own.T + slopes @ slopes.T
    # parameters of one size, so that a well-known one does not make another look as if nothing were known of it
    length = np.linalg.norm(rows, axis=1)
    # the records may say nothing at all of a parameter, as of the integrator's way back from a limit that none met
    size = np.where(length > 0.0, length, 1.0)
    inverse = np.linalg.pinv((rows @ rows.T) / np.outer(size, size), hermitian=True) / np.outer(size, size)
    scatter = np.sqrt(np.maximum(np.diag(inverse @ variance @ inverse), 0.0))
    std = np.sqrt(np.diag(found.covariance))
    with np.errstate(divide="ignore", invalid="ignore"):
        factor = np.where(np.isfinite(std) & (std > 0.0), np.maximum(scatter / std, 1.0), 1.0)
    return replace(found, covariance=frozen_float(found.covariance * np.outer(factor, factor)))


def _block_slopes(term: OutputError, theta: FloatArray) -> FloatArray:
    """Return the slope of the likelihood along the free parameters of a record, block by block, (free, blocks)."""
    rows = term.rows(term.complete(theta))
    if rows is None:
        return np.zeros((theta.size, 1))
    length = len(term.structure.outputs) * max(round(BLOCK_S * term.record.rate_hz), 1)
    return np.asarray(np.add.reduceat(rows[1:] * rows[0], np.arange(0, rows.shape[1], length), axis=1))
