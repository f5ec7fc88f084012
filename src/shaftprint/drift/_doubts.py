"""Which numbers of several tests are judged, which are not, and in which tests one says nothing.

A number that cannot be compared, because a test does not have it or it was held, is judged in none. One that the
verdict of a test doubts is judged where most tests tell it without a doubt; there it counts for nothing in the others.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray
from shaftprint.catalogue._roles import ShipRole
from shaftprint.drift._single_test import SingleTest, is_share
from shaftprint.identify.judgement._affected_numbers import AFFECTED, depends_on
from shaftprint.spelling import listed

if TYPE_CHECKING:
    from shaftprint.drift._dated import DatedTest
    from shaftprint.fingerprint._line_fingerprint import LineFingerprint

NOT_POSITIVE = "it is not larger than zero"
HELD = "it was held"
NOT_IN_ALL = "it is not in all fingerprints"
OTHER_DIRECTION = "the shaft did not turn the same way, and the propeller takes another torque astern"
OF_DIRECTION = (ShipRole.TORQUE, ShipRole.INERTIA_DOWNSTREAM)
"""Roles of what propeller and water make, which are others astern."""
DIRECTION = "working_point.direction"
_UNKNOWN: Final = 10.0
"""Variance of a number that says nothing, of its logarithm or [s^2]: 300 %, or 3 s."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Judged:
    """The numbers that several tests are judged by."""

    names: tuple[str, ...]
    """Numbers that are judged together."""
    left_out: dict[str, str]
    """Why other numbers are not, by name; and why a test says nothing of some of them, by the name of the test."""
    doubts: dict[str, str]
    """Why each number is not judged, by name; empty where it is."""
    says_nothing: BoolArray
    """Whether a number of a test counts for nothing, shape (tests, numbers)."""

    def told(self, tests: Sequence[SingleTest]) -> list[SingleTest]:
        """Return tests with the mean of the others where a number says nothing, so that none is far from the others."""
        values = np.array([one.values for one in tests])
        means = np.mean(values, axis=0, where=~self.says_nothing)
        return [
            replace(one, values=np.where(silent, means, one.values))
            for one, silent in zip(tests, self.says_nothing, strict=True)
        ]

    @property
    def whole(self) -> BoolArray:
        """Whether a test says something of every number, shape (tests,)."""
        return np.asarray(~self.says_nothing.any(axis=1))

    @property
    def unknown(self) -> FloatArray:
        """Variances by which numbers that say nothing are uncertain, shape (tests, numbers)."""
        return np.where(self.says_nothing, _UNKNOWN, 0.0)


def judged_in(tests: "Sequence[DatedTest]") -> Judged:
    """Return the numbers that several tests are judged by."""
    fingerprints = [test.fingerprint for test in tests]
    doubts = _not_comparable(fingerprints)
    names = judged_together(doubts)
    doubted = [{name: _doubted(name, one) for name in names} for one in fingerprints]
    for name in names:
        reasons = [one[name] for one in doubted if one[name]]
        if 2 * len(reasons) >= len(tests):
            doubts[name] = reasons[0]
    names = judged_together(doubts)
    return Judged(
        names=names,
        left_out=left_out_of(doubts) | _silent(tests, doubted, names),
        doubts=doubts,
        says_nothing=np.array([[bool(one[name]) for name in names] for one in doubted], dtype=np.bool_),
    )


def _silent(tests: "Sequence[DatedTest]", doubted: Sequence[Mapping[str, str]], names: Sequence[str]) -> dict[str, str]:
    """Return what tests say nothing of, and why, by the name of the test."""
    found = {}
    for test, reasons in zip(tests, doubted, strict=True):
        silent = [name for name in names if reasons[name]]
        if silent:
            which = "all of its numbers" if len(silent) == len(names) else listed(silent)
            found[test.name] = f"{which}: {' and '.join(dict.fromkeys(reasons[name] for name in silent))}"
    return found


def judged_together(doubts: Mapping[str, str]) -> tuple[str, ...]:
    """Return the numbers that are judged together: those without a doubt."""
    return tuple(name for name, doubt in doubts.items() if not doubt)


def left_out_of(doubts: Mapping[str, str]) -> dict[str, str]:
    """Return why the other numbers are not judged, by name."""
    return {name: doubt for name, doubt in doubts.items() if doubt}


def doubts_of(*fingerprints: "LineFingerprint") -> dict[str, str]:
    """Return why each number of a few fingerprints is not judged, one doubt being enough; empty for those that are.

    One that stopped at its bound is judged: it was pushed there along its column of the covariance, which in the metric
    of that covariance is towards the truth, since the truth is inside the bounds.
    """
    doubts = _not_comparable(fingerprints)
    for name in judged_together(doubts):
        doubts[name] = next(filter(None, (_doubted(name, one) for one in fingerprints)), "")
    return doubts


def _not_comparable(fingerprints: "Sequence[LineFingerprint]") -> dict[str, str]:
    """Return why each number of several fingerprints cannot be compared; empty for those that can."""
    joints = [fingerprint.joint for fingerprint in fingerprints if fingerprint.joint is not None]
    every = dict.fromkeys(name for joint in joints for name in joint.names)
    doubts = {name: next(filter(None, (_absent(name, one) for one in fingerprints)), "") for name in every}
    if len({one.stated_fields.get(DIRECTION, "ahead") for one in fingerprints}) > 1:
        role_of = {
            number.name: number.role
            for one in fingerprints
            for number in (*one.parameters, *one.numbers["physical value"])
        }
        doubts |= {name: OTHER_DIRECTION for name in every if role_of.get(name) in OF_DIRECTION}
    return doubts


def _absent(name: str, fingerprint: "LineFingerprint") -> str:
    """Return why a fingerprint has no such number to compare; empty where it has."""
    if fingerprint.joint is None or name not in fingerprint.joint.names:
        return NOT_IN_ALL
    if fingerprint.joint.covariance_of((name,))[0, 0] <= 0.0:
        return HELD
    number = fingerprint.quantity(name)
    return NOT_POSITIVE if is_share(number.role, number.unit) and number.value <= 0.0 else ""


def _doubted(name: str, fingerprint: "LineFingerprint") -> str:
    """Return why the verdict of a test doubts a number; empty where it does not."""
    number = fingerprint.quantity(name)
    if number.role is None:
        # of what it is made nothing is known here: what its test says of it stands
        return fingerprint.verdict.not_trusted.get(name, "")
    kinds = (reason.kind for reason in fingerprint.verdict.reasons)
    return next((AFFECTED[kind][1] for kind in kinds if depends_on(number, kind)), "")
