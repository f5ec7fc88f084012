"""Likelihood-ratio test of a structure within a larger one.

Twice the gain of the log-likelihood is a chi-square with as many degrees of freedom as the larger structure has
parameters more (Wilks, The large-sample distribution of the likelihood ratio, 1938). Where one of them stands at a
bound, such as a delay of 0, half of its weight lies on one degree less (Self and Liang, Asymptotic properties of
maximum likelihood estimators under nonstandard conditions, 1987, case 5). Where a parameter means nothing in the
smaller structure (Davies, Hypothesis testing when a nuisance parameter is present only under the alternative, 1977),
several stand at bounds, what the larger one has more is redundant, or the cost is not that of maximum likelihood, no
law is at hand: then tests are drawn from the smaller structure and both are fitted to each.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.distributions import chi_square_tail
from shaftprint.identify.comparison._nesting import NO_GAIN, Nesting
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.fit._refit import refit
from shaftprint.identify.likelihood._weighting import MaximumLikelihood
from shaftprint.identify.search._spread import spread

_Array = TypeVar("_Array", FloatArray, ComplexArray)

DRAWS = 199
# A bound on the p-value this much below the smallest that draws can give needs no draws.
FAR = 0.1
# More values than these of a parameter make no difference to a response.
VALUES = 1000
# Starts of the larger structure in each draw where a parameter means nothing or stands at a bound.
PLACES = 6
# How far from its bound such a start stands, as a share of the width.
OFF_BOUND = 0.05


@dataclass(frozen=True, kw_only=True, slots=True)
class LikelihoodRatio:
    """What the parameters that a larger structure has more are worth."""

    small: str
    """Name of the smaller structure."""
    large: str
    """Name of the larger structure."""
    statistic: float
    """Fall of the deviance from the smaller to the larger structure."""
    extra: int
    """How many parameters more the larger one has for the data to find."""
    p_value: float
    """Probability of such a fall or a larger one if the smaller structure holds."""
    draws: int
    """Number of drawn tests that the p-value comes from; 0 where it comes from the law or a bound of it."""
    reason: str
    """Why the law does not hold as it is; empty where it does. Without draws the p-value is then an upper bound."""


def likelihood_ratio(
    small: Identification, large: Identification, nested: Nesting, *, rng: np.random.Generator, draws: int = DRAWS
) -> LikelihoodRatio:
    """Return the test of a structure against a larger one that holds it.

    ``small``, ``large``: fits to the same data. ``nested``: how the larger holds the smaller. ``rng``: source of the
    draws. ``draws``: number of tests to draw where no law is at hand; the smallest p-value is ``1 / (draws + 1)``.
    """
    fall = _deviance(small, np.array(small.cost)) - _deviance(large, np.array(large.cost))
    statistic = float(np.maximum(fall, 0.0))
    reason = _no_law(small, large, nested)
    at_most = _at_most(large, nested, statistic)
    if not reason or (nested.extra == 0 and statistic <= NO_GAIN):
        p_value, drawn = nested.p_value(statistic), 0
    elif at_most < FAR / (draws + 1.0):
        p_value, drawn = at_most, 0
    else:
        reached = _drawn(small, large, nested, rng, draws) >= statistic
        p_value, drawn = (1.0 + float(reached.sum())) / (draws + 1.0), draws
    return LikelihoodRatio(
        small=small.structure.name,
        large=large.structure.name,
        statistic=statistic,
        extra=nested.extra,
        p_value=p_value,
        draws=drawn,
        reason=reason,
    )


def _no_law(small: Identification, large: Identification, nested: Nesting) -> str:
    """Return why the law does not hold as it is, in words; nothing where it does."""
    if not isinstance(large.settings.weighting, MaximumLikelihood):
        return "the fits are not weighted by maximum likelihood"
    if nested.meaningless:
        return f"{', '.join(nested.meaningless)} means nothing in {small.structure.name}"
    if nested.extra == 0:
        return "the data find no parameter more"
    small_names = {p.name for p in small.structure.free}
    with_prior = [name for name in large.settings.priors if name not in small_names]
    if with_prior:
        return f"there is a prior for {', '.join(with_prior)}"
    if len(nested.at_bound) > 1 or small_names & set(nested.at_bound):
        return f"{', '.join(nested.at_bound)} stand at a bound in {small.structure.name}"
    return ""


def _at_most(large: Identification, nested: Nesting, statistic: float) -> float:
    """Return an upper bound of the p-value; 1 where none is known.

    A chi-square with a degree of freedom more for every bound exceeds the statistic, and a prior only
    holds it down. Where a parameter is meaningless the statistic is the largest of as many as it has values that make a
    difference; no response has a thousand of them.
    """
    if not isinstance(large.settings.weighting, MaximumLikelihood):
        return 1.0
    priors = sum(1 for name in large.settings.priors if name in {p.name for p in large.objective.free_parameters})
    freedom = nested.extra + len(nested.at_bound) + len(nested.meaningless) + priors
    if freedom == 0:
        return 1.0
    tail = chi_square_tail(statistic, freedom)
    return tail * float(VALUES ** len(nested.meaningless))


def _deviance(fit: Identification, cost: FloatArray) -> FloatArray:
    return 2.0 * cost if fit.is_likelihood else fit.data_count * np.log(2.0 * cost / fit.data_count)


def _drawn(
    small: Identification, large: Identification, nested: Nesting, rng: np.random.Generator, draws: int
) -> FloatArray:
    """Return the statistic of tests drawn from the smaller structure, shape (draws,)."""
    experiments = small.objective.experiments
    drawn = [experiment.drawn(small.values, draws, rng) for experiment in experiments]
    estimated = any(bool(np.isfinite(experiment.freedom).any()) for experiment in experiments)
    luck = rng.standard_normal((draws, len(small.objective.parameters) + len(large.objective.parameters)))
    names = list(dict.fromkeys((*small.objective.names, *large.objective.names)))
    noise = {name: luck[:, i] for i, name in enumerate(names)}
    theta = small.values[list(small.objective.free)]
    few = refit(
        small,
        _one_or_all([responses for responses, _ in drawn]),
        prior_means=_prior_means(small, theta, noise, small_names=set(noise)),
        covariances=_one_or_all([covariances for _, covariances in drawn]) if estimated else None,
    ).cost
    means = _prior_means(large, nested.values, noise, small_names=set(small.objective.names))
    starts = _starts(large, nested)
    many = refit(
        large,
        _one_or_all([np.tile(responses, (len(starts), 1, 1)) for responses, _ in drawn]),
        start=np.repeat(starts, draws, axis=0),
        prior_means=np.tile(means, (len(starts), 1)),
        covariances=_one_or_all([np.tile(covariances, (len(starts), 1, 1, 1)) for _, covariances in drawn])
        if estimated
        else None,
    ).cost.reshape(len(starts), draws)
    lowest = np.minimum(many.min(axis=0), few)
    return np.maximum(_deviance(small, few) - _deviance(large, lowest), 0.0)


def _one_or_all(arrays: Sequence[_Array]) -> _Array | Sequence[_Array]:
    """Return what ``refit`` takes: the array of the one experiment, or one of each."""
    return arrays[0] if len(arrays) == 1 else arrays


def _prior_means(
    fit: Identification, theta: FloatArray, noise: dict[str, FloatArray], small_names: set[str]
) -> FloatArray:
    """Return prior means drawn about the values of the smaller structure, where it has the parameter."""
    objective = fit.objective
    draws = next(iter(noise.values())).size
    means = np.tile(objective.prior_rows[:, 1], (draws, 1))
    for row, (column, _, weight) in enumerate(objective.prior_rows):
        name = objective.free_parameters[int(column)].name
        if objective.prior_counts[row] and name in small_names:
            means[:, row] = theta[int(column)] + noise[name] / weight
    return means


def _starts(large: Identification, nested: Nesting) -> FloatArray:
    """Return places from which the larger structure is fitted to each draw: its own optimum and about the imitation.

    Shape (places, free).
    """
    objective = large.objective
    optimum = large.values[list(objective.free)]
    lower, upper = objective.lower, objective.upper
    names = [p.name for p in objective.free_parameters]
    loose = [names.index(name) for name in nested.meaningless]
    held = [names.index(name) for name in nested.at_bound]
    starts = np.stack([optimum, nested.values])
    if not loose and not held:
        return starts
    places = np.tile(nested.values, (PLACES, 1))
    places[:, loose] = spread(PLACES, lower, upper)[:, loose]
    inside = OFF_BOUND * (upper - lower)
    places[:, held] = np.clip(places, lower + inside, upper - inside)[:, held]
    return np.concatenate([starts, places])
