"""The search for the strongest lines: uses of limits in time, the criterion, and both as one smooth function."""

from shaftprint.design.search._criterion import Criterion, DeterminantWithFloor, WorstWish
from shaftprint.design.search._problem import Possibility, Problem
from shaftprint.design.search._search import Effort, random_start, search
from shaftprint.design.search._uses import Uses, held_draws, samples_of_period

__all__ = [
    "Criterion",
    "DeterminantWithFloor",
    "Effort",
    "Possibility",
    "Problem",
    "Uses",
    "WorstWish",
    "held_draws",
    "random_start",
    "samples_of_period",
    "search",
]
