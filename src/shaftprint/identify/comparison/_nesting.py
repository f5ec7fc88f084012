"""Does one structure hold another as a special case? Found out by letting it imitate the other.

The larger structure is fitted to the response of the smaller one, at the smaller one's optimum and at two places beside
it. Where nothing is left each time, the smaller lies within the larger. What the imitation looks like decides how a
likelihood ratio is distributed: a parameter that ends at a bound, or means nothing there, breaks the usual law.
"""

from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.distributions import chi_square_tail
from shaftprint.errors import IdentificationError
from shaftprint.identify.fit._fit_of import fit_of
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.likelihood._load_factors import load_factors
from shaftprint.identify.likelihood._objective import Objective
from shaftprint.identify.search._starts import GivenStarts
from shaftprint.spectra._frequency_response import FrequencyResponse

# Squared distance over the square of the response itself below which nothing is left.
SAME_RESPONSE = 1e-9
# Without noise the optimum is found from few starts.
STARTS = 20
# Places beside the optimum: shares of the way to the middle of the bounds.
BESIDE = (0.03, 0.1)
# Share of the width between its bounds within which a parameter stands at one.
AT_BOUND = 1e-5
# Scaled singular values below this share of the largest are none.
RANK_TOLERANCE = 1e-6
# A likelihood ratio below this is none: the larger structure has stopped where the smaller one is.
NO_GAIN = 1e-6
# Costs that differ by a smaller share are one.
ROUNDING = 1e-9


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Nesting:
    """How a larger structure holds a smaller one."""

    values: FloatArray
    """Free parameters of the larger structure that imitate the optimum of the smaller one, shape (free,)."""
    extra: int
    """How many parameters more the data could find; 0 where all that the larger structure has more is redundant."""
    at_bound: tuple[str, ...]
    """Parameters of the larger structure that end at a bound."""
    meaningless: tuple[str, ...]
    """Parameters of the larger structure that have no influence there."""

    def p_value(self, statistic: float) -> float:
        """Return the probability of a likelihood ratio that large or larger if the smaller structure holds.

        It holds where no parameter is meaningless and at most one of those that the larger structure has more stands
        at a bound: half of the weight then lies on one degree of freedom less.
        """
        if statistic <= NO_GAIN:
            return 1.0
        full = chi_square_tail(statistic, self.extra)
        if not self.at_bound:
            return full
        return 0.5 * full + (0.5 * chi_square_tail(statistic, self.extra - 1) if self.extra > 1 else 0.0)


def nesting(small: Identification, large: Identification, *, rng: np.random.Generator) -> Nesting | None:
    """Return how one fitted structure holds another; None where it does not.

    ``small``, ``large``: fits to the same data. ``rng``: source of the start values.
    """
    if len(small.parameters) >= len(large.parameters):
        return None
    imitation = _imitation(small, large, small.values, rng)
    if imitation is None or any(
        _imitation(small, large, neighbour, rng) is None for neighbour in _places_beside(small)
    ):
        return None
    objective = large.objective
    parameters = objective.free_parameters
    at_bound = np.minimum(imitation - objective.lower, objective.upper - imitation) < AT_BOUND * (
        objective.upper - objective.lower
    )
    optimum = large.values[list(objective.free)]
    lost = _lost(objective, imitation, optimum)
    # at a special place, such as a bound, fewer parameters have influence than elsewhere
    rank = max(_rank(objective, optimum), _rank(objective, imitation))
    return Nesting(
        values=frozen_float(imitation),
        extra=max(rank - _rank(small.objective, small.values[list(small.objective.free)]), 0),
        at_bound=tuple(p.name for p, there in zip(parameters, at_bound, strict=True) if there),
        meaningless=tuple(p.name for p, gone in zip(parameters, lost, strict=True) if gone),
    )


def no_worse(
    small: Identification, large: Identification, nested: Nesting, *, rng: np.random.Generator
) -> Identification:
    """Return the larger fit, or a lower one from where it imitates the smaller, if its own search missed that.

    Only what is known beforehand of its further parameters can make it cost more then.

    ``small``, ``large``: fits to the same data. ``nested``: how the larger holds the smaller. ``rng``: source of start
    values, of which none is drawn.
    """
    if large.cost <= small.cost * (1.0 + ROUNDING):
        return large
    pairs = [
        (experiment.structure, replace(experiment.response, used=experiment.fitted))
        for experiment in large.objective.experiments
    ]
    settings = replace(large.settings, starts=1, draw=GivenStarts(nested.values[None]))
    lower = fit_of(pairs, rng=rng, settings=settings)
    if lower.cost >= large.cost * (1.0 - ROUNDING):
        return large
    return replace(lower, settings=large.settings, clusters=(*lower.clusters, *large.clusters))


def _responses_of(identification: Identification, values: FloatArray) -> list[FrequencyResponse]:
    """Return the responses of the data with the model's in their place and the fitted lines used, all else the same.

    ``values``: all parameters of the fit, shape (parameters,).
    """
    responses = []
    for experiment in identification.objective.experiments:
        data = experiment.response
        model = experiment.structure.response(
            experiment.structure_values(values),
            1j * data.omega_rad_s,
            factors=load_factors(experiment.structure, data),
        )
        responses.append(replace(data, response=model.reshape(data.response.shape), used=experiment.fitted))
    return responses


def _places_beside(small: Identification) -> list[FloatArray]:
    objective = small.objective
    optimum = small.values[list(objective.free)]
    middle = 0.5 * (objective.lower + objective.upper)
    return [objective.complete(optimum + share * (middle - optimum)) for share in BESIDE]


def _imitation(
    small: Identification, large: Identification, values: FloatArray, rng: np.random.Generator
) -> FloatArray | None:
    """Return the free parameters with which the larger structure gives the smaller one's response; None if none do."""
    neutral = replace(
        large.settings, priors={}, regularisation={}, stability="ignored", starts=min(large.settings.starts, STARTS)
    )
    structures = [experiment.structure for experiment in large.objective.experiments]
    try:
        fit = fit_of(list(zip(structures, _responses_of(small, values), strict=True)), rng=rng, settings=neutral)
    except IdentificationError:
        # more free parameters than data: without its priors the larger structure cannot be fitted
        return None
    null_cost = fit.objective.null_cost
    return fit.values[list(fit.objective.free)] if fit.cost < SAME_RESPONSE * null_cost else None


def _slopes(objective: Objective, theta: FloatArray) -> FloatArray:
    """Return the derivatives of the residuals of the data, shape (free, rows)."""
    rows = objective.prior_rows.shape[0]
    _, slopes = objective.residuals(theta[None, :])
    return slopes[0, :, : slopes.shape[2] - rows]


def _rank(objective: Objective, theta: FloatArray) -> int:
    """Return how many combinations of the free parameters the data can find."""
    slopes = _slopes(objective, theta)
    scale = np.linalg.norm(slopes, axis=1)
    scaled = slopes / np.where(scale > 0.0, scale, 1.0)[:, None]
    sizes = np.linalg.svd(scaled, compute_uv=False)
    return int(np.sum(sizes > RANK_TOLERANCE * sizes[0]))


def _lost(objective: Objective, theta: FloatArray, optimum: FloatArray) -> FloatArray:
    """Return which parameters have influence at the larger structure's own optimum but none at the imitation."""
    here = np.linalg.norm(_slopes(objective, theta), axis=1)
    there = np.linalg.norm(_slopes(objective, optimum), axis=1)
    return np.asarray(here < RANK_TOLERANCE * there)
