"""What two tests say about a change of the ship, in sentences: what, by how much, and with which odds."""

from collections.abc import Sequence

from shaftprint.digits import p_value_text, plain_letters, stated
from shaftprint.drift._causes import MILLISECONDS, PERCENT
from shaftprint.drift._finding import Candidate, Change, Finding

# Causes whose likelihoods differ by less than this factor are named together.
ALIKE = 3.0
# Odds beyond this are said as such: the model itself is not known that well.
MOST_ODDS = 1000.0
UNEXPLAINED = 0.001
"""Where chance leaves as much in fewer cases than this, something else has changed."""


def finding_sentences(finding: Finding) -> tuple[str, ...]:
    """Return whether the ship has changed and what may have changed, the answer first.

    Parameters
    ----------
    finding
        What ``differ`` has found.
    """
    if finding.because:
        return (f"It cannot be told: {finding.because}.",)
    count = len(finding.names)
    rest = finding.rest_p_value if finding.rest_p_value is not None else 1.0
    unexplained = rest < UNEXPLAINED
    if not finding.changes:
        if unexplained:
            return (
                f"Perhaps: {count} numbers, judged together, differ by more than chance ({_p(rest)}), and by none of "
                "the causes that are known; look at each number, and at the conditions of both tests.",
            )
        return (f"No: {count} numbers of the ship, judged together, agree within chance.",)
    sentences = [f"Yes: {_of_change(finding.changes[0])}"]
    sentences += [f"Beside it {_of_change(change)}" for change in finding.changes[1:]]
    if unexplained:
        sentences.append(f"That does not explain all of the difference ({_p(rest)}): look at each number too.")
    return tuple(sentences)


def size_text(candidate: Candidate) -> str:
    """Return the size of a change with its standard deviation, without a sign, as sentences have it."""
    factor = PERCENT if candidate.cause.is_share else MILLISECONDS
    return stated(factor * abs(candidate.size), factor * candidate.std, candidate.cause.unit)


def _of_change(change: Change) -> str:
    alike = [one for one in change.candidates if one.odds < ALIKE]
    named = ", or ".join(f"{one.words}, by {size_text(one)}" for one in alike)
    rest = change.candidates[len(alike) :]
    odds = f" Odds {_odds(rest[0])} against {rest[0].words}." if rest else ""
    told = "" if len(alike) == 1 else f" {_how_to_tell(alike)}"
    return f"{named}.{odds}{told}"


def _odds(candidate: Candidate) -> str:
    odds = candidate.odds
    return f"more than {MOST_ODDS:g} : 1" if odds > MOST_ODDS else f"{odds:.0f} : 1"


def _how_to_tell(alike: Sequence[Candidate]) -> str:
    ways = dict.fromkeys(one.cause.told_by for one in alike)
    return f"This pair of tests hardly tells them apart: {'; '.join(ways)}."


def _p(p_value: float) -> str:
    return plain_letters(f"p = {p_value_text(p_value)}")
