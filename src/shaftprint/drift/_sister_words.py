"""What the tests of sister ships say, in sentences."""

from shaftprint.drift._class_finding import ClassFinding, ShipStanding
from shaftprint.drift._words import alternatives, open_sentences, sized_text


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
    return (
        f"{ship.name} against its sisters: {alternatives(ship.change.candidates, sized_text, 'Its tests hardly tell')}"
    )
