"""The first screen of a comparison: has anything changed, and may the tests be compared at all."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from shaftprint.digits import plain, unit_text
from shaftprint.drift._finding import Finding
from shaftprint.drift._shared_errors import are_two_lines
from shaftprint.drift._words import finding_sentences
from shaftprint.report.figures._differences import in_percent
from shaftprint.report.sections._cover import Card, Cover, State

if TYPE_CHECKING:
    from shaftprint.fingerprint._fingerprint import Fingerprint
    from shaftprint.report.comparison._differences import Difference

# Normalised numbers move with the working point: beyond this share they differ for that reason alone.
SAME_WORKING_POINT = 0.02
MOST_NAMED = 4


def comparison_cover(
    fingerprints: "Mapping[str, Fingerprint]",
    found: "Mapping[str, Sequence[Difference]]",
    findings: Mapping[str, Finding],
) -> Cover:
    """Return the first screen of a comparison.

    ``fingerprints``: fingerprints by name, the first of them the one that others are compared with. ``found``:
    differences from it, by the name of the other. ``findings``: the same judged along causes.
    """
    (_, first), *others = fingerprints.items()
    cards = [_usable(fingerprints), _alike(first, dict(others))]
    cards += [_changed(name, rows, findings[name]) for name, rows in found.items()]
    usable = all(fingerprint.verdict.trustworthy for fingerprint in fingerprints.values())
    lines = all(are_two_lines(first, other) for _, other in others)
    state, headline = _headline(
        cards[2:], usable=usable, lines=lines, designs=any(one.designs for one in findings.values())
    )
    names = list(fingerprints)
    opening = f"{', '.join(names[1:])} {'is' if len(names) == 2 else 'are'} compared with {names[0]}."
    return Cover(headline=headline, state=state, opening=opening, cards=cards)


def _headline(changes: Sequence[Card], *, usable: bool, lines: bool, designs: bool) -> tuple[State, str]:
    if not usable:
        return "bad", "These tests cannot be compared: not all of them are trustworthy"
    states = {card.state for card in changes}
    if "look" in states:
        return "look", f"{'The lines differ' if lines else 'Something has changed'} by more than chance"
    if "open" in states and designs:
        return "open", "These are not sister ships: what differs is their design"
    if "open" in states:
        return "open", "Not all of these tests share a number that can be compared"
    return "fine", f"No {'difference of the lines' if lines else 'change'} is seen"


def _usable(fingerprints: "Mapping[str, Fingerprint]") -> Card:
    doubtful = [name for name, fingerprint in fingerprints.items() if not fingerprint.verdict.trustworthy]
    words = f"Not trustworthy: {', '.join(doubtful)}." if doubtful else "Each of them is trustworthy."
    return Card(question="Can all results be used?", state="bad" if doubtful else "fine", sentence=words)


def _alike(first: "Fingerprint", others: "Mapping[str, Fingerprint]") -> Card:
    reasons = [sentence for name, other in others.items() for sentence in not_alike(first, name, other)]
    words = " ".join(reasons) if reasons else "Same structure, same working point, signals prepared alike."
    return Card(question="Were the tests alike?", state="look" if reasons else "fine", sentence=words)


def not_alike(first: "Fingerprint", name: str, other: "Fingerprint") -> list[str]:
    """Return in sentences what makes two tests unlike, so that numbers may differ without a change of the ship.

    ``first``, ``other``: two fingerprints. ``name``: name of the second.
    """
    sentences = []
    for quantity, before in (
        (other.conditions.engine_speed, first.conditions.engine_speed),
        (other.conditions.shaft_torque, first.conditions.shaft_torque),
    ):
        if abs(quantity.value / before.value - 1.0) > SAME_WORKING_POINT:
            sentences.append(
                f"{name}: {quantity.meaning} is {plain(quantity.value, 0)} instead of {plain(before.value, 0)} "
                f"{unit_text(before.unit)}; go by the physical values, since normalised ones move with it."
            )
    if other.structure != first.structure:
        sentences.append(f"{name}: structure {other.structure} instead of {first.structure}.")
    if other.conditions.mode != first.conditions.mode:
        sentences.append(f"{name}: signals prepared in {other.conditions.mode} mode, not {first.conditions.mode} mode.")
    return sentences


def _changed(name: str, differences: "Sequence[Difference]", finding: Finding) -> Card:
    question = f"Has anything changed: {name}?"
    if finding.designs:
        return Card(question=question, state="open", sentence=" ".join(finding_sentences(finding)))
    if not finding.because:
        judged: State = "look" if finding.changes else "fine"
        return Card(question=question, state=judged, sentence=" ".join(finding_sentences(finding)))
    of_the_ship = [one for one in differences if not one.normalised]
    changed = any(one.outcome == "differs" for one in of_the_ship)
    comparable = any(one.p_value is not None for one in of_the_ship)
    state: State = "look" if changed else "fine" if comparable else "open"
    return Card(question=question, state=state, sentence=change_in_words(differences))


def change_in_words(found: "Sequence[Difference]") -> str:
    """Return in a sentence whether numbers that stand for the ship have changed, each judged by itself, and which.

    ``found``: differences of two fingerprints.
    """
    of_the_ship = [one for one in found if not one.normalised]
    differing = [one for one in of_the_ship if one.outcome == "differs"]
    if differing:
        return f"Yes: {_listed(differing)}."
    compared = sum(one.p_value is not None for one in of_the_ship)
    if not compared:
        return "It cannot be told: the two share no number that stands for the ship and can be compared."
    many = (
        f"{compared} numbers that stand for the ship agree" if compared > 1 else "one number stands for it, and agrees"
    )
    words = f"No: {many} within chance"
    alone = [one for one in of_the_ship if one.outcome == "perhaps"]
    if not alone:
        return f"{words}."
    return f"{words}. Alone, {_listed(alone)} would be unlikely; among so many numbers it is not."


def _listed(differences: "Sequence[Difference]") -> str:
    words = []
    # margins last: they follow from the other numbers
    differences = sorted(differences, key=lambda one: (one.first.name.endswith(" margin"), one.p_value or 0.0))
    for one in differences[:MOST_NAMED]:
        percent = in_percent(one)
        by = (
            ""
            if percent is None
            else f" by {plain(percent[0], 1)} % ({plain(percent[1], 1)} to {plain(percent[2], 1)} %)"
        )
        words.append(f"{one.first.name}{by}")
    more = len(differences) - MOST_NAMED
    return "; ".join(words) + (f"; and {more} more" if more > 0 else "")
