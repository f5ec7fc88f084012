"""Inertia by calculation beside that of a fingerprint."""

from typing import TYPE_CHECKING

from shaftprint.catalogue._roles import ShipRole
from shaftprint.fingerprint._fingerprint import Fingerprint
from shaftprint.torsion._expected_inertia import ExpectedInertia, InertiaComparison, compare_inertia, expected_inertia
from shaftprint.units import rev_s_from_rpm

if TYPE_CHECKING:
    from shaftprint.vessel._vessel import Vessel


def inertia_beside(fingerprint: Fingerprint, vessel: "Vessel") -> tuple[ExpectedInertia, tuple[InertiaComparison, ...]]:
    """Return what the inertia table lets expect at the fingerprint's working point, beside what the fingerprint has.

    An inertia time of which something was known before the test is not independent of the table, nor is the inertia
    that follows from it.

    Parameters
    ----------
    fingerprint
        The record of a test.
    vessel
        What was tested.
    """
    conditions = fingerprint.conditions
    expected = expected_inertia(
        vessel,
        engine_speed_rev_s=rev_s_from_rpm(conditions.engine_speed.value),
        shaft_torque_nm=conditions.shaft_torque.value,
    )
    names = dict(zip((ShipRole.INERTIA_UPSTREAM, ShipRole.INERTIA_DOWNSTREAM), expected.times, strict=True))
    numbers = {number.name: (number.value, number.std) for number in fingerprint.physical}
    assumed: set[str] = set()
    for parameter in fingerprint.parameters:
        if parameter.role in names:
            numbers[names[parameter.role].name] = (parameter.value, parameter.std)
            if parameter.name in fingerprint.priors:
                assumed |= {
                    names[parameter.role].name,
                    *(q.name for q in fingerprint.physical if q.role == parameter.role),
                }
    return expected, compare_inertia(expected, numbers, assumed=frozenset(assumed))
