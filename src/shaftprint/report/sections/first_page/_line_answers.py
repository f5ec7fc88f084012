"""The questions of the superintendent about the line: hunting, inertia, propeller, other contradictions."""

import math
from typing import TYPE_CHECKING

from shaftprint.digits import plain, unit_text, with_deviation
from shaftprint.distributions import NORMAL_95
from shaftprint.fingerprint._vessel_fields import INERTIA
from shaftprint.report.sections._cover import Card, State
from shaftprint.report.sections.first_page._doubts import FAR, TOO_FAR, doubt_of, is_of_reason, is_off, mend
from shaftprint.report.sections.first_page._number_table import inertia_of_file, shown
from shaftprint.signals._load_reasons import LARGEST_BY_DAY
from shaftprint.tables._fingerprint import expected_text, value_text
from shaftprint.units import PERCENT

if TYPE_CHECKING:
    from shaftprint.fingerprint._fingerprint import Fingerprint
    from shaftprint.identify.fit._estimate import Estimate

# A difference of so few standard deviations has no sign worth a word.
NO_DIFFERENCE = 0.5
ANSWERED_ELSEWHERE = ("I_dn", "K_Q")
"""Physical values that have a question of their own."""
SOURCES = {
    "table": "from a table",
    "reconstructed": "reconstructed from other numbers of a table",
}
"""Where an inertia of the vessel file is from, where its own word needs more."""


def hunting(fingerprint: "Fingerprint") -> list[Card]:
    """Return whether the governed line is stable; nothing for a structure without feedback."""
    loop = fingerprint.verdict.loop
    if loop is None:
        return []
    question = "Does the engine hold its speed without hunting?"
    if loop == "unstable":
        return [
            Card(
                question=question,
                state="bad",
                sentence="The identified line is unstable.",
                action="Do not use these numbers. If the engine does hunt, have the governor set before the next test.",
            )
        ]
    state: State = "fine" if loop == "ample" else "look"
    room = "with room to spare" if loop == "ample" else "with little to spare"
    doubt = doubt_of(fingerprint, "gain margin")
    words = f"The governed line is stable{'' if doubt else f', {room}'}."
    margins = [q for q in fingerprint.margins if q.name == "gain margin"]
    if margins:
        value, interval = shown(margins[0])
        words += f" The governor gain may grow by a factor of {value} ({interval}) before the speed hunts; "
        words += "2 or more is usual."
    if doubt:
        return [
            Card(question=question, state="open", sentence=f"{doubt} {words}", action=mend(fingerprint, "gain margin"))
        ]
    action = "" if state == "fine" else "Do not raise the governor gain; have its setting checked at the next service."
    return [Card(question=question, state=state, sentence=words, action=action)]


def inertia(fingerprint: "Fingerprint") -> list[Card]:
    """Return whether the inertia behind the gauge is that of the file; nothing where the test did not measure it."""
    inertias = [q for q in fingerprint.physical if q.name == "I_dn" and q.expected is not None]
    parameter = fingerprint.multiplied(inertias[0]) if inertias else None
    if not inertias or (parameter is not None and parameter.name in fingerprint.priors):
        return []
    (quantity,) = inertias
    question = "Is the inertia of propeller and shaft that of the vessel file?"
    words = (
        f"Measured {with_deviation(quantity.value, quantity.std)} {unit_text(quantity.unit)}, in the vessel file "
        f"{expected_text(quantity)}{_by(fingerprint)}."
    )
    apart, doubt = quantity.deviations_from_expected, doubt_of(fingerprint, "I_dn")
    if doubt or apart is None:
        action = mend(fingerprint, "I_dn")
        return [Card(question=question, state="open", sentence=f"{doubt} {words}".strip(), action=action)]
    if apart <= FAR:
        return [Card(question=question, state="fine", sentence=words)]
    return [
        Card(
            question=question,
            state="look" if apart <= TOO_FAR else "bad",
            sentence=f"{words} That is {plain(apart, 1)} standard deviations apart.",
            action=(
                "Inspect the propeller for a rope, damage or growth; if there is none, correct the inertia table of "
                "the vessel file."
            ),
        )
    ]


