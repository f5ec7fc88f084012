"""The covariance of several numbers together: what the test itself leaves open, and how each stated value moves them.

Two tests share the error of a calibration or of an assumption, and in their difference it cancels where it moves both
alike. For that its effect on each number is needed with its sign; variances alone, as the budget has them, do not say
whether a scale that is too large moves two numbers together or apart.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import IdentificationError
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.uncertainty._budget import NO_DIRECT, Direct
from shaftprint.identify.uncertainty._numbers import Numbers, all_numbers
from shaftprint.identify.uncertainty._propagation import propagation
from shaftprint.models._combination import Combination


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class JointCovariance:
    """Covariance of numbers of one fit, by what is of the test and what was stated beforehand."""

    names: tuple[str, ...]
    """Names of the numbers."""
    own: FloatArray
    """Covariance that the test itself leaves: its noise and its working point, shape (numbers, numbers)."""
    loadings: Mapping[str, FloatArray]
    """Change of the numbers, with sign, for one standard deviation of each other source, shape (numbers,)."""


def joint_covariance(
    identification: Identification,
    names: Collection[str],
    numbers: Sequence[Combination] = (),
    *,
    direct: Direct = NO_DIRECT,
    shifts: Direct = NO_DIRECT,
    of_the_test: Collection[str] = (),
) -> JointCovariance:
    """Return the covariance of parameters, combinations and further numbers, to first order.

    ``identification``: the fit. ``names``: which numbers; those that the data do not fix are left out. ``numbers``:
    further numbers that follow from the parameters, as ``budget`` takes them. ``direct``, ``shifts``: as ``budget``
    takes them. ``of_the_test``: sources, beside noise and shifts, whose error is another one in every test. Raises
    IdentificationError if there is no number of a name.
    """
    objective = identification.objective
    combinations = (*objective.combinations, *numbers)
    every = all_numbers(objective, numbers)
    foreign = [name for name in names if name not in every]
    if foreign:
        raise IdentificationError(f"joint covariance: there is no {foreign[0]}; there are {', '.join(every)}.")
    rows = np.array([every.index(name) for name in names], dtype=np.int64)
    theta = identification.values[list(objective.free)]
    table = np.repeat(theta[None, :], rows.size, axis=0)
    sensitivity, _ = objective.sensitivity(theta, expected=False)
    curvature = np.broadcast_to(np.sum(sensitivity**2, axis=1), table.shape)
    slopes = Numbers(objective, combinations, rows).slopes(table, curvature)
    moved = propagation(identification, shifts)
    fixed = [bool(np.all(np.isfinite(row))) and moved.information.knows(row) for row in slopes]
    kept = [name for name, is_fixed in zip(names, fixed, strict=True) if is_fixed]
    slopes = slopes[fixed]
    own = slopes @ sum(moved.noise.values(), np.zeros((theta.size, theta.size))) @ slopes.T
    loadings: dict[str, FloatArray] = {}
    for source in dict.fromkeys([*moved.effects, *(name for changes in direct.values() for name in changes)]):
        through = slopes @ moved.effects[source] if source in moved.effects else np.zeros(len(kept))
        change = through + np.array([direct.get(name, {}).get(source, 0.0) for name in kept])
        if source in shifts or source in of_the_test:
            own = own + np.outer(change, change)
        else:
            loadings[source] = change
    return JointCovariance(names=tuple(kept), own=0.5 * (own + own.T), loadings=loadings)
