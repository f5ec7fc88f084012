"""The table of causes: what may have changed between two tests, by how much, and how likely each is."""

from typing import TYPE_CHECKING

from shaftprint.digits import p_value_text, plain, with_deviation
from shaftprint.plain_table import Table, numbers, texts

if TYPE_CHECKING:
    from shaftprint.drift._finding import Finding, ShipChange, SizedCause

MOST_ODDS = 1000.0


def cause_table(name: str, finding: "Finding") -> Table:
    """Return every cause with its size, score and odds: of each change that was seen, else of what comes nearest.

    ``name``: name of the later test. ``finding``: what was found.
    """
    changes = finding.changes or (() if finding.nearest is None else (finding.nearest,))
    rows = [_cells(change, one, at) for change in changes for at, one in enumerate(change.candidates)]
    return Table(
        title=f"{name}: {'what has changed' if finding.changes else 'no change beyond chance; what comes nearest'}",
        columns=(*texts("what may have changed"), *numbers("by", "size / deviation", "odds against it", "p")),
        rows=tuple(rows),
        note=_note(finding),
    )


def _cells(change: "ShipChange", one: "SizedCause", place: int) -> tuple[str, ...]:
    return (
        one.words,
        sized(one),
        plain(one.score, 1),
        odds_text(one) if place else "–",
        p_value_text(change.p_value) if place == 0 else "",
    )


def odds_text(one: "SizedCause") -> str:
    """Return the odds against a cause, as tables have them."""
    return f"> {MOST_ODDS:g} : 1" if one.odds > MOST_ODDS else f"{plain(one.odds, 1)} : 1"


def sized(one: "SizedCause") -> str:
    """Return size and deviation of a cause with its sign, as tables have them."""
    cause = one.cause
    return f"{with_deviation(cause.in_unit(one.size), cause.in_unit(one.std))} {cause.unit}"


def _note(finding: "Finding") -> str:
    together = f"Judged together: {', '.join(finding.names)}."
    if not finding.left_out:
        return together
    return f"{together} Left out: {'; '.join(f'{name}, {why}' for name, why in finding.left_out.items())}."
