"""What two tests say about a change of the ship: the nouns of the room."""

import math
from dataclasses import dataclass

from shaftprint.digits import stated
from shaftprint.drift._causes import Cause
from shaftprint.fingerprint._design import DesignDifference
from shaftprint.notebook._shown import Shown
from shaftprint.notebook._summary import Summary, shortened

_LARGEST_EXPONENT = 700.0


@dataclass(frozen=True, kw_only=True, slots=True)
class SizedCause:
    """A cause, and how well it explains the difference of two tests."""

    cause: Cause
    """What may have changed."""
    size: float
    """By how much, if it is this alone: a share, or a time [s]."""
    std: float
    """Standard deviation of the size."""
    score: float
    """Size over standard deviation; standard normal where nothing changed."""
    odds: float
    """Likelihood of the difference under the best cause over that under this one; 1 for the best."""

    @property
    def words(self) -> str:
        """What has happened to the ship, by the sign of the size."""
        return self.cause.more if self.size > 0.0 else self.cause.less

    @property
    def amount(self) -> str:
        """Size and standard deviation with the digits that these have."""
        factor, unit = (100.0, "%") if self.cause.is_share else (1.0, "s")
        return stated(factor * self.size, factor * self.std, unit)


def odds_against(score: float, best: float) -> float:
    """Return how much more likely a difference is under the cause with the best score than under another."""
    # beyond that a float has no number
    return math.exp(min(0.5 * (best**2 - score**2), _LARGEST_EXPONENT))


@dataclass(frozen=True, kw_only=True, slots=True)
class ShipChange:
    """One change that was found, with all causes that may have made it."""

    candidates: tuple[SizedCause, ...]
    """Causes, the most likely first, each by itself beside the changes found before."""
    p_value: float
    """Probability that chance alone makes the largest score that large or larger."""

    @property
    def best(self) -> SizedCause:
        """The most likely cause."""
        return self.candidates[0]


@dataclass(frozen=True, kw_only=True, slots=True, repr=False)
class Finding(Shown):
    """What differs between two tests of one ship, judged along causes."""

    changes: tuple[ShipChange, ...]
    """Changes beyond chance, the clearest first; empty where none is seen."""
    nearest: ShipChange | None
    """What comes next, within chance; None where no cause could be judged."""
    rest_p_value: float | None
    """Probability that chance alone leaves as much or more beside the changes; small where something else has changed
    than these causes. None where nothing was judged."""
    names: tuple[str, ...]
    """Numbers that were judged together."""
    left_out: dict[str, str]
    """Why others were not, by name."""
    not_judged: tuple[Cause, ...] = ()
    """Causes of numbers that were left out: they are not excluded."""
    because: str = ""
    """Why nothing could be judged; empty where something was."""
    designs: tuple[DesignDifference, ...] = ()
    """In what the tests are of ships of two designs, of which no cause is looked for; empty of one ship or sisters."""

    def summary(self) -> Summary:
        """Return the most likely cause of each change with its size."""
        facts = {one.best.words: one.best.amount for one in self.changes}
        judged = {"judged": shortened(self.names), "left out": shortened(self.left_out), "because": self.because}
        return Summary(title=f"Changes of a ship: {len(self.changes)} beyond chance", facts=facts | judged)
