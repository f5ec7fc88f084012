"""The questions of the superintendent, answered from a fingerprint: each answer is one rule."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from shaftprint.distributions import NORMAL_95
from shaftprint.fingerprint import GAUGE_ZERO
from shaftprint.report.sections._cover import Card, Cover, State, overall
from shaftprint.tables import (
    Table,
    decimals_of,
    expected_text,
    interval,
    limits,
    numbers,
    plain,
    texts,
    unit_text,
    with_deviation,
)

if TYPE_CHECKING:
    from shaftprint.fingerprint import Fingerprint, Quantity
    from shaftprint.validation import Validation

# An inertia may differ from the calculated one by so many standard deviations of both before anyone should look.
FAR, TOO_FAR = 2.0, 3.5
# Zero of the torque gauge that is common, as a share of the torque [%]: 0.5 to 1 % of full scale, taken at half load.
COMMON_ZERO = 2.0
# Share of the test lines that may be left out before anyone should look.
LEFT_OUT = 0.25
# Share of the numbers that must be known before all is fine.
MOST = 2.0 / 3.0
PERCENT = 100.0
NUMBERS = (
    ("I_dn", "Inertia behind the torque gauge: propeller, shaft, entrained water"),
    ("I_up", "Inertia before the torque gauge: engine, coupling, gearbox"),
    ("K_Q", "Torque coefficient of the propeller"),
    ("t_d + t_sp", "Delay from the set point to the fuel"),
    ("gain margin", "The governor gain may grow by this factor before the speed hunts"),
    ("delay margin", "So much more delay would make the speed hunt"),
)


def cover_of(fingerprint: "Fingerprint", validations: "Sequence[Validation]" = ()) -> Cover:
    """Return the first screen of a report.

    Parameters
    ----------
    fingerprint
        What was found.
    validations
        The fingerprint's model held against records that it has not seen; only the first counts.
    """
    cards = [
        _usable(fingerprint),
        *_stable(fingerprint),
        *_inertia(fingerprint),
        *_propeller(fingerprint),
        *_gauge(fingerprint),
        _predicts(validations),
        _measured(fingerprint),
    ]
    state, headline = overall(cards, usable=fingerprint.verdict.trustworthy)
    return Cover(
        headline=headline, state=state, opening=_opening(fingerprint), cards=cards, tables=_numbers(fingerprint)
    )


def _opening(fingerprint: "Fingerprint") -> str:
    conditions = fingerprint.conditions
    speed, torque = conditions.engine_speed, conditions.shaft_torque
    return (
        f"Everything here holds at {plain(speed.value, 0)} {unit_text(speed.unit)} engine speed and "
        f"{plain(torque.value, 0)} {unit_text(torque.unit)} shaft torque. ± is one standard deviation; where a range "
        "is given, the true value lies in it in 95 of 100 tests."
    )


def _usable(fingerprint: "Fingerprint") -> Card:
    question = "Can the result be used?"
    if not fingerprint.verdict.trustworthy:
        return Card(question=question, state="bad", sentence=fingerprint.verdict.reason)
    verdict = fingerprint.verdict
    trusted, others = len(verdict.trusted), len(verdict.not_trusted)
    count = f"{trusted} of {trusted + others} numbers are known well enough to be used."
    if verdict.reasons:
        return Card(question=question, state="look", sentence=f"Only in part. {verdict.reasons[0].sentence} {count}")
    words = f"The model explains the measured lines within their noise, and no other values do so. {count}"
    many = trusted >= MOST * (trusted + others)
    return Card(question=question, state="fine" if many else "look", sentence=words)


def _stable(fingerprint: "Fingerprint") -> list[Card]:
    """Return whether the governed line is stable; nothing for a structure without feedback."""
    loop = fingerprint.verdict.loop
    if loop is None:
        return []
    margins = [q for q in fingerprint.margins if q.name == "gain margin"]
    if loop == "unstable":
        state: State = "bad"
        words = "The identified line is unstable."
    else:
        state = "fine" if loop == "ample" else "look"
        words = "The governed line is stable" + (
            " with room to spare." if loop == "ample" else ", with little to spare."
        )
    if margins and loop != "unstable":
        words += f" The governor gain may grow by {_ranged(margins[0])} before the speed hunts; 2 or more is usual."
    question = "Does the engine hold its speed without hunting?"
    doubt = _doubt(fingerprint, "gain margin")
    if doubt and loop != "unstable":
        return [Card(question=question, state="open", sentence=f"{doubt} {words}")]
    return [Card(question=question, state=state, sentence=words)]


def _ranged(quantity: "Quantity") -> str:
    """Return a value with its 95 % interval."""
    lower, upper = limits(quantity)
    text = plain(quantity.value, decimals_of(quantity.value, quantity.std))
    unit = unit_text(quantity.unit)
    return f"{text} ({interval(lower, upper, quantity.std)}{f' {unit}' if unit else ''})"


def _inertia(fingerprint: "Fingerprint") -> list[Card]:
    """Return whether the inertia behind the gauge is the calculated one; nothing where the test did not measure it."""
    inertias = [q for q in fingerprint.physical if q.name == "I_dn" and q.expected is not None]
    parameter = fingerprint.multiplied(inertias[0]) if inertias else None
    if not inertias or (parameter is not None and parameter.name in fingerprint.priors):
        return []
    (quantity,) = inertias
    question = "Is the inertia of propeller and shaft as calculated?"
    words = (
        f"Measured {with_deviation(quantity.value, quantity.std)} {unit_text(quantity.unit)}, by the torsional "
        f"vibration calculation {expected_text(quantity)}."
    )
    spread = (quantity.std**2 + (quantity.expected_std or 0.0) ** 2) ** 0.5
    doubt = _doubt(fingerprint, "I_dn")
    if doubt or not 0.0 < spread < float("inf"):
        return [Card(question=question, state="open", sentence=f"{doubt} {words}".strip())]
    apart = abs(quantity.value - (quantity.expected or 0.0)) / spread
    state: State = "fine" if apart <= FAR else "look" if apart <= TOO_FAR else "bad"
    reason = "" if state == "fine" else f" That is {plain(apart, 1)} standard deviations apart."
    return [Card(question=question, state=state, sentence=words + reason)]


def _propeller(fingerprint: "Fingerprint") -> list[Card]:
    """Return whether the propeller takes the torque that the vessel file expects; nothing where it expects none."""
    coefficients = [q for q in fingerprint.physical if q.name == "K_Q" and q.expected]
    if not coefficients:
        return []
    (quantity,) = coefficients
    question = "Does the propeller take the torque that it should?"
    share = PERCENT * (quantity.value / (quantity.expected or quantity.value) - 1.0)
    words = (
        f"Its torque coefficient is {with_deviation(quantity.value, quantity.std)}, {plain(share, 1)} % beside the "
        f"{expected_text(quantity)} of the vessel file."
    )
    doubt = _doubt(fingerprint, "K_Q")
    if doubt or not quantity.std < float("inf"):
        return [Card(question=question, state="open", sentence=f"{doubt} {words}".strip())]
    if _is_off(quantity):
        words += " The propeller, its inflow or the torque gauge has changed."
        return [Card(question=question, state="look", sentence=words)]
    return [Card(question=question, state="fine", sentence=words)]


def _is_off(quantity: "Quantity") -> bool:
    """Return whether a number is farther from the vessel file than its deviations let expect."""
    if not quantity.expected:
        return False
    spread = (quantity.std**2 + (quantity.expected_std or 0.0) ** 2) ** 0.5
    return bool(abs(quantity.value - quantity.expected) > TOO_FAR * spread)


def _doubt(fingerprint: "Fingerprint", name: str) -> str:
    """Return that a number is not trusted, as a sentence; nothing where it is."""
    verdict = fingerprint.verdict
    if not verdict.trustworthy:
        return "The model is not trustworthy."
    reason = verdict.not_trusted.get(name)
    return f"It cannot be told: {reason}." if reason else ""


def _gauge(fingerprint: "Fingerprint") -> list[Card]:
    """Return whether the zero of the torque gauge is in order; nothing where the test cannot tell."""
    zeros = [q for q in fingerprint.physical if q.name == GAUGE_ZERO]
    if not zeros:
        return []
    (zero,) = zeros
    question = "Is the torque gauge in order?"
    half = NORMAL_95 * zero.std
    words = (
        f"Torque and speed go together as they must in bollard pull when the zero of the gauge is off by "
        f"{with_deviation(zero.value, zero.std)} % of the torque; up to {plain(COMMON_ZERO, 0)} % is common."
    )
    if not fingerprint.verdict.trustworthy or not half < float("inf"):
        return [Card(question=question, state="open", sentence=words)]
    if abs(zero.value) + half <= COMMON_ZERO:
        return [Card(question=question, state="fine", sentence=words)]
    state: State = "look" if abs(zero.value) - half > COMMON_ZERO else "open"
    return [Card(question=question, state=state, sentence=words)]


def _predicts(validations: "Sequence[Validation]") -> Card:
    question = "Does the model predict what it has not seen?"
    if not validations:
        return Card(
            question=question, state="open", sentence="No chirp or staircase of this test was held against the model."
        )
    validation = validations[0]
    states: dict[str, State] = {"passes": "fine", "undecided": "open", "fails": "look"}
    return Card(question=question, state=states[validation.outcome], sentence=validation.sentences[0])


def _measured(fingerprint: "Fingerprint") -> Card:
    conditions, quality = fingerprint.conditions, fingerprint.quality
    used, left_out = len(conditions.lines_used), len(conditions.lines_left_out)
    repairs = sum(quality.repairs.values())
    words = f"{used} of {used + left_out} test lines could be used"
    words += f", {repairs} {'place was' if repairs == 1 else 'places were'} repaired." if repairs else "; no repairs."
    many = left_out > LEFT_OUT * (used + left_out)
    if many:
        reasons = "; ".join(f"{line}: {why}" for line, why in list(conditions.lines_left_out.items())[:2])
        words += f" Left out: {reasons}{' and others' if left_out > 2 else ''}."
    if quality.remarks:
        remark = quality.remarks[0].rstrip(".")
        words += f" {remark[:1].upper()}{remark[1:]}."
    return Card(
        question="Were the measurements good?", state="look" if many or quality.remarks else "fine", sentence=words
    )


def _numbers(fingerprint: "Fingerprint") -> list[Table]:
    """Return the numbers that a superintendent asks for, as far as they are there."""
    there = {q.name: q for q in (*fingerprint.physical, *fingerprint.combinations, *fingerprint.margins)}
    rows: list[tuple[str, ...]] = []
    for name, words in NUMBERS:
        quantity = there.get(name)
        if quantity is None:
            continue
        lower, upper = limits(quantity)
        unit = unit_text(quantity.unit)
        value = f"{plain(quantity.value, decimals_of(quantity.value, quantity.std))} {unit}".strip()
        expected = expected_text(quantity) + (" (!)" if _is_off(quantity) else "")
        marked = words if not _doubt(fingerprint, name) else f"{words} (not to be used)"
        rows.append((marked, value, interval(lower, upper, quantity.std), expected))
    if not rows:
        return []
    columns = (*texts("what"), *numbers("found", "95 % interval", "vessel file"))
    return [Table(title="What was found", columns=columns, rows=tuple(rows))]
