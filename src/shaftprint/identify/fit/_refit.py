"""Fit many responses of one test at once, each from a known start: for a parametric bootstrap or a fleet of repeats.

The responses share lines, covariance, weights and priors' standard deviations with the identification, so only the data
and the priors' means differ: the model is evaluated for many repeats in the same array operations, as it is for the
starts of one search.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import cast

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arrays import BoolArray, ComplexArray, FloatArray, IntArray, frozen_bool, frozen_float
from shaftprint.errors import IdentificationError
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.likelihood._experiment import Experiment, ResponseRepeats
from shaftprint.identify.likelihood._objective import Objective, Redrawn
from shaftprint.identify.search._levenberg_marquardt import Descent, descend

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


def refit(
    identification: Identification,
    responses: ArrayLike | Sequence[ArrayLike],
    *,
    start: ArrayLike | None = None,
    prior_means: ArrayLike | None = None,
    covariances: ArrayLike | Sequence[ArrayLike] | None = None,
) -> Refits:
    """Fit the identified structures to other responses of the same test, each from one start.

    Bounds, degrees of freedom and the standard deviations of priors are the identification's. Nothing is judged for
    stability.

    Parameters
    ----------
    responses
        Responses at all lines of the identification's response, shape (repeats, channels, lines), one repeat or more;
        with one input the channels are the outputs. For a joint fit a sequence of such arrays, one an experiment.
    start
        Start values of the free parameters, shape (free,) or (repeats, free); the identified ones when not given.
    prior_means
        Means of priors and regularisation, in the order of ``Objective.prior_rows``, shape (repeats, prior rows); the
        identification's when not given. Where repeats are drawn to learn the spread of the estimates, what a prior adds
        to it is in them only if its mean is drawn too.
    covariances
        Covariances of [Re, Im] at all lines, shape (repeats, lines, 2 channels, 2 channels), for a joint fit one an
        experiment; the identification's when not given. What an estimated covariance adds to the spread is in repeats
        only if it is drawn too.

    Raises
    ------
    IdentificationError
        If a shape does not fit, a value is not finite, or not all data are frequency responses.
    """
    objective = identification.objective
    if objective.others:
        raise IdentificationError(
            f"refit of {objective.name}: {objective.others[0].name} is no frequency response; identify anew, or draw "
            "repeats with bootstrap()."
        )
    measured = _measured(objective, responses)
    repeats = measured[0].shape[0]
    weights = _weights(objective, covariances, repeats)
    redrawn = Redrawn(
        repeats=tuple(ResponseRepeats(measured=m, weights=w) for m, w in zip(measured, weights, strict=True)),
        prior_means=_prior_means(objective, prior_means, repeats),
    )
    return refit_redrawn(identification, redrawn, _starts(identification, start, repeats=repeats))


def refit_redrawn(identification: Identification, redrawn: Redrawn, theta: FloatArray) -> Refits:
    """Fit the identified structures to other data of any kind.

    ``redrawn``: the data. ``theta``: start values of the free parameters, shape (repeats, free).
    """
    objective = identification.objective
    limit = identification.settings.max_iterations
    blocks = [slice(i, i + BLOCK) for i in range(0, theta.shape[0], BLOCK)]
    refits = [_descended(objective, redrawn.chosen(block), theta[block], limit) for block in blocks]
    return Refits(
        names=tuple(p.name for p in objective.free_parameters),
        values=frozen_float(np.concatenate([descent.theta for descent in refits])),
        cost=frozen_float(np.concatenate([descent.cost for descent in refits])),
        converged=frozen_bool(np.concatenate([descent.converged for descent in refits])),
    )


def _measured(objective: Objective, responses: ArrayLike | Sequence[ArrayLike]) -> tuple[ComplexArray, ...]:
    """Return the fitted lines of every experiment's responses."""
    arrays = _an_experiment_each("responses", objective, responses)
    responses_of = tuple(_of_experiment(e, values) for e, values in zip(objective.experiments, arrays, strict=True))
    repeats = [measured.shape[0] for measured in responses_of]
    if len(set(repeats)) > 1:
        raise IdentificationError(
            f"responses: expected the same number of repeats of every experiment, found {', '.join(map(str, repeats))}."
        )
    return responses_of


