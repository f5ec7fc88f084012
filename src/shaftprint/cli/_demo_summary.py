"""The last lines of the demo: what was found, in words, with the truth beside it."""

from __future__ import annotations

from collections.abc import Mapping

from shaftprint.cli._terminal import print_findings
from shaftprint.digits import plain_letters, stated, stated_interval, to_digit_of
from shaftprint.late import late

with late():
    from shaftprint import distributions
    from shaftprint.catalogue._roles import ShipRole
    from shaftprint.fingerprint._fingerprint import Fingerprint
    from shaftprint.identify.fit._estimate import Estimate
    from shaftprint.identify.fit._identification import Identification


def print_summary(fingerprint: Fingerprint, truth: Mapping[str, float], core: Identification) -> None:
    """Print what an engineer wants to know, each with its truth."""
    sentences = []
    for name, words in SENTENCES.items():
        quantity = fingerprint.quantity(name)
        unit = "" if quantity.unit == "-" else f" {quantity.unit}"
        true = plain_letters(to_digit_of(truth[name], _shown_std(quantity)))
        sentences.append(f"{words}: {_value(quantity)}{_given(quantity, fingerprint)}; true value {true}{unit}.")
    print_findings("What was found", [*sentences, *_of_the_thesis(fingerprint, core)], is_answer=True)


def _value(quantity: Estimate) -> str:
    """Return the value with its 95 % interval, or with its standard deviation where there is no interval."""
    if quantity.interval_95 is None:
        return stated(quantity.value, quantity.std, quantity.unit)
    lower, upper = quantity.interval_95
    return stated_interval(quantity.value, lower, upper, _shown_std(quantity), quantity.unit)


def _shown_std(quantity: Estimate) -> float:
    """Return the standard deviation that the digits follow: that of the interval, where there is one."""
    if quantity.interval_95 is None:
        return quantity.std
    lower, upper = quantity.interval_95
    return 0.5 * (upper - lower) / distributions.NORMAL_95


def _given(quantity: Estimate, fingerprint: Fingerprint) -> str:
    """Return that a physical value was known beforehand, if its parameter was: then the test did not find it."""
    parameter = fingerprint.multiplied(quantity)
    if parameter is None or parameter.name not in fingerprint.priors or quantity.expected is None:
        return ""
    prior = stated(quantity.expected, quantity.expected_std or 0.0, quantity.unit)
    return f", with the prior of the vessel file {prior}"


SENTENCES = {
    "I_dn": "Propeller, shaft and entrained water, the inertia behind the torque gauge",
    "I_up": "Engine, coupling and gearbox, the inertia before the torque gauge",
    "k_q": "The propeller torque grows with this power of the speed; 2 says that gauge and inflow are in order",
    "t_d + t_sp": "Total delay from the set point to the fuel",
    "K_p / K_i": "The governor's reset time",
    "gain margin": "Gain margin: the governor gain may grow by this factor before the speed oscillates",
    "delay margin": "Delay margin: this much more delay in the loop makes the speed oscillate",
}


def _of_the_thesis(fingerprint: Fingerprint, core: Identification) -> list[str]:
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
