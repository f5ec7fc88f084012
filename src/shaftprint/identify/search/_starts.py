"""Start values of a search, drawn within the bounds."""

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray


class Draw(ABC):
    """A way to draw start values."""

    __slots__ = ()

    @abstractmethod
    def starts(self, lower: FloatArray, upper: FloatArray, count: int, rng: np.random.Generator) -> FloatArray:
        """Return start values within the bounds, shape (count, parameters)."""


@dataclass(frozen=True, slots=True)
class LatinHypercube(Draw):
    """Each parameter's range is cut into as many cells as there are starts; every cell is met once.

    The delay of a structure without lag has a local optimum for every turn of the fast lines' phase, so that its starts
    must be spread over its whole range; independent draws leave gaps (``docs/benchmarks.md``).
    """

    def starts(self, lower: FloatArray, upper: FloatArray, count: int, rng: np.random.Generator) -> FloatArray:
        """Return one start in every cell of every parameter, in random combination."""
        cells = np.argsort(rng.random((lower.size, count)), axis=1).T
        return lower + (cells + rng.random((count, lower.size))) / count * (upper - lower)


@dataclass(frozen=True, slots=True, eq=False)
class GivenStarts(Draw):
    """Starts that are given, from the first on again where more are asked for; or others behind them."""

    values: FloatArray
    """Start values, shape (starts, parameters)."""
    others: Draw | None = None
    """How further starts are drawn."""

    def starts(self, lower: FloatArray, upper: FloatArray, count: int, rng: np.random.Generator) -> FloatArray:
        """Return the given starts within the bounds, and what is missing of the count."""
        first = np.clip(self.values, lower, upper)
        missing = count - first.shape[0]
        if self.others is None or missing <= 0:
            return np.asarray(first[np.arange(count) % first.shape[0]])
        return np.concatenate([first, self.others.starts(lower, upper, missing, rng)])


@dataclass(frozen=True, slots=True)
class Uniform(Draw):
    """Independent uniform draws: the thesis' random starts (section 5.1)."""

    def starts(self, lower: FloatArray, upper: FloatArray, count: int, rng: np.random.Generator) -> FloatArray:
        """Return independent uniform starts."""
        return lower + rng.random((count, lower.size)) * (upper - lower)
