"""What the tests of sister ships say, in sentences."""

from shaftprint.drift._class_finding import ClassFinding, ShipStanding
from shaftprint.drift._words import ALIKE, odds_text, open_sentences, size_text, ways_text


def sister_sentences(finding: ClassFinding) -> tuple[str, ...]:
    """Return which ships of a class are not as their sisters are, and in what, the answer first.

    ``finding``: what ``judge_sisters`` has found.
    """
    if finding.because:
        return (f"It cannot be told: {finding.because}.",)
    count = len(finding.ships)
    if not finding.odd:
        return (f"No: {count} ships differ by no more than chance and building.", *open_sentences(finding.not_judged))
    return (
        f"Yes: {len(finding.odd)} of {count} ships.",
        *(_of_ship(ship) for ship in finding.odd),
        *open_sentences(finding.not_judged),
    )


def _of_ship(ship: ShipStanding) -> str:
    alike = [one for one in ship.change.candidates if one.odds < ALIKE]
    rest = ship.change.candidates[len(alike) :]
    named = ", or ".join(f"{one.words}, by {size_text(one)}" for one in alike)
    odds = f" Odds {odds_text(rest[0].odds)} against {rest[0].words}." if rest else ""
    told = "" if len(alike) == 1 else f" Its tests hardly tell them apart: {ways_text(one.cause for one in alike)}."
    return f"{ship.name} against its sisters: {named}.{odds}{told}"
