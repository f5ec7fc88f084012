"""What the history of a line says about a change of the ship: the nouns."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, TypeAlias

from shaftprint.drift._causes import Cause
from shaftprint.drift._dated import Event
from shaftprint.drift._finding import SizedCause
from shaftprint.notebook._shown import Shown
from shaftprint.notebook._summary import Summary, shortened

Shape: TypeAlias = Literal["step", "ramp"]
Outcome: TypeAlias = Literal["cannot be told", "unchanged", "worn as expected", "changed"]


@dataclass(frozen=True, kw_only=True, slots=True)
class DatedCause(SizedCause):
    """A cause, when it began to act and how: the size of a ramp is that in a year."""

    shape: Shape
    """Whether it changed once or goes on."""
    since: int
    """Place of the first test with the changed ship (step), or of the last one before it began (ramp)."""

    @property
    def is_expected(self) -> bool:
        """Whether it is wear that goes on with every ship and that work in a dock takes off, as fouling is."""
        return self.shape == "ramp" and self.cause.taken_off_by != "" and self.size * self.cause.wears > 0.0

    @property
    def to_do(self) -> str:
        """What to do about it, in words: what takes expected wear off, or what tells another cause better."""
        return f"{self.cause.taken_off_by} takes it off" if self.is_expected else self.cause.told_by


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
class NotedChange:
    """What was done to the ship, and what it did to the numbers."""

    event: Event
    """What was noted."""
    changes: tuple[SizedCause, ...]
    """What moved with it beyond chance, the clearest first; empty where nothing did."""


@dataclass(frozen=True, kw_only=True, slots=True)
class SizeByNow:
    """How far a cause is at the last test from where it began, what was done to the ship counted."""

    size: float
    """A share, or a time [s]."""
    std: float
    """Its standard deviation."""


@dataclass(frozen=True, kw_only=True, slots=True, repr=False)
class WatchFinding(Shown):
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
    noted: tuple[NotedChange, ...] = ()
    """What the events of the history did, in their order."""
    by_now: Mapping[str, SizeByNow] = field(default_factory=dict)
    """How far each cause that drifts is at the last test, by the name of the cause."""

    def summary(self) -> Summary:
        """Return whether the ship has changed, and the most likely cause of each change with its size."""
        facts = {one.best.words: one.best.amount for one in self.by_urgency}
        judged = {"judged": shortened(self.names), "left out": shortened(self.left_out), "because": self.because}
        return Summary(title=f"Ship {self.outcome}", facts=facts | judged)

    @property
    def outcome(self) -> Outcome:
        """Whether the ship has changed, in a word; wear that is expected is no change."""
        if self.because:
            return "cannot be told"
        if not self.drifts:
            return "unchanged"
        return "worn as expected" if all(drift.best.is_expected for drift in self.drifts) else "changed"

    @property
    def by_urgency(self) -> tuple[Drift, ...]:
        """The changes, wear that is expected last."""
        return tuple(sorted(self.drifts, key=lambda drift: drift.best.is_expected))
