"""How the lowest cost is found: settings, starts, descent within bounds and beside the border of stability."""

from shaftprint.identify.search._bounded_least_squares import bounded_least_squares
from shaftprint.identify.search._conditional_minimum import Conditional
from shaftprint.identify.search._levenberg_marquardt import LARGEST_DAMPING, Descent, descend
from shaftprint.identify.search._optimum_path import highest_between
from shaftprint.identify.search._search import polish, search
from shaftprint.identify.search._settings import Settings, Stability
from shaftprint.identify.search._spread import spread
from shaftprint.identify.search._stability_border import border_minimum, stable_models
from shaftprint.identify.search._starts import Draw, GivenStarts, LatinHypercube, Uniform

__all__ = [
    "LARGEST_DAMPING",
    "Conditional",
    "Descent",
    "Draw",
    "GivenStarts",
    "LatinHypercube",
    "Settings",
    "Stability",
    "Uniform",
    "border_minimum",
    "bounded_least_squares",
    "descend",
    "highest_between",
    "polish",
    "search",
    "spread",
    "stable_models",
]
