"""Parametric bootstrap: what the same test would give if it were made again and again.

Responses are drawn from the fitted model with the measured covariance of their noise, the means of priors from their
normal distributions around the fitted values, and covariances that were estimated from few samples anew too; each draw
is fitted from the optimum (Efron and Tibshirani, An Introduction to the Bootstrap, 1993, sections 6.5, 10.2, 13.3). The
spread holds what the linearised covariance leaves out: the curvature of the model, and bounds. Draws that would have
found another optimum of the search are not in it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.errors import IdentificationError
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.fit._refit import refit_redrawn
from shaftprint.identify.likelihood._objective import Redrawn
from shaftprint.identify.uncertainty._numbers import Numbers, all_numbers
from shaftprint.models._combination import Combination

# Percentiles of an interval of 95 % coverage.
TAILS_PERCENT = (2.5, 97.5)
FEWEST = 2


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Bootstrap:
    """Spread of estimates over simulated repeats of a test."""

    names: tuple[str, ...]
    """Names of the free parameters, in the order of the columns of ``values``."""
    values: FloatArray
    """Free parameters of each repeat whose fit settled, shape (repeats, free)."""
    failed_share: float
    """Share of the repeats whose fit did not settle; they are left out."""
    estimates: Mapping[str, Estimate]
    """Every free parameter, combination and further number, by name, with the standard deviation over the repeats and
    the interval from their 2.5 % and 97.5 % points; one that is infinite in a repeat is left out."""
    bias: Mapping[str, float]
    """Mean over the repeats minus the estimate from which they were drawn, by name."""

    def basic_95(self, name: str) -> tuple[float, float]:
        """Return the interval reflected at the estimate: repeats scatter about it as it scatters about the truth."""
        one = self.estimates[name]
        lower, upper = one.interval_95 or one.limits_95
        return 2.0 * one.value - upper, 2.0 * one.value - lower


def bootstrap(
    identification: Identification, numbers: Sequence[Combination] = (), *, count: int, rng: np.random.Generator
) -> Bootstrap:
    """Return the spread of the estimates over simulated repeats of the test.

    Parameters
    ----------
    numbers
        Further numbers that follow from the parameters; their formulas take and give arrays.
    count
        Number of repeats, two or more; a thousand for intervals, a hundred for standard deviations.
    rng
        Source of the noise.

    Raises
    ------
    IdentificationError
        If there are fewer than two repeats, data cannot be drawn anew, or fewer than two of the fits settled.
    """
    if count < FEWEST:
        raise IdentificationError(f"bootstrap: expected {FEWEST} repeats or more, found {count}.")
    objective = identification.objective
    repeats = tuple(term.redrawn(identification.values, count, rng) for term in objective.terms)
    redrawn = Redrawn(repeats=repeats, prior_means=_prior_means(identification, count, rng))
    free = identification.values[list(objective.free)]
    refits = refit_redrawn(identification, redrawn, np.broadcast_to(free, (count, free.size)))
    settled = refits.values[refits.converged]
    if settled.shape[0] < FEWEST:
        raise IdentificationError(
            f"bootstrap of {objective.name}: expected two fits or more that settle, found {settled.shape[0]} of "
            f"{count}; allow more iterations, or hold a parameter that the test does not know."
        )
    estimates, bias = _estimates(identification, numbers, settled)
    return Bootstrap(
        names=refits.names,
        values=frozen_float(settled),
        failed_share=1.0 - settled.shape[0] / count,
        estimates=estimates,
        bias=bias,
    )


def _prior_means(identification: Identification, count: int, rng: np.random.Generator) -> FloatArray:
    """Return means of the prior rows, shape (repeats, rows): drawn around the fitted value where they are knowledge."""
    objective = identification.objective
    free = identification.values[list(objective.free)]
    index, means, inverse_std = objective.prior_rows.T
    counts = objective.prior_counts == 1.0
    noise = rng.standard_normal((count, means.size)) / inverse_std
    return np.asarray(np.where(counts, free[index.astype(int)] + noise, means))


def _estimates(
    identification: Identification, numbers: Sequence[Combination], settled: FloatArray
) -> tuple[dict[str, Estimate], dict[str, float]]:
    objective = identification.objective
    combinations = (*objective.combinations, *numbers)
    best = identification.values[list(objective.free)]
    units = [*(p.unit for p in objective.free_parameters), *(c.unit for c in combinations)]
    estimates, bias = {}, {}
    for index, (name, unit) in enumerate(zip(all_numbers(objective, numbers), units, strict=True)):
        number = Numbers(objective, combinations, np.full(settled.shape[0], index))
        values = number.values(settled)
        value = float(number.chosen(np.zeros(1, dtype=np.int64)).values(best[None, :])[0])
        if not (np.isfinite(value) and np.isfinite(values).all()):
            continue
        low, high = (float(end) for end in np.percentile(values, TAILS_PERCENT))
        bias[name] = float(np.mean(values)) - value
        estimates[name] = Estimate(
            name=name,
            unit=unit,
            value=value,
            std=float(np.std(values, ddof=1)),
            interval_95=(low, high),
        )
    return estimates, bias
