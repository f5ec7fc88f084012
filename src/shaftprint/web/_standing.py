"""The word that stands for a line: unchanged, changed, not trustworthy, test overdue, or why nothing can be said."""

from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any, Final, Literal, TypeAlias

from shaftprint.digits import with_deviation
from shaftprint.store._overview import LineNow

Look: TypeAlias = Literal["fine", "worn", "look", "bad", "open"]
WORDS: Final = (
    "changed",
    "not trustworthy",
    "test overdue",
    "worn as expected",
    "unchanged",
    "cannot be told",
    "being judged",
    "no test yet",
)
"""What a line may be, in the order in which somebody wants to hear of it."""


_NAMED: Final = 2
"""Changes of a line that are named in its note."""


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
    clearness: float = 0.0
    """Size over deviation of what has changed, or wears, by which lines of one word are ordered."""


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
    # what is seen is the word, in its own colour; that the test is overdue is said quietly below it
    if overdue and kind in {"worn as expected", "unchanged"}:
        # of those that only want a test, what wears stands above what does not
        worn = 0.0 if found is None else _clearness(found[1], expected=True)
        return Standing(kind="test overdue", word=word, look=look, note=note, overdue=True, clearness=worn)
    clearness = 0.0 if found is None or kind != "changed" else _clearness(found[1], expected=False)
    return Standing(kind=kind, word=word, look=look, note=note, overdue=overdue, clearness=clearness)


def _clearness(summary: dict[str, Any], *, expected: bool) -> float:
    real = [one for one in summary.get("causes") or [] if bool(one.get("expected")) is expected]
    return max((abs(one["size"]) / one["std"] for one in real if one["std"]), default=0.0)


def _said(line: LineNow, found: tuple[str, dict[str, Any]] | None) -> tuple[str, str, Look, str]:
    if line.tested_at is None:
        return "no test yet", "no test yet", "open", ""
    if not line.trustworthy:
        return "not trustworthy", "not trustworthy", "bad", f"the newest test, of {line.tested_at:%Y-%m-%d}"
    if found is None:
        return "being judged", "being judged", "open", ""
    summary = found[1]
    # findings of an earlier version do not say which wear is expected
    causes = sorted(summary.get("causes") or [], key=lambda one: bool(one.get("expected")))
    if causes:
        first = causes[0]
        note = change_words(first) + (f"; beside it {causes[1]['name']}{_by_now(causes[1])}" if len(causes) > 1 else "")
        note += f", and {len(causes) - 2} more" if len(causes) > _NAMED else ""
        note += f". {first['to_do'][:1].upper()}{first['to_do'][1:]}" if first.get("to_do") else ""
        if first.get("expected"):
            return "worn as expected", f"worn as expected: {first['name']}", "worn", note
        return "changed", f"changed: {first['name']}", "look", note
    if line.tests == 1:
        return "cannot be told", "one test only", "open", "from two tests on a change can be seen"
    if summary.get("because"):
        return "cannot be told", "cannot be told", "open", summary["because"]
    return (
        "unchanged",
        f"no change seen since {str(summary.get('since'))[:7]}",
        "fine",
        _nearest(summary.get("nearest")),
    )


def _nearest(cause: dict[str, Any] | None) -> str:
    """Return what comes nearest to a change, with how well it is known; nothing where a finding does not say."""
    if not cause:
        return ""
    size = f"{with_deviation(cause['size'], cause['std'])} {cause['unit']}"
    return f"nearest to one: {cause['name']} {size}{' a year' if cause['shape'] == 'ramp' else ''}, within chance"


def change_words(cause: dict[str, Any]) -> str:
    """Return by how much and since when, in a few words."""
    size = f"{with_deviation(cause['size'], cause['std'])} {cause['unit']}"
    if cause["shape"] != "ramp":
        return f"{size}, seen on {cause['since']}"
    by_now = _by_now(cause).removeprefix(" ")
    taken = "".join(
        f", of which the {one['kind']} of {one['at']} took off "
        f"{with_deviation(one['size'], one['std'])} {cause['unit']}"
        for one in cause.get("off") or []
    )
    return f"{by_now}{', ' if by_now else ''}{size} a year since {cause['since']}{taken}"


def _by_now(cause: dict[str, Any]) -> str:
    """Return what a change that goes on has come to, behind a space; nothing of a step."""
    now = cause.get("now")
    return "" if now is None else f" {with_deviation(now['size'], now['std'])} {cause['unit']} by now"
