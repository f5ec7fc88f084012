"""Which parameters a response is linear in, found out from its exact gradients.

A response is jointly affine in some parameters when none of its derivatives to them changes with any of them, whatever
the others are. A product of two free gains is affine in each of them, but not in both: of the sets that are jointly
affine the largest is taken.
"""

from itertools import combinations

import numpy as np

from shaftprint.arrays import BoolArray
from shaftprint.identify.likelihood._objective import Objective
from shaftprint.identify.search._spread import spread

# Places in the box at which the derivatives are compared.
PLACES = 4
# A derivative that changes by less than this share of its size is constant: numeric ones have no more digits.
SAME_SLOPE = 1e-7


def affine_parameters(objective: Objective, held: int) -> tuple[int, ...]:
    """Return the largest set of free parameters in which the residuals are jointly affine while one is held.

    ``objective``: the problem. ``held``: place, among the free parameters, of the one that is held. Returns places
    among the free parameters, ascending; the first such set in the order of the parameters.
    """
    bends = _bends(objective)
    alone = [i for i in range(bends.shape[0]) if i != held and not bends[i, i]]
    for size in range(len(alone), 0, -1):
        for chosen in combinations(alone, size):
            if not bends[np.ix_(chosen, chosen)].any():
                return chosen
    return ()


def _bends(objective: Objective) -> BoolArray:
    """Return whether the derivative to one parameter changes with another, shape (free, free)."""
    lower, upper = objective.lower, objective.upper
    size = lower.size
    points = spread(2 * PLACES, lower, upper)
    bends = np.zeros((size, size), dtype=np.bool_)
    for base, other in zip(points[:PLACES], points[PLACES:], strict=True):
        theta = np.tile(base, (size + 1, 1))
        theta[np.arange(1, size + 1), np.arange(size)] = other
        _, slopes = objective.residuals(theta)
        change = np.abs(slopes[1:] - slopes[0]).max(axis=2)
        largest = np.maximum(np.abs(slopes[1:]).max(axis=2), np.abs(slopes[0]).max(axis=1))
        bends |= ~(change <= SAME_SLOPE * largest)
    return bends | bends.T
