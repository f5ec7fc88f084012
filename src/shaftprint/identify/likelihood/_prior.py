"""What is known of a parameter before a fit."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from shaftprint.errors import IdentificationError

# The parts of a standard deviation are printed numbers: they need not add up to the last digit.
SAME_STD = 1e-6
PRIOR_OF = "prior of "
"""What the source of a prior that states none is called, before the name of the parameter."""


@dataclass(frozen=True, slots=True)
class Prior:
    """What is known of a parameter before the fit, as a normal distribution."""

    mean: float
    """Expected value, in the parameter's unit."""
    std: float
    """Standard deviation, in the parameter's unit."""
    sources: Mapping[str, float] = field(default_factory=dict)
    """Parts of the standard deviation by independent source: the change of the parameter, with sign, when the source
    changes by its own standard deviation. Their squares add up to that of ``std``; empty for a prior of one source."""

    def __post_init__(self) -> None:
        """Check the standard deviation and its parts.

        Raises IdentificationError if it is not positive, or the parts do not add up to it.
        """
        if not self.std > 0.0:
            raise IdentificationError(
                f"prior {self.mean} +/- {self.std}: expected a positive standard deviation; hold the parameter instead."
            )
        total = float(np.linalg.norm(list(self.sources.values()))) if self.sources else self.std
        if abs(total - self.std) > SAME_STD * self.std:
            raise IdentificationError(
                f"prior {self.mean} +/- {self.std}: expected sources whose squares add up to that of the standard "
                f"deviation, found {total} from {', '.join(self.sources)}."
            )

    def by_source(self, parameter: str) -> Mapping[str, float]:
        """Return the parts of the standard deviation by source: the prior itself where it states none."""
        return self.sources or {PRIOR_OF + parameter: self.std}
