"""Fit many responses of one test at once, each from a known start: for a parametric bootstrap or a fleet of repeats.

The responses share lines, covariance and weights with the identification, so only the data differ. With the weighted
residual ``r = W (y - f(theta))`` of the identification's data ``y``, repeat ``k`` has ``r_k = r + W (y_k - y)``: the
model is evaluated for many repeats in the same array operations, as it is for the starts of one search.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arrays import (
    BoolArray,
    ComplexArray,
    FloatArray,
    IntArray,
    frozen_bool,
    frozen_float,
)
from shaftprint.errors import IdentificationError
from shaftprint.identify._identification import Identification
from shaftprint.identify._levenberg_marquardt import Descent, descend
from shaftprint.identify._objective import Objective

# A repeat is done when a further step promises less than this share of its cost: below 1e-3 standard deviations.
TOLERANCE = 1e-8
# Repeats that go through the array operations together: few enough for the processor's cache.
BLOCK = 512


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Refits:
    """What the fits of many responses gave, one row a repeat."""

    names: tuple[str, ...]
    """Names of the free parameters, in the order of the columns of ``values``."""
    values: FloatArray
    """Free parameters, each in its own unit, shape (repeats, free)."""
    cost: FloatArray
    """Half the sum of squared weighted residuals and prior rows, shape (repeats,)."""
    converged: BoolArray
    """Whether the fit settled within the iterations that the identification's settings allow, shape (repeats,)."""


def refit(identification: Identification, responses: ArrayLike, *, start: ArrayLike | None = None) -> Refits:
    """Fit the identified structure to other responses of the same test, each from one start.

    Weights, priors and bounds are the identification's. A prior keeps its mean, so where repeats are drawn to learn the
    spread of the estimates, what the prior adds to it is not in them. Nothing is judged for stability.

    Parameters
    ----------
    responses
        Responses at all lines of the identification's response, shape (repeats, outputs, lines); one repeat or more.
    start
        Start values of the free parameters, shape (free,) or (repeats, free); the identified ones when not given.

    Raises
    ------
    IdentificationError
        If a shape does not fit or a value is not finite.
    """
    objective = identification.objective
    measured = np.asarray(responses, dtype=np.complex128)
    expected = (len(identification.response.outputs), identification.response.frequency_hz.size)
    if measured.ndim != 3 or measured.shape[1:] != expected or not measured.size:
        raise IdentificationError(
            f"responses: expected shape (repeats, {expected[0]} outputs, {expected[1]} lines), found {measured.shape}."
        )
    finite = np.isfinite(measured).all(axis=(1, 2))
    if not finite.all():
        raise IdentificationError(
            f"responses: found values that are not finite, first in repeat {np.argmin(finite)}; leave it out."
        )
    shift = _shift(objective, measured[:, :, identification.fitted])
    theta = _starts(identification, start, repeats=measured.shape[0])
    limit = identification.settings.max_iterations
    blocks = [slice(i, i + BLOCK) for i in range(0, measured.shape[0], BLOCK)]
    found = [_descended(objective, shift[block], theta[block], limit) for block in blocks]
    return Refits(
        names=tuple(p.name for p in objective.structure.free),
        values=frozen_float(np.concatenate([descent.theta for descent in found])),
        cost=frozen_float(np.concatenate([descent.cost for descent in found])),
        converged=frozen_bool(np.concatenate([descent.converged for descent in found])),
    )


def _shift(objective: Objective, measured: ComplexArray) -> FloatArray:
    """Return ``W (y_k - y)`` of every repeat in the order of the residuals, zero in the prior rows."""
    parts = np.concatenate([measured.real, measured.imag], axis=1) - objective.data.T
    weighted = np.einsum("fab,kbf->kaf", objective.weights, parts).reshape(parts.shape[0], -1)
    return np.pad(weighted, ((0, 0), (0, objective.prior_rows.shape[0])))


def _starts(identification: Identification, start: ArrayLike | None, *, repeats: int) -> FloatArray:
    free = identification.values[list(identification.objective.free)]
    given = free if start is None else np.asarray(start, dtype=np.float64)
    if given.shape not in (free.shape, (repeats, free.size)):
        raise IdentificationError(
            f"start: expected {free.size} values, or {repeats} rows of them, one a repeat, found shape {given.shape}."
        )
    return np.broadcast_to(given, (repeats, free.size))


def _descended(objective: Objective, shift: FloatArray, theta: FloatArray, limit: int) -> Descent:
    def residuals(trial: FloatArray, repeats: IntArray) -> tuple[FloatArray, FloatArray]:
        r, jacobian = objective.residuals(trial)
        return r + shift[repeats], jacobian

    return descend(residuals, theta, objective.lower, objective.upper, tolerance=TOLERANCE, max_iterations=limit)
