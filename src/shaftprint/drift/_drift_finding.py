"""What the history of a line says about a change of the ship: the nouns."""

from dataclasses import dataclass
from typing import Literal, TypeAlias

from shaftprint.drift._causes import Cause
from shaftprint.drift._finding import SizedCause

Shape: TypeAlias = Literal["step", "ramp"]


@dataclass(frozen=True, kw_only=True, slots=True)
class DatedCause(SizedCause):
    """A cause, when it began to act and how: the size of a ramp is that in a year."""

    shape: Shape
    """Whether it changed once or goes on."""
    since: int
    """Place of the first test with the changed ship (step), or of the last one before it began (ramp)."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Drift:
    """One change of a ship in its history, with the best course of each cause."""

    courses: tuple[DatedCause, ...]
    """The best course of each cause, the most likely first."""
    p_value: float
    """Probability that an unchanged ship reaches such a score in any test up to the horizon."""

    @property
    def best(self) -> DatedCause:
        """The most likely course."""
        return self.courses[0]


@dataclass(frozen=True, kw_only=True, slots=True)
class WatchFinding:
    """What the history of a line says."""

    drifts: tuple[Drift, ...]
    """Changes beyond chance, the clearest first; empty where none is seen."""
    nearest: Drift | None
    """What comes next, within chance."""
    names: tuple[str, ...]
    """Numbers that were judged together."""
    left_out: dict[str, str]
    """Why others were not, by name."""
    not_judged: tuple[Cause, ...] = ()
    """Causes of numbers that were left out: they are not excluded."""
    because: str = ""
    """Why nothing could be judged; empty where something was."""
