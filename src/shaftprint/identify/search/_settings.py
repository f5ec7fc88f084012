"""How to search and weigh."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, get_args

from shaftprint.errors import IdentificationError
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.identify.likelihood._weighting import MaximumLikelihood, Weighting
from shaftprint.identify.search._starts import Draw, LatinHypercube

Stability = Literal["after", "during", "ignored"]


@dataclass(frozen=True, kw_only=True, slots=True)
class Settings:
    """How a fit searches and weighs; the defaults follow thesis section 5.1, but weigh by the measured covariance."""

    weighting: Weighting = field(default_factory=MaximumLikelihood)
    """How lines and outputs are weighed."""
    priors: Mapping[str, Prior] = field(default_factory=dict)
    """Priors of parameters; they count in the uncertainty."""
    regularisation: Mapping[str, Prior] = field(default_factory=dict)
    """A pull towards values that is not knowledge: it does not count in the uncertainty."""
    starts: int = 50
    """Number of starts."""
    draw: Draw = field(default_factory=LatinHypercube)
    """How the starts are drawn within the bounds."""
    max_iterations: int = 100
    """Limit of iterations of each start."""
    tolerance: float = 1e-5
    """Share of the cost below which a further gain is not worth a step (0.001 %)."""
    leader_tolerance: float = 1e-14
    """The same for the lowest start, which goes to the last digit; a search for places to start from needs none."""
    stability: Stability = "after"
    """Whether an unstable model may win: sorted out ``after`` the search, kept out ``during`` it, or ``ignored``."""

    def __post_init__(self) -> None:
        """Check counts and kinds.

        Raises IdentificationError if starts, iterations or tolerance are not positive, the stability rule is unknown,
        or a prior is none.
        """
        for name, prior in (*self.priors.items(), *self.regularisation.items()):
            if not isinstance(prior, Prior):
                raise IdentificationError(f"prior of {name}: expected Prior(mean, std), found {prior!r}.")
        if self.starts < 1 or self.max_iterations < 1 or not min(self.tolerance, self.leader_tolerance) > 0.0:
            raise IdentificationError(
                f"search settings: expected positive starts, iterations and tolerances, found {self.starts}, "
                f"{self.max_iterations}, {self.tolerance} and {self.leader_tolerance}."
            )
        if self.stability not in get_args(Stability):
            raise IdentificationError(
                f"search settings: expected stability {', '.join(get_args(Stability))}, found {self.stability!r}."
            )
