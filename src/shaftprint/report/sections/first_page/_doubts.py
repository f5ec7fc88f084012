"""Whether a number of the first page may be used, by the verdict, and whether it is what the vessel file expects."""

from typing import TYPE_CHECKING

from shaftprint.identify.judgement._affected_numbers import AFFECTED

if TYPE_CHECKING:
    from shaftprint.fingerprint._fingerprint import Fingerprint
    from shaftprint.identify.fit._estimate import Estimate

# A number may differ from the expected one by so many standard deviations of both before anyone should look, and act.
FAR, TOO_FAR = 2.0, 3.5
_CALLED = {"I_dn": "inertia", "K_Q": "torque coefficient"}


def doubt_of(fingerprint: "Fingerprint", name: str) -> str:
    """Return that a number is not trusted, as a sentence; nothing where it is."""
    verdict = fingerprint.verdict
    if not verdict.trustworthy:
        return "The model is not trustworthy."
    reason = verdict.not_trusted.get(name)
    if not reason:
        return ""
    # of a sentence that begins with the number itself the reader sees which
    own = f"the {_CALLED.get(name, name)} {reason.removeprefix('it ')}" if reason.startswith("it ") else reason
    return f"It cannot be told: {own}."


def is_of_reason(fingerprint: "Fingerprint", name: str) -> bool:
    """Return whether a number is not trusted for what the verdict has found wrong, which no longer test mends."""
    return fingerprint.verdict.not_trusted.get(name) in {clause for _, clause in AFFECTED.values()}


def mend(fingerprint: "Fingerprint", name: str) -> str:
    """Return what to do for a number that is not trusted."""
    if is_of_reason(fingerprint, name):
        return "Do what the first answer says, then identify once more."
    return "Ask for a longer test if this number is needed."


def is_off(quantity: "Estimate") -> bool:
    """Return whether a number is farther from the vessel file than its deviations let expect."""
    apart = quantity.deviations_from_expected
    return bool(quantity.expected) and apart is not None and apart > TOO_FAR
