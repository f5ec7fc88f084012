"""Which changes two tests of a kind would see, before either is made."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.distributions import NORMAL_95
from shaftprint.drift._along import Whitened, p_value_of_largest
from shaftprint.drift._causes import Cause
from shaftprint.drift._differ import UNLIKELY
from shaftprint.drift._pair import directions_of
from shaftprint.drift._single_test import is_share

if TYPE_CHECKING:
    from shaftprint.identify.prediction._accuracy import Accuracy

POWER_80: Final = 0.8416212335729143
"""Standard normal deviation below which four of five scores lie."""
_LARGEST_LIMIT = 10.0


@dataclass(frozen=True, kw_only=True, slots=True)
class VisibleChange:
    """The smallest change of a cause that is seen in four of five pairs of tests."""

    cause: Cause
    """What may change."""
    size: float
    """By how much: a share, or a time [s]."""


def visible_changes(accuracy: "Accuracy") -> tuple[VisibleChange, ...]:
    """Return which changes two tests of predicted accuracy would see, each in four of five pairs.

    What was known beforehand is the same in both and cancels. A change of the propeller is not among them: it is seen
    in the torque of the working point, of which no prediction knows how the load wanders.

    ``accuracy``: what one of them would give.
    """
    free = [parameter for parameter in accuracy.objective.parameters if not parameter.held]
    names = [one.name for one in free]
    if not np.all(np.isfinite(accuracy.covariance)):
        return ()
    information = np.linalg.inv(accuracy.covariance)
    for name, prior in accuracy.priors.items():
        if name in names:
            place = names.index(name)
            information[place, place] -= prior.std**-2
    # what is of the test and its sensors may be another in each test
    of_test = [at for at, one in enumerate(free) if one.role is None or one.role.of_sensor or one.role.law is not None]
    of_ship = [at for at in range(len(free)) if at not in of_test]
    causes, directions = directions_of({names[at]: free[at].role for at in of_ship}, None)
    if not causes:
        return ()
    within = information[np.ix_(of_ship, of_ship)]
    across = information[np.ix_(of_ship, of_test)]
    within = within - across @ np.linalg.pinv(information[np.ix_(of_test, of_test)], hermitian=True) @ across.T
    values = [accuracy.estimate(names[at]).value for at in of_ship]
    size = np.array(
        [value if is_share(free[at].role, free[at].unit) else 1.0 for value, at in zip(values, of_ship, strict=True)]
    )
    # in the valley that the data leave open the information is zero, and by rounding less
    strength, axes = np.linalg.eigh(within)
    root = np.sqrt(np.maximum(strength, 0.0))[:, None] * axes.T
    white = Whitened(difference=np.zeros(len(of_ship)), directions=root @ (directions * size[:, None]) / np.sqrt(2.0))
    limit = _limit(white.cosines())
    stds = 1.0 / np.linalg.norm(white.directions, axis=0)
    return tuple(
        VisibleChange(cause=cause, size=float((limit + POWER_80) * std))
        for cause, std in zip(causes, stds, strict=True)
    )


def _limit(cosines: FloatArray) -> float:
    """Return the score that the largest of an unchanged ship passes in 5 % of pairs, by bisection."""
    low, high = NORMAL_95, _LARGEST_LIMIT
    while high - low > 1e-6:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if p_value_of_largest(middle, cosines) > UNLIKELY else (low, middle)
    return high
