"""How the lowest cost is found: settings, starts, descent within bounds and beside the border of stability."""

from shaftprint.identify.search._conditional_minimum import Conditional
from shaftprint.identify.search._levenberg_marquardt import Descent, descend
from shaftprint.identify.search._optimum_path import highest_between
from shaftprint.identify.search._search import polish, search
from shaftprint.identify.search._settings import Settings, Stability
from shaftprint.identify.search._spread import spread
from shaftprint.identify.search._starts import Draw, LatinHypercube, Uniform

__all__ = [
    "Conditional",
    "Descent",
    "Draw",
    "LatinHypercube",
    "Settings",
    "Stability",
    "Uniform",
    "descend",
    "highest_between",
    "polish",
    "search",
    "spread",
]
