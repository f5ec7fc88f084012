"""The first page of a report: is it fine, and what to do where it is not, in words that need no control engineering."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, TypeAlias

from shaftprint.plain_table import Table

if TYPE_CHECKING:
    from shaftprint.report.sections._sketch import Sketch

State: TypeAlias = Literal["fine", "worn", "look", "bad", "open"]

WORDS: dict[State, tuple[str, str]] = {
    "fine": ("✓", "Fine"),
    "worn": ("~", "As expected"),
    "look": ("!", "Look at this"),
    "bad": ("✕", "Not fine"),
    "open": ("?", "Not known"),
}


@dataclass(frozen=True, kw_only=True, slots=True)
class Card:
    """One question of the first page with its answer."""

    question: str
    """What a superintendent asks."""
    state: State
    """The answer in one word."""
    sentence: str
    """The answer with its number."""
    action: str = ""
    """What to do about it; empty where it is fine."""
    answer: str = ""
    """A short answer that stands in place of the state in words, with no sign before it; empty where none does."""

    @property
    def word(self) -> str:
        """State in words after its sign, so that nobody has to tell colours apart; or the short answer alone."""
        return self.answer or " ".join(WORDS[self.state])


@dataclass(frozen=True, kw_only=True, slots=True)
class Cover:
    """The first page: headline, conditions, sketch, questions with answers, and the numbers."""

    headline: str
    """Verdict in one line."""
    state: State
    """State of the whole."""
    opening: str
    """Under which conditions it holds."""
    cards: Sequence[Card]
    """Questions with answers."""
    known: str = ""
    """How many of how many numbers are known, in the colour of the verdict; empty where nothing is counted."""
    change: str = ""
    """What has changed since an earlier test, in one line; empty where there is none."""
    facts: Sequence[tuple[str, str]] = ()
    """Date, place and the like: name and value."""
    leading: Sequence[Table] = ()
    """What is needed before any answer, such as the card for the bridge; it stands above the questions."""
    tables: Sequence[Table] = ()
    """The numbers that matter."""
    sketch: "Sketch | None" = None
    """What was tested; None where there is nothing to draw."""
    company: str = ""
    """Who made the test; empty where nobody says so."""
    logo: bytes | None = None
    """Its logo, PNG; None where there is none."""


def overall(cards: Sequence[Card], *, usable: bool, partly: bool = False) -> tuple[State, str]:
    """Return the state of the whole and the headline that says it.

    ``cards``: questions with answers. ``usable``: whether the numbers may be used at all. ``partly``:
    whether something speaks against part of them.
    """
    if not usable:
        return "bad", "The test cannot be used: its numbers are not trustworthy"
    can = f"The test can be used{' in part' * partly}"
    wrong = sum(card.state == "bad" for card in cards)
    if wrong:
        return "bad", f"{can}; {_points(wrong)} not fine"
    doubtful = sum(card.state == "look" for card in cards)
    if doubtful:
        return "look", f"{can}; {_points(doubtful)} worth a look"
    return "fine", "The test can be used, and all that it can tell is fine"


def _points(count: int) -> str:
    return "one point is" if count == 1 else f"{count} points are"
