"""What differs between two fingerprints of a drive, and whether by more than chance."""

from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from shaftprint.arguments import refusing_none
from shaftprint.distributions import normal_cdf
from shaftprint.errors import FingerprintError
from shaftprint.fingerprint._drive_fingerprint import DriveFingerprint
from shaftprint.identify.fit._estimate import Estimate

Outcome: TypeAlias = Literal["differs", "perhaps", "no difference seen", "cannot be compared"]
# A difference that chance makes in fewer than this share of pairs counts.
UNLIKELY = 0.05


@dataclass(frozen=True, kw_only=True, slots=True)
class DriveDifference:
    """One number of two fingerprints beside each other."""

    first: Estimate
    """The number in the fingerprint that others are compared with."""
    other: Estimate
    """The number in the other fingerprint."""
    std: float
    """Standard deviation of the difference; infinite where a test says nothing of the number."""
    p_value: float | None
    """Probability that chance alone makes a difference that large or larger; None where it cannot be compared."""
    outcome: Outcome
    """Whether they differ: surely, all numbers of the comparison considered; perhaps; or not to be seen."""


@refusing_none(FingerprintError)
def drive_differences(first: DriveFingerprint, other: DriveFingerprint) -> tuple[DriveDifference, ...]:
    """Return what differs between the parameters and combinations of two fingerprints of one structure.

    Errors of both tests are taken as independent; what both took from the same data sheet errs alike in both, so that
    their difference is known better than stated.

    Raises FingerprintError if they are of different structures.
    """
    if first.structure != other.structure:
        raise FingerprintError(
            f"comparison: expected fingerprints of one structure, found {first.structure} and {other.structure}; "
            "identify both with the same."
        )
    others = {quantity.name: quantity for quantity in (*other.parameters, *other.combinations)}
    pairs = [
        (quantity, others[quantity.name])
        for quantity in (*first.parameters, *first.combinations)
        if quantity.name in others
    ]
    comparable = [
        bool(np.isfinite(_std(one, two)) and _std(one, two) > 0.0 and not (one.at_bound or two.at_bound))
        for one, two in pairs
    ]
    return tuple(
        _difference(one, two, among=sum(comparable), comparable=can)
        for (one, two), can in zip(pairs, comparable, strict=True)
    )


def _std(one: Estimate, two: Estimate) -> float:
    return float(np.hypot(one.std, two.std))


def _difference(one: Estimate, two: Estimate, *, among: int, comparable: bool) -> DriveDifference:
    std = _std(one, two)
    if not comparable:
        return DriveDifference(first=one, other=two, std=std, p_value=None, outcome="cannot be compared")
    p_value = 2.0 * float(normal_cdf(-abs(two.value - one.value) / std))
    # Bonferroni: of many numbers one differs by chance
    outcome: Outcome = (
        "differs" if p_value * among < UNLIKELY else "perhaps" if p_value < UNLIKELY else "no difference seen"
    )
    return DriveDifference(first=one, other=two, std=std, p_value=p_value, outcome=outcome)
