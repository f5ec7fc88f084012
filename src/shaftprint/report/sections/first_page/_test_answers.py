"""The questions of the superintendent about the test: is it of use, is the gauge in order, were the signals good."""

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

from shaftprint.catalogue._roles import ShipRole
from shaftprint.digits import plain, with_deviation
from shaftprint.distributions import NORMAL_95
from shaftprint.fingerprint._physical import GAUGE_ZERO
from shaftprint.identify.judgement._main_numbers import groups_lost
from shaftprint.report.sections._cover import Card, State
from shaftprint.report.sections.first_page._reason_words import words_of
from shaftprint.units import PERCENT

if TYPE_CHECKING:
    from shaftprint.fingerprint._fingerprint import Fingerprint
    from shaftprint.validation._validation import Validation

# Zero of the torque gauge that is common, as a share of the torque [%]: 0.5 to 1 % of full scale, taken at half load.
COMMON_ZERO = 2.0
# Share of the test signals that may be left out before anyone should look.
LEFT_OUT = 0.25
# Share of the fitted test signals that should be clear of the noise.
CLEAR = 0.5
# The file of a fingerprint has them in words.
_GOOD = re.compile(r"(\d+) good spectral lines of (\d+)")
# Share of the numbers that must be known before all is fine.
MOST = 2.0 / 3.0
READ_REMARKS = "Read the remarks under Findings, and mend what they name"


def usable(fingerprint: "Fingerprint") -> Card:
    """Return whether the numbers may be used."""
    question = "Can the result be used?"
    verdict = fingerprint.verdict
    trusted, others = len(verdict.trusted), len(verdict.not_trusted)
    count = f"{trusted} of {trusted + others} numbers are known well enough to be used."
    if verdict.reasons:
        words, action = words_of(verdict.reasons[0])
        if not verdict.trustworthy:
            return Card(question=question, state="bad", sentence=words, action=action)
        return Card(question=question, state="look", sentence=f"Only in part. {words} {count}", action=action)
    if not verdict.trustworthy:
        return Card(
            question=question,
            state="bad",
            sentence="No number is known well enough.",
            action="Repeat the test with larger and longer moves of the set point.",
        )
    words = f"The model explains the measurements within their noise, and no other values do so. {count}"
    if trusted >= MOST * (trusted + others) and not is_partial(fingerprint):
        return Card(question=question, state="fine", sentence=words)
    return Card(
        question=question,
        state="look",
        sentence=words,
        action="Use only the numbers that are not marked. A longer test, or the engine's control unit logged as well, "
        "makes more of them known.",
    )


def is_partial(fingerprint: "Fingerprint") -> bool:
    """Return whether something that a test is made for, such as the governor's gains, cannot be used at all."""
    return bool(groups_lost(fingerprint.verdict.trusted, fingerprint.verdict.not_trusted))


def not_judged(card: Card) -> Card:
    """Return a question without its answer, which needs numbers that can be used."""
    return Card(
        question=card.question, state="open", answer="Not judged", sentence="It needs numbers that can be used."
    )


def gauge(fingerprint: "Fingerprint") -> list[Card]:
    """Return whether the zero of the torque gauge is in order; nothing where the test cannot tell."""
    zeros = [q for q in fingerprint.physical if q.name == GAUGE_ZERO]
    slopes = [q.name for q in fingerprint.parameters if q.role == ShipRole.LOAD_SLOPE]
    # underway the speed of the ship moves the torque too: what is said of the zero is what the vessel file says
    if not zeros or any(name in fingerprint.priors for name in slopes):
        return []
    (zero,) = zeros
    question = "Is the torque gauge in order?"
    half = NORMAL_95 * zero.std
    words = (
        f"Zero error of the gauge: {with_deviation(zero.value, zero.std)} % of the torque; up to "
        f"{plain(COMMON_ZERO, 0)} % is common. It is found from the torque, which follows the square "
        "of the speed in bollard pull."
    )
    if fingerprint.verdict.trustworthy and abs(zero.value) + half <= COMMON_ZERO:
        return [Card(question=question, state="fine", sentence=words)]
    told = fingerprint.verdict.trustworthy and half < float("inf") and abs(zero.value) - half > COMMON_ZERO
    return [
        Card(
            question=question,
            state="look" if told else "open",
            sentence=words,
            action="Take the zero of the gauge with the shaft standing free, before and after the next test.",
        )
    ]


def predicts(validations: "Sequence[Validation]") -> Card:
    """Return whether the model predicts chirps and steps that it has not seen."""
    question = "Does the model predict what it has not seen?"
    if not validations:
        return Card(
            question=question,
            state="open",
            sentence="It was not held against speed steps or sweeps: the test holds none, or they cannot be predicted "
            "with this structure.",
            action="Add a staircase of speed steps to the next test where it has none.",
        )
    validation = validations[0]
    moves = [c for c in validation.comparisons if not c.excerpt.in_sample]
    failed = sum(c.outcome == "fails" for c in moves)
    allowed = f"{plain(PERCENT * validation.settings.largest_error, 0)} %"
    states: dict[str, State] = {"passes": "fine", "undecided": "open", "fails": "look"}
    words = {
        "passes": f"It predicts all {len(moves)} recorded speed changes to within {allowed}.",
        "undecided": f"It misses none of {len(moves)} recorded speed changes, but noise hides how well it meets them.",
        "fails": f"It misses {failed} of {len(moves)} recorded speed changes by more than {allowed}: the line answers "
        "large changes otherwise than small ones.",
    }
    actions = {
        "passes": "",
        "undecided": "Repeat the speed steps in calmer water, or make them larger where the limits leave room.",
        "fails": "Use the model for small changes of speed only; `shaftprint limits` finds what limits large ones.",
    }
    outcome = validation.outcome
    return Card(question=question, state=states[outcome], sentence=words[outcome], action=actions[outcome])


def measured(fingerprint: "Fingerprint") -> Card:
    """Return whether the signals were good."""
    conditions, quality = fingerprint.conditions, fingerprint.quality
    used, left_out = len(conditions.lines_used), len(conditions.lines_left_out)
    repairs = sum(quality.repairs.values())
    good = _GOOD.search(fingerprint.verdict.reason)
    clear, fitted = (int(count or 0) for count in good.groups()) if good else (0, 0)
    words = (
        f"{left_out} of {used + left_out} test frequencies were left out of the fit"
        if left_out
        else "All test frequencies went into the fit, each weighted by its noise"
    )
    words += f", {repairs} {'place was' if repairs == 1 else 'places were'} repaired." if repairs else "; no repairs."
    noisy = clear < CLEAR * fitted
    if noisy:
        words += f" {clear} of {fitted} in the fit stand clear of the noise."
    many = left_out > LEFT_OUT * (used + left_out)
    remarks = len(quality.remarks)
    if remarks == 1:
        words += f" One remark: {quality.remarks[0].removesuffix('.')}."
    elif remarks:
        words += f" There are {remarks} remarks on the signals."
    actions = []
    if many:
        actions.append(
            "Read under Data quality why so many test frequencies were left out before the test is repeated."
        )
    if noisy:
        actions.append("Repeat the test with larger or longer moves, or in calmer water, for more of the numbers.")
    if remarks:
        actions.append(f"{'Mend the cause' if remarks == 1 else READ_REMARKS}: a sensor, its wiring, or the test.")
    return Card(
        question="Were the measurements good?",
        state="look" if actions else "fine",
        sentence=words,
        action=" ".join(actions),
    )
