"""One test, with the numbers that are judged in the coordinates in which tests are compared.

What is a share, such as a gain or an inertia, is compared by its logarithm, a time as it is.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray
from shaftprint.catalogue._roles import ShipRole
from shaftprint.errors import FingerprintError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from shaftprint.fingerprint._line_fingerprint import LineFingerprint
    from shaftprint.identify.fit._estimate import Estimate
    from shaftprint.models._role import Role

SHARES = (ShipRole.TORQUE, ShipRole.ACTUATOR_FREQUENCY, ShipRole.ACTUATOR_DAMPING)
"""Roles of numbers that are larger than zero, beside those of physical values."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SingleTest:
    """One test, with the numbers that are judged in the coordinates in which tests are compared."""

    values: FloatArray
    """Logarithms, and times [s]; shape (numbers,)."""
    own: FloatArray
    """Covariance that the test left open, shape (numbers, numbers)."""
    loadings: dict[str, FloatArray]
    """Change of the numbers for one standard deviation of each source that was stated, shape (numbers,) each."""
    stated: dict[str, FloatArray]
    """Change of what is true for one standard deviation of each of these sources, likewise: with the drawings' inertia
    that of the line itself is another."""


def is_share(role: "Role | None", unit: str) -> bool:
    """Return whether a change of a number is a share of it; times and slopes may be zero.

    What has no role, as the numbers of a drive, is a time where its unit is one.
    """
    return unit != "s" if role is None else role.physical is not None or role in SHARES


def single_test(fingerprint: "LineFingerprint", names: tuple[str, ...]) -> SingleTest:
    """Return a test with some of its numbers, in the coordinates in which tests are compared.

    Raises FingerprintError if the fingerprint does not hold its numbers together.
    """
    joint = fingerprint.joint
    if joint is None:
        raise FingerprintError(f"{fingerprint.title}: expected a joint covariance, found none.")
    numbers = [fingerprint.quantity(name) for name in names]
    values = np.array([number.value for number in numbers])
    shares = np.array([is_share(number.role, number.unit) for number in numbers], dtype=bool)
    size = np.where(shares, values, 1.0)
    return SingleTest(
        values=np.where(shares, np.log(size), values),
        own=fingerprint.misfit * joint.covariance_of(names) / np.outer(size, size),
        loadings={source: change / size for source, change in joint.loadings_of(names).items()},
        stated={source: _stated(fingerprint, source, numbers, shares) for source in joint.loadings},
    )


def _stated(
    fingerprint: "LineFingerprint", source: str, numbers: "Sequence[Estimate]", shares: BoolArray
) -> FloatArray:
    """Return the change of each number for one standard deviation of a source of the priors."""
    told = {
        fingerprint.quantity(name).role or name: (prior.mean, prior.by_source(name).get(source, 0.0))
        for name, prior in fingerprint.priors.items()
    }
    changes = np.zeros(len(numbers))
    for place, number in enumerate(numbers):
        if (number.role or number.name) in told:
            mean, change = told[number.role or number.name]
            changes[place] = change / mean if shares[place] else change
    return changes
