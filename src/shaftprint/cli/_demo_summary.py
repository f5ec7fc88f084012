"""The last lines of the demo: what was found, in words, with the truth beside it."""

from collections.abc import Mapping

from shaftprint.catalogue import ShipRole
from shaftprint.cli._numbers import plain, with_uncertainty
from shaftprint.cli._terminal import echo
from shaftprint.fingerprint import Fingerprint, Quantity
from shaftprint.identify import Identification


def print_summary(fingerprint: Fingerprint, truth: Mapping[str, float], core: Identification) -> None:
    """Print what an engineer wants to know, each with its truth."""
    echo("What was found")
    for name, words in SENTENCES.items():
        quantity = fingerprint.quantity(name)
        unit = "" if quantity.unit == "-" else f" {quantity.unit}"
        given = _given(quantity, fingerprint)
        echo(f"  * {words}: {_value(quantity)}{unit}{given}; in truth {plain(truth[name])}{unit}.")
    for sentence in _of_the_thesis(fingerprint, core):
        echo(f"  * {sentence}")
    echo()


def _value(quantity: Quantity) -> str:
    """Return the value with its 95 % interval, or with its standard deviation where there is no interval."""
    if quantity.interval_95 is None:
        return with_uncertainty(quantity.value, quantity.std)
    lower, upper = quantity.interval_95
    return f"{plain(quantity.value)}, 95 % between {plain(lower)} and {plain(upper)}"


def _given(quantity: Quantity, fingerprint: Fingerprint) -> str:
    """Return that a physical value was known beforehand, if its parameter was: then the test did not find it."""
    parameter = fingerprint.multiplied(quantity)
    if parameter is None or parameter.name not in fingerprint.priors or quantity.expected is None:
        return ""
    return f", known from the vessel file as {with_uncertainty(quantity.expected, quantity.expected_std or 0.0)}"


SENTENCES = {
    "I_dn": "Propeller, shaft and entrained water, the inertia behind the torque gauge",
    "I_up": "Engine, coupling and gearbox, the inertia before the torque gauge",
    "k_q": "The propeller torque grows with this power of the speed; 2 says that gauge and inflow are in order",
    "t_d + t_sp": "From the set point to the fuel it takes, all delays together",
    "K_p / K_i": "The governor's reset time",
    "gain margin": "The governor gain may grow by this factor before the line hunts",
    "delay margin": "This much more delay in the loop would make the line hunt",
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
