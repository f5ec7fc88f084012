"""What two tests say about a change of the ship: the nouns of the room."""

from dataclasses import dataclass

from shaftprint.drift._causes import Cause


@dataclass(frozen=True, kw_only=True, slots=True)
class Candidate:
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


@dataclass(frozen=True, kw_only=True, slots=True)
class Change:
    """One change that was found, with all causes that may have made it."""

    candidates: tuple[Candidate, ...]
    """Causes, the most likely first, each by itself beside the changes found before."""
    p_value: float
    """Probability that chance alone makes the largest score that large or larger."""

    @property
    def best(self) -> Candidate:
        """The most likely cause."""
        return self.candidates[0]


@dataclass(frozen=True, kw_only=True, slots=True)
class Finding:
    """What differs between two tests of one ship, judged along causes."""

    changes: tuple[Change, ...]
    """Changes beyond chance, the clearest first; empty where none is seen."""
    nearest: Change | None
    """What comes next, within chance; None where no cause could be judged."""
    rest_p_value: float | None
    """Probability that chance alone leaves as much or more beside the changes; small where something else has changed
    than these causes. None where nothing was judged."""
    names: tuple[str, ...]
    """Numbers that were judged together."""
    left_out: dict[str, str]
    """Why others were not, by name."""
    because: str = ""
    """Why nothing could be judged; empty where something was."""
