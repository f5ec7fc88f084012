"""The search from many starts: straight down, and for data of hardly any noise down in steps.

Weights of a covariance that is tiny beside the response make narrow, curved valleys with steep walls, in which a search
stops far from the optimum, or never finds the right one. Then the search goes down a second time: with a covariance as
if every value were known to 10 % only, then to 1 %, and so on to the true one, from what was best before. Of both ends
of a start the lower one counts.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import IdentificationError
from shaftprint.identify.likelihood._objective import Objective
from shaftprint.identify.search._levenberg_marquardt import Allowed, Descent, descend
from shaftprint.identify.search._settings import Settings
from shaftprint.identify.search._stability_border import border_minimum, stable_models
from shaftprint.identify.search._starts import LatinHypercube

# Standard deviations below this share of their values are those of hardly any noise.
HARDLY_ANY_NOISE = 1e-4
FIRST_FLOOR, FLOOR_STEP = 0.1, 0.1
# So many starts go all the way down in steps: the best at the first one.
CHOSEN = 10
# An unstable start is drawn again so many times.
REDRAWS = 50
# A start whose simulation runs away is drawn again so many times: each costs a simulation.
SIMULATED_REDRAWS = 10


def search(objective: Objective, settings: Settings, rng: np.random.Generator) -> Descent:
    """Return where each start of a search ended.

    ``settings``: how to search. ``rng``: source of the start values. Raises IdentificationError if stability is asked
    for during the search and no stable start is found.
    """
    allowed = stable_models(objective) if settings.stability == "during" else None
    start = _starts(objective, settings, rng, allowed)
    descent = _descended(objective, start, settings, allowed)
    floors = tuple(_floors(objective))
    if floors:
        descent = _lower(descent, _in_steps(objective, start, floors, settings, allowed))
    return descent if allowed is None else _lower(descent, border_minimum(objective, descent, settings, allowed))


def polish(objective: Objective, theta: FloatArray, settings: Settings) -> Descent:
    """Return an optimum as exactly as the leader is asked for; a stable one where that is asked for.

    ``theta``: free parameters near it, shape (free,).
    """
    allowed = stable_models(objective) if settings.stability == "during" else None
    return descend(
        objective.following(1),
        theta[None, :],
        objective.lower,
        objective.upper,
        tolerance=settings.leader_tolerance,
        max_iterations=settings.max_iterations,
        allowed=allowed,
    )


def _starts(objective: Objective, settings: Settings, rng: np.random.Generator, allowed: Allowed | None) -> FloatArray:
    """Return start values; unstable ones are drawn again where stability is asked for."""
    lower, upper = objective.lower, objective.upper
    start = settings.draw.starts(lower, upper, settings.starts, rng)
    if allowed is None:
        return _evaluable(objective, start, allowed, rng)
    for _ in range(REDRAWS):
        unstable = ~allowed(start)
        count = int(unstable.sum())
        if not count:
            return _evaluable(objective, start, allowed, rng)
        start[unstable] = settings.draw.starts(lower, upper, count, rng)
    stable = allowed(start)
    if not stable.any():
        raise IdentificationError(
            f"structure {objective.name}: none of {settings.starts * REDRAWS} drawn starts is a stable model; check "
            "the bounds, or allow unstable models."
        )
    return np.asarray(start[stable][np.arange(settings.starts) % int(stable.sum())])


def _evaluable(
    objective: Objective, start: FloatArray, allowed: Allowed | None, rng: np.random.Generator
) -> FloatArray:
    """Return the starts, those at which a term cannot be evaluated drawn again.

    There a simulation has run away and knows no slope, so that the start would stay where it is.
    """
    lost = np.flatnonzero(~objective.evaluable(start))
    for _ in range(SIMULATED_REDRAWS if start.shape[0] > 1 else 0):
        if not lost.size:
            break
        drawn = LatinHypercube().starts(objective.lower, objective.upper, lost.size, rng)
        good = objective.evaluable(drawn) & (True if allowed is None else allowed(drawn))
        start[lost[good]] = drawn[good]
        lost = lost[~good]
    return start


def _descended(objective: Objective, start: FloatArray, settings: Settings, allowed: Allowed | None) -> Descent:
    return descend(
        objective.following(start.shape[0]),
        start,
        objective.lower,
        objective.upper,
        tolerance=settings.tolerance,
        max_iterations=settings.max_iterations,
        leader_tolerance=settings.leader_tolerance,
        allowed=allowed,
    )


def _floors(objective: Objective) -> Iterator[float]:
    """Yield the floors of the standard deviations to go down by; none where the noise is no less than usual."""
    least = min((term.least_deviation for term in objective.terms if term.is_likelihood), default=HARDLY_ANY_NOISE)
    floor = FIRST_FLOOR
    while least < HARDLY_ANY_NOISE and floor > least:
        yield floor
        floor *= FLOOR_STEP


def _in_steps(
    objective: Objective, start: FloatArray, floors: tuple[float, ...], settings: Settings, allowed: Allowed | None
) -> Descent:
    """Return where the best starts end when the covariance comes down to the true one in steps; infinite costs else."""
    first = _descended(_with_floor(objective, floors[0]), start, settings, allowed)
    best = np.argsort(first.cost, kind="stable")[:CHOSEN]
    theta = first.theta[best]
    for floor in floors[1:]:
        theta = _descended(_with_floor(objective, floor), theta, settings, allowed).theta
    last = _descended(objective, theta, settings, allowed)
    descent = replace(first, cost=np.full(first.cost.size, np.inf))
    for name in ("theta", "cost", "converged", "refused", "information"):
        getattr(descent, name)[best] = getattr(last, name)
    return descent


def _with_floor(objective: Objective, floor: float) -> Objective:
    return replace(objective, terms=tuple(term.with_floor(floor) for term in objective.terms))


def _lower(one: Descent, other: Descent) -> Descent:
    """Return for each start the lower of two ends."""
    better = other.cost < one.cost
    return Descent(
        theta=np.where(better[:, None], other.theta, one.theta),
        cost=np.where(better, other.cost, one.cost),
        iterations=one.iterations + other.iterations,
        converged=np.where(better, other.converged, one.converged),
        refused=np.where(better, other.refused, one.refused),
        information=np.where(better[:, None, None], other.information, one.information),
    )
