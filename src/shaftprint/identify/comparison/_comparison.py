"""What a comparison of structures found."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from shaftprint.identify.comparison._criteria import Criteria
from shaftprint.identify.comparison._hold_out import HoldOut
from shaftprint.identify.comparison._likelihood_ratio import LikelihoodRatio
from shaftprint.identify.fit._identification import Identification
from shaftprint.notebook._shown import Shown
from shaftprint.notebook._summary import Summary, shortened


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Candidate:
    """A structure that was fitted to the data."""

    identification: Identification
    """The fit."""
    criteria: Criteria
    """What it explains for how many parameters."""
    hold_out: HoldOut | None
    """How well it predicts lines that were left out; None where none were, or it could not be fitted without them."""

    @property
    def name(self) -> str:
        """Name of the structure."""
        return self.identification.structure.name


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class StructureComparison(Shown):
    """Several structures fitted to the same data, the best first."""

    candidates: tuple[Candidate, ...]
    """The structures that could be fitted, lowest BIC first."""
    failed: Mapping[str, str]
    """Why the others could not, by name; such a structure cannot win."""
    ratios: tuple[LikelihoodRatio, ...]
    """Likelihood-ratio tests of every structure within a larger one."""
    sentences: tuple[str, ...]
    """Which structure wins and why, in words."""

    def summary(self) -> Summary:
        """Return which structure wins, and the weight of each."""
        facts = {
            "outcome": self.sentences[0] if self.sentences else "",
            "BIC weight": shortened(f"{name} {100.0 * share:.1f} %" for name, share in self.weights.items()),
            "failed": shortened(self.failed),
        }
        return Summary(title=f"StructureComparison: {self.best.name} of {len(self.candidates)}", facts=facts)

    @property
    def best(self) -> Candidate:
        """The structure of lowest BIC."""
        return self.candidates[0]

    @property
    def weights(self) -> Mapping[str, float]:
        """Weight that BIC gives each structure, if one of them is right and none was likelier before.

        ``exp(-BIC / 2)`` over its sum (Kass and Raftery, Bayes factors, 1995, eq. 9).
        """
        gaps = np.array([candidate.criteria.bic - self.best.criteria.bic for candidate in self.candidates])
        shares = np.exp(-0.5 * gaps)
        shares /= shares.sum()
        return {candidate.name: float(share) for candidate, share in zip(self.candidates, shares, strict=True)}

    def candidate(self, name: str) -> Candidate | None:
        """Return a structure that could be fitted by its name; None where there is none."""
        return next((candidate for candidate in self.candidates if candidate.name == name), None)
