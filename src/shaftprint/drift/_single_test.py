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

    from shaftprint.fingerprint._fingerprint import Fingerprint
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


def is_share(role: "Role | None") -> bool:
    """Return whether a change of a number is a share of it; times and slopes may be zero."""
    return role is not None and (role.physical is not None or role in SHARES)


def single_test(fingerprint: "Fingerprint", names: tuple[str, ...]) -> SingleTest:
    """Return a test with some of its numbers, in the coordinates in which tests are compared.

    Raises FingerprintError if the fingerprint does not hold its numbers together.
    """
    joint = fingerprint.joint
    if joint is None:
        raise FingerprintError(f"{fingerprint.conditions.campaign}: expected a joint covariance, found none.")
    numbers = [fingerprint.quantity(name) for name in names]
    values = np.array([number.value for number in numbers])
    shares = np.array([is_share(number.role) for number in numbers], dtype=bool)
    size = np.where(shares, values, 1.0)
    return SingleTest(
        values=np.where(shares, np.log(size), values),
        own=_misfit(fingerprint) * joint.covariance_of(names) / np.outer(size, size),
        loadings={source: change / size for source, change in joint.loadings_of(names).items()},
        stated={source: _stated(fingerprint, source, numbers, shares) for source in joint.loadings},
    )


def _stated(fingerprint: "Fingerprint", source: str, numbers: "Sequence[Estimate]", shares: BoolArray) -> FloatArray:
    """Return the change of each number for one standard deviation of a source of the priors."""
    by_role = {
        fingerprint.quantity(name).role: (prior.mean, prior.by_source(name).get(source, 0.0))
        for name, prior in fingerprint.priors.items()
    }
    changes = np.zeros(len(numbers))
    for place, number in enumerate(numbers):
        if number.role is not None and number.role in by_role:
            mean, change = by_role[number.role]
            changes[place] = change / mean if shares[place] else change
    return changes


def _misfit(fingerprint: "Fingerprint") -> float:
    """Return by how much the residuals of a fit are larger than its noise, as a variance; 1 at least."""
    quality = fingerprint.quality
    if quality.chi_square is None or quality.degrees_of_freedom <= 0:
        return 1.0
    return max(quality.chi_square / quality.degrees_of_freedom, 1.0)
