"""What has changed since an earlier test, in words for the first page."""

from typing import TYPE_CHECKING

from shaftprint.digits import plain
from shaftprint.drift._differ import differ
from shaftprint.drift._words import finding_sentences
from shaftprint.report.comparison._differences import differences
from shaftprint.report.figures._differences import in_percent
from shaftprint.report.sections._cover import Card

if TYPE_CHECKING:
    from shaftprint.fingerprint._fingerprint import Fingerprint
    from shaftprint.report.comparison._differences import Difference

MOST_NAMED = 3
WORDS = {
    "I_dn": "the inertia of propeller and shaft",
    "I_up": "the inertia of engine and gear",
    "K_Q": "the torque coefficient of the propeller",
    "t_d + t_sp": "the delay from set point to fuel",
    "gauge zero share": "the zero of the torque gauge",
}
"""Numbers as a superintendent calls them; others by their meaning."""
ASK = "Ask what was done to propeller, governor, gear and torque gauge between the two tests."


def change_answer(previous: "Fingerprint", fingerprint: "Fingerprint") -> Card:
    """Return whether numbers that stand for the ship have changed since an earlier test, and which."""
    tested = previous.conditions.tested_at or previous.created
    question = f"Has anything changed since {tested:%Y-%m-%d}?"
    doubtful = [one for one in (previous, fingerprint) if not one.verdict.trustworthy]
    if doubtful:
        which = "the earlier test" if doubtful[0] is previous else "this test"
        return Card(
            question=question,
            state="open",
            sentence=f"It cannot be told: {which} is not trustworthy.",
            action="Compare with another test that can be trusted.",
        )
    finding = differ(previous, fingerprint)
    if finding.designs:
        return Card(
            question=question,
            state="open",
            sentence=" ".join(finding_sentences(finding)),
            action="Name an earlier test of this ship.",
        )
    if not finding.because:
        return Card(
            question=question,
            state="look" if finding.changes else "fine",
            sentence=" ".join(finding_sentences(finding)),
            action=ASK if finding.changes else "",
        )
    of_the_ship = [one for one in differences(previous, fingerprint) if not one.normalised]
    changed = [one for one in of_the_ship if one.outcome == "differs"]
    compared = sum(one.p_value is not None for one in of_the_ship)
    if changed:
        return Card(
            question=question,
            state="look",
            sentence=f"Yes: {_listed(changed)}.",
            action=ASK,
        )
    if not compared:
        return Card(
            question=question,
            state="open",
            sentence="It cannot be told: the two tests share no number that can be compared.",
            action="Identify both tests with the same structure.",
        )
    return Card(question=question, state="fine", sentence=f"No: {compared} numbers agree within chance.")


def _listed(changed: "list[Difference]") -> str:
    # margins last: they follow from the other numbers
    ordered = sorted(changed, key=lambda one: (one.first.name.endswith(" margin"), one.p_value or 0.0))
    more = len(ordered) - MOST_NAMED
    return "; ".join(map(_worded, ordered[:MOST_NAMED])) + (f"; and {more} more" if more > 0 else "")


def _worded(change: "Difference") -> str:
    what = WORDS.get(change.first.name) or change.first.meaning or change.first.name
    percent = in_percent(change)
    return what if percent is None else f"{what} by {plain(percent[0], 0)} %"
