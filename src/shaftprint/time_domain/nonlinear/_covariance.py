"""Uncertainty of a fit whose noise is not the same all the time.

While a limit acts the governor does not answer, and disturbances grow as they do without one; and noise grows with the
load. A stationary noise model gives the right estimates all the same, but not their scatter. So the slope of the
likelihood is summed over clusters longer than the memory of the loop, and the scatter of these sums, not that of the
model, is taken for its variance: ``H^-1 (sum_b g_b g_b^T) H^-1`` (White, Maximum likelihood estimation of misspecified
models, 1982).

Clusters are blocks of seconds, and windows: uninterrupted stretches of records, within which the load and what else
moves slowly is one (Liang and Zeger, Longitudinal data analysis using generalized linear models, 1986). The larger of
both deviations counts: a staircase of minutes is a single window, whose one sum says nothing, and the blocks of a
window err alike. Few clusters tell of a parameter that few steps show; a standard deviation is therefore never less
than that of the noise model.
"""

from collections.abc import Callable
from dataclasses import replace
from typing import TypeAlias

import numpy as np

from shaftprint.arrays import FloatArray, IntArray, frozen_float
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.fit._pseudo_inverse import PseudoInverse
from shaftprint.time_domain._output_error import OutputError

BLOCK_S = 4.0
Clusters: TypeAlias = Callable[[OutputError], IntArray]


def with_scatter_of_blocks(fit: Identification) -> Identification:
    """Return a fit with standard deviations from the scatter of its slopes, where these are larger.

    Correlations stay those of the noise model.
    """
    scatter = np.maximum(_scatter(fit, _blocks), _scatter(fit, _windows))
    std = np.sqrt(np.diag(fit.covariance))
    with np.errstate(divide="ignore", invalid="ignore"):
        factor = np.where(np.isfinite(std) & (std > 0.0), np.maximum(scatter / std, 1.0), 1.0)
    return replace(fit, covariance=frozen_float(fit.covariance * np.outer(factor, factor)))


def _scatter(fit: Identification, clusters: Clusters) -> FloatArray:
    """Return standard deviations of the free parameters from the scatter of slopes by cluster, shape (free,)."""
    objective = fit.objective
    theta = fit.values[list(objective.free)]
    rows, noise = objective.sensitivity(theta, expected=False)
    variance = noise @ noise.T
    for term in objective.terms:
        if isinstance(term, OutputError):
            rows_of_term, _ = objective.sensitivity_to(term, theta, expected=False)
            sums = _cluster_slopes(term, theta[list(term.columns)], clusters(term))
            slopes = np.zeros((theta.size, sums.shape[1]))
            slopes[list(term.columns)] = sums
            variance = variance - rows_of_term @ rows_of_term.T + slopes @ slopes.T
    # the records may say nothing at all of a parameter, as of the integrator's way back from a limit that none met
    inverse = PseudoInverse.of(rows).inverse
    return np.asarray(np.sqrt(np.maximum(np.diag(inverse @ variance @ inverse), 0.0)))


def _blocks(term: OutputError) -> IntArray:
    """Return the first counted sample of each block of seconds, shape (blocks,)."""
    length = max(round(BLOCK_S * term.record.rate_hz), 1)
    return np.arange(0, int(term.record.used.sum()), length)


def _windows(term: OutputError) -> IntArray:
    """Return the first counted sample of each uninterrupted stretch, shape (stretches,)."""
    lengths = [stretch.stop - stretch.start for stretch in term.record.stretches]
    return np.concatenate([[0], np.cumsum(lengths)[:-1]]).astype(np.int64)


def _cluster_slopes(term: OutputError, theta: FloatArray, first: IntArray) -> FloatArray:
    """Return the slope of the likelihood along the free parameters of a record by cluster, shape (free, clusters)."""
    rows = term.rows(term.complete(theta))
    if rows is None:
        return np.zeros((theta.size, 1))
    return np.asarray(np.add.reduceat(rows[1:] * rows[0], first * len(term.structure.outputs), axis=1))