def _an_experiment_each(
    name: str, objective: Objective, one_or_all: ArrayLike | Sequence[ArrayLike]
) -> list[ArrayLike]:
    count = len(objective.experiments)
    arrays = [cast("ArrayLike", one_or_all)] if count == 1 else list(cast("Sequence[ArrayLike]", one_or_all))
    if len(arrays) != count:
        raise IdentificationError(f"{name}: expected {count} arrays, one an experiment, found {len(arrays)}.")
    return arrays


def _weights(
    objective: Objective, covariances: ArrayLike | Sequence[ArrayLike] | None, repeats: int
) -> tuple[FloatArray | None, ...]:
    """Return the weights of every experiment's fitted lines in every repeat."""
    if covariances is None:
        return (None,) * len(objective.experiments)
    arrays = _an_experiment_each("covariances", objective, covariances)
    weights = []
    for experiment, values in zip(objective.experiments, arrays, strict=True):
        covariance = np.asarray(values, dtype=np.float64)
        size = experiment.data.shape[1]
        expected = (repeats, experiment.fitted.size, size, size)
        if covariance.shape != expected:
            raise IdentificationError(f"covariances: expected shape {expected}, found {covariance.shape}.")
        weights.append(experiment.weighting.matrices(experiment.response, covariance[:, experiment.fitted]))
    return tuple(weights)


def _of_experiment(experiment: Experiment, responses: ArrayLike) -> ComplexArray:
    measured = np.asarray(responses, dtype=np.complex128)
    channels, lines = len(experiment.structure.channels), experiment.fitted.size
    if measured.ndim != 3 or measured.shape[1:] != (channels, lines) or not measured.size:
        raise IdentificationError(
            f"responses: expected shape (repeats, {channels} channels, {lines} lines), found {measured.shape}."
        )
    finite = np.isfinite(measured[:, :, experiment.fitted]).all(axis=(1, 2))
    if not finite.all():
        raise IdentificationError(
            f"responses: found values that are not finite, first in repeat {np.argmin(finite)}; leave it out."
        )
    return measured[:, :, experiment.fitted]


def _prior_means(objective: Objective, prior_means: ArrayLike | None, repeats: int) -> FloatArray:
    stated = objective.prior_rows[:, 1]
    means = (
        np.broadcast_to(stated, (repeats, stated.size)) if prior_means is None else np.asarray(prior_means, dtype=float)
    )
    if means.shape != (repeats, stated.size) or not np.all(np.isfinite(means)):
        raise IdentificationError(
            f"prior_means: expected finite values of shape ({repeats} repeats, {stated.size} prior rows), found shape "
            f"{means.shape}."
        )
    return means


def _starts(identification: Identification, start: ArrayLike | None, *, repeats: int) -> FloatArray:
    free = identification.values[list(identification.objective.free)]
    starts = free if start is None else np.asarray(start, dtype=np.float64)
    if starts.shape not in (free.shape, (repeats, free.size)):
        raise IdentificationError(
            f"start: expected {free.size} values, or {repeats} rows of them, one a repeat, found shape {starts.shape}."
        )
    return np.broadcast_to(starts, (repeats, free.size))


def _descended(objective: Objective, redrawn: Redrawn, theta: FloatArray, limit: int) -> Descent:
    def residuals(trial: FloatArray, repeats: IntArray) -> tuple[FloatArray, FloatArray]:
        return objective.residuals(trial, redrawn.chosen(repeats))

    return descend(residuals, theta, objective.lower, objective.upper, tolerance=TOLERANCE, max_iterations=limit)
