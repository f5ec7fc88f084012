"""Start values of a search of which one is known to be good."""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.identify.search import Draw


@dataclass(frozen=True, slots=True, eq=False)
class KnownStart(Draw):
    """The first start is given, the others are drawn."""

    first: FloatArray
    """Free parameters of the first start, shape (free,)."""
    others: Draw
    """How the others are drawn."""

    def starts(self, lower: FloatArray, upper: FloatArray, count: int, rng: np.random.Generator) -> FloatArray:
        """Return start values within the bounds, the known one first."""
        drawn = [np.clip(self.first, lower, upper)[None, :]]
        if count > 1:
            drawn.append(self.others.starts(lower, upper, count - 1, rng))
        return np.concatenate(drawn)
