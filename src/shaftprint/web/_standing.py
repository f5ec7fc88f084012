"""The word that stands for a line: unchanged, changed, not trustworthy, test overdue, or why nothing can be said."""

from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any, Final, Literal, TypeAlias

from shaftprint.digits import with_deviation
from shaftprint.store._overview import LineNow

Look: TypeAlias = Literal["fine", "look", "bad", "open"]
WORDS: Final = (
    "changed",
    "not trustworthy",
    "test overdue",
    "unchanged",
    "cannot be told",
    "being judged",
    "no test yet",
)
"""What a line may be, in the order in which somebody wants to hear of it."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Standing:
    """How a line stands."""

    kind: str
    """One of ``WORDS``."""
    word: str
    """What is said of it."""
    look: Look
    """How the page sets it."""
    note: str
    """What else is to be said, in a few words."""
    overdue: bool
    """Whether its newest test is too long ago."""


def standing_of(
    line: LineNow, found: tuple[str, dict[str, Any]] | None, *, now: datetime, overdue_days: int
) -> Standing:
    """Return how a line stands.

    ``line``: the line with its newest test. ``found``: what was found of it, with the state of its records then; None
    where it was not judged yet. ``now``: the present time. ``overdue_days``: after so many days without a test it is
    overdue.
    """
    overdue = line.tested_at is not None and now - line.tested_at > timedelta(days=overdue_days)
    kind, word, look, note = _said(line, found)
    if found is not None and found[0] != line.state:
        note = "; ".join(filter(None, (note, "being judged anew")))
    if overdue and kind not in {"changed", "not trustworthy"}:
        note = "; ".join(filter(None, (word, note)))
        return Standing(kind="test overdue", word="test overdue", look="look", note=note, overdue=True)
    return Standing(kind=kind, word=word, look=look, note=note, overdue=overdue)


def _said(line: LineNow, found: tuple[str, dict[str, Any]] | None) -> tuple[str, str, Look, str]:
    if line.tested_at is None:
        return "no test yet", "no test yet", "open", ""
    if not line.trustworthy:
        return "not trustworthy", "not trustworthy", "bad", f"the newest test, of {line.tested_at:%Y-%m-%d}"
    if found is None:
        return "being judged", "being judged", "open", ""
    summary = found[1]
    causes = summary.get("causes") or []
    if causes:
        note = change_words(causes[0]) + (f", and {len(causes) - 1} more" if len(causes) > 1 else "")
        return "changed", f"changed: {causes[0]['name']}", "look", note
    if line.tests == 1:
        return "cannot be told", "one test only", "open", "from two tests on a change can be seen"
    if summary.get("because"):
        return "cannot be told", "cannot be told", "open", summary["because"]
    return "unchanged", f"unchanged since {str(summary.get('since'))[:7]}", "fine", ""


def change_words(cause: dict[str, Any]) -> str:
    """Return by how much and since when, in a few words."""
    size = f"{with_deviation(cause['size'], cause['std'])} {cause['unit']}"
    return f"{size} a year since {cause['since']}" if cause["shape"] == "ramp" else f"{size}, seen on {cause['since']}"