def _by(fingerprint: "Fingerprint") -> str:
    """Return where the vessel file has the inertia behind the gauge from; nothing where that is not known."""
    fields = fingerprint.vessel_fields
    rows = [
        path.removesuffix(".gauge")
        for path, value in fields.items()
        if path.startswith(INERTIA) and path.endswith(".gauge") and value == "downstream"
    ]
    sources = dict.fromkeys(str(fields[f"{row}.source"]) for row in rows if f"{row}.source" in fields)
    return f" ({', '.join(SOURCES.get(source, source) for source in sources)})" if sources else ""


def propeller(fingerprint: "Fingerprint") -> list[Card]:
    """Return whether the propeller takes the torque that the vessel file expects; nothing where it expects none."""
    coefficients = [q for q in fingerprint.physical if q.name == "K_Q" and q.expected]
    if not coefficients:
        return []
    (quantity,) = coefficients
    question = "Does the propeller take the torque that it should?"
    words = f"Its torque coefficient is {value_text(quantity)}, in the vessel file {expected_text(quantity)}."
    doubt = doubt_of(fingerprint, "K_Q")
    if not is_of_reason(fingerprint, "K_Q"):
        words += _power_for_speed(quantity)
    if doubt or not quantity.std < float("inf"):
        return [
            Card(question=question, state="open", sentence=f"{doubt} {words}".strip(), action=mend(fingerprint, "K_Q"))
        ]
    if is_off(quantity):
        return [
            Card(
                question=question,
                state="look",
                sentence=f"{words} The propeller, its inflow or the torque gauge has changed.",
                action=(
                    "Inspect the propeller, and check zero and scale of the torque gauge. If another propeller is "
                    "fitted, correct the vessel file."
                ),
            )
        ]
    if not _is_another_size(quantity, fingerprint):
        return [Card(question=question, state="fine", sentence=words)]
    return [
        Card(
            question=question,
            state="look",
            sentence=f"{words} The vessel file knows it too badly to say what is wrong, and no day of one propeller "
            "makes so much of it.",
            action=(
                "Check diameter and pitch of the propeller, the gear ratio and the scale of the torque in the vessel "
                "file, and whether the recording is of this ship."
            ),
        )
    ]


def _is_another_size(coefficient: "Estimate", fingerprint: "Fingerprint") -> bool:
    """Return whether a torque is as far from a guess of the vessel file as weather and fouling never make it."""
    if (
        not coefficient.expected
        or coefficient.value <= 0.0
        or any(one.startswith("pitch.") for one in fingerprint.vessel_fields)
    ):
        return False
    away = abs(math.log(coefficient.value / coefficient.expected))
    return away - FAR * coefficient.std / coefficient.value > math.log(LARGEST_BY_DAY)


def _power_for_speed(quantity: "Estimate") -> str:
    """Return what another torque coefficient means: torque and power at one speed go with it, and fuel with power."""
    expected = quantity.expected
    if not expected or not quantity.value or not math.isfinite(quantity.std):
        return ""
    ratio = quantity.value / expected
    std = abs(ratio) * math.hypot(quantity.std / quantity.value, (quantity.expected_std or 0.0) / expected)
    if abs(ratio - 1.0) < NO_DIFFERENCE * std:
        within = plain(PERCENT * NORMAL_95 * std, 0)
        return f" At one speed of the shaft that is as much torque, power and fuel, to within {within} %."
    apart = with_deviation(PERCENT * abs(ratio - 1.0), PERCENT * std)
    way = "less" if ratio < 1.0 else "more"
    return f" At one speed of the shaft that is {apart} % {way} torque and power, and about as much {way} fuel."


def other_contradictions(fingerprint: "Fingerprint") -> list[Card]:
    """Return what else is far from the vessel file, such as the inertia of the engine; nothing where nothing is."""
    off = [
        q
        for q in fingerprint.physical
        if q.name not in ANSWERED_ELSEWHERE and is_off(q) and not doubt_of(fingerprint, q.name)
    ]
    if not off:
        return []
    return [
        Card(
            question="Does all else agree with the vessel file?",
            state="look",
            sentence=" ".join(_contradiction(quantity, fingerprint) for quantity in off),
            action="Check these entries of the vessel file, and what was changed on board since it was written.",
        )
    ]


def _contradiction(quantity: "Estimate", fingerprint: "Fingerprint") -> str:
    told = inertia_of_file(fingerprint, "upstream") if quantity.name == "I_up" else ""
    file = f" ({told})" if told else ""
    value, interval = shown(quantity)
    what = quantity.meaning or quantity.name
    return f"{what[:1].upper()}{what[1:]}: {value} ({interval}), in the vessel file {expected_text(quantity)}{file}."
