"""What was found, in words: the numbers that an engineer wants to know, each with what else is known of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from shaftprint.digits import after_number, plain_letters, stated, to_digit_of
from shaftprint.late import late

with late():
    from shaftprint.catalogue._roles import ShipRole
    from shaftprint.fingerprint._drive_fingerprint import DriveFingerprint
    from shaftprint.fingerprint._fingerprint import Fingerprint
    from shaftprint.fingerprint._vessel_fields import inertia_in_words
    from shaftprint.identify.fit._estimate import Estimate
    from shaftprint.identify.fit._identification import Identification

MOST_PARAMETERS = 12
"""So many parameters are told where a structure has none of the numbers that have words of their own."""


def found_sentences(fingerprint: Fingerprint, truth: Mapping[str, float]) -> tuple[list[str], list[str]]:
    """Return what was found, and what was found but is not to be used and why, a sentence for each number.

    A structure with none of the numbers that have words here is told by its parameters.

    ``truth``: true values by name, where they are known.
    """
    there = {one.name: one for kind in fingerprint.numbers.values() for one in kind}
    doubts = fingerprint.verdict.not_trusted
    usable: list[str] = []
    unusable: list[str] = []
    for name in [name for name in SENTENCES if name in there]:
        quantity = there[name]
        given = _given(quantity, fingerprint) or ("" if name in truth else _beside(quantity, fingerprint))
        true = _true(quantity, truth[name]) if name in truth else ""
        doubt = f"; {doubts[name]}" if name in doubts else ""
        words = SENTENCES[name] or quantity.meaning.capitalize()
        symbol = "" if words.lower().startswith(name) else f" ({name})"
        (unusable if doubt else usable).append(f"{words}{symbol}: {quantity.in_words}{given}{true}{doubt}.")
    return (usable, unusable) if usable or unusable else (_of_parameters(fingerprint.parameters, doubts), [])


def drive_sentences(fingerprint: DriveFingerprint) -> list[str]:
    """Return the parameters of a drive, a sentence for each."""
    return _of_parameters(fingerprint.parameters, fingerprint.verdict.not_trusted)


def _of_parameters(parameters: Sequence[Estimate], doubts: Mapping[str, str]) -> list[str]:
    sentences = []
    for one in parameters[:MOST_PARAMETERS]:
        doubt = f"; not to be used: {doubts[one.name]}" if one.name in doubts else ""
        sentences.append(f"{one.name}{f', {one.meaning}' if one.meaning else ''}: {one.in_words}{doubt}.")
    more = len(parameters) - MOST_PARAMETERS
    return [*sentences, f"{more} parameters more, in the report."] if more > 0 else sentences


def _true(quantity: Estimate, true: float) -> str:
    value = plain_letters(to_digit_of(true, quantity.interval_std))
    return f"; true value {value}{after_number(quantity.unit)}"


def _beside(quantity: Estimate, fingerprint: Fingerprint) -> str:
    """Return what the vessel file says of it, where it is a physical value that the file has."""
    if not quantity.expected:
        return ""
    expected = plain_letters(to_digit_of(quantity.expected, quantity.interval_std))
    if quantity.expected_std:
        expected = stated(quantity.expected, quantity.expected_std, quantity.unit)
    return f", in the vessel file {expected}{_at_engine(quantity, fingerprint)}"


def _given(quantity: Estimate, fingerprint: Fingerprint) -> str:
    """Return that a physical value was known beforehand, if its parameter was: then the test did not find it."""
    parameter = fingerprint.multiplied(quantity)
    if parameter is None or parameter.name not in fingerprint.priors or quantity.expected is None:
        return ""
    prior = stated(quantity.expected, quantity.expected_std or 0.0, quantity.unit)
    return f", with the prior of the vessel file {prior}{_at_engine(quantity, fingerprint)}"


def _at_engine(quantity: Estimate, fingerprint: Fingerprint) -> str:
    """Return what the vessel file states of an inertia at the engine's shaft, in brackets; nothing of others."""
    side = {"I_up": "upstream", "I_dn": "downstream"}.get(quantity.name)
    words = "" if side is None else inertia_in_words(fingerprint.vessel_fields, side)
    return f" ({words})" if words else ""


# None: its own meaning, which goes with the structure.
SENTENCES: Mapping[str, str | None] = {
    "I_dn": "Propeller, shaft and entrained water, the inertia behind the torque gauge",
    "I_up": "Engine, coupling and gearbox, the inertia before the torque gauge",
    "K_Q": "Torque coefficient of the propeller",
    "k_q": "The propeller torque grows with this power of the speed; 2 says that gauge and inflow are in order",
    "t_d + t_sp": "Total delay from the set point to the fuel",
    "K_p": None,
    "K_i": None,
    "K_p / K_i": "Governor reset time",
    "gain margin": "Gain margin: the governor gain may grow by this factor before the speed oscillates",
    "delay margin": "Delay margin: this much more delay in the loop makes the speed oscillate",
}


def thesis_sentences(fingerprint: Fingerprint, core: Identification) -> list[str]:
    """Return what the thesis' way finds in the same recording, and why."""
    upstream = fingerprint.quantity("I_up")
    inertia_time, core_name = fingerprint.multiplied(upstream), core.structure.named_as(ShipRole.INERTIA)
    if upstream.expected is None or inertia_time is None or core_name is None:
        return []
    tau, expected = core.value(core_name), inertia_time.value * upstream.expected / upstream.value
    return [
        f"The thesis' way finds an inertia time of {tau:.3f} s in the same recording and expects {expected:.3f} s from "
        f"the {upstream.expected:.1f} kg m2 before the gauge: a factor {expected / tau:.1f}. A gauge shows only what "
        "is behind it, and the delay of the pick-up adds to that."
    ]
