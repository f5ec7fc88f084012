"""A combination of parameters with its own meaning."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.models._role import Role


@dataclass(frozen=True, kw_only=True, slots=True)
class Combination:
    """A combination of parameters that a test can find where the parameters alone it cannot."""

    name: str
    """Formula in the parameters' names, such as ``t_d + t_sp``."""
    unit: str
    """Unit, ``-`` where there is none."""
    of: Callable[[Mapping[str, FloatArray]], FloatArray]
    """Its value from the parameters' values."""
    meaning: str
    """What it stands for, in a few words."""
    role: Role | None = None
    """What it is in its line, where that is the role of a parameter or of a combination."""

    def is_defined_by(self, values: Mapping[str, FloatArray]) -> bool:
        """Return whether the values name every parameter that the combination is made of."""
        try:
            with np.errstate(all="ignore"):
                self.of(values)
        except KeyError:
            return False
        return True
