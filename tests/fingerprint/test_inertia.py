"""Inertia by calculation beside that of a fingerprint."""

import math
from types import SimpleNamespace

import pytest

from shaftprint.catalogue import ShipRole
from shaftprint.fingerprint import inertia_beside
from shaftprint.identify import Estimate
from shaftprint.vessel import load_vessel


def record(**priors):
    """What the comparison reads of a fingerprint: thesis' OL1 result, with an invented tau_up."""

    def quantity(name, unit, value, std, role=None):
        return Estimate(name=name, unit=unit, value=value, std=std, role=role)

    return SimpleNamespace(
        conditions=SimpleNamespace(
            engine_speed=quantity("n_0", "rpm", 1183.8, 0.1), shaft_torque=quantity("M_s0", "N m", 1725.0, 5.0)
        ),
        parameters=(
            quantity("J_aft", "s", 0.3897, 0.01, ShipRole.INERTIA_DOWNSTREAM),
            quantity("J_fore", "s", 1.1, 0.05, ShipRole.INERTIA_UPSTREAM),
        ),
        physical=(
            quantity("I_dn", "kg m2", 20.71, 0.6, ShipRole.INERTIA_DOWNSTREAM),
            quantity("I_up", "kg m2", 58.0, 2.0, ShipRole.INERTIA_UPSTREAM),
        ),
        priors=priors,
    )


@pytest.fixture(scope="module")
def vessel():
    return load_vessel("stan-tug-1205")


def test_thesis_inertia_lies_downstream_of_the_gauge(vessel):
    """0.3897 s against 0.320 downstream, 2.1 deviations off, and against 1.016 upstream, more than 20 off."""
    expected, beside = inertia_beside(record(), vessel)
    found = {row.expected.name: row for row in beside}
    assert set(found) == {"tau_up", "tau_dn", "I_up", "I_dn"}
    assert found["tau_dn"].deviations == pytest.approx((0.3897 - 0.3198) / math.hypot(0.03118, 0.01), abs=0.02)
    upstream = expected.value("tau_up")
    assert (upstream.value - 0.3897) / upstream.std > 20.0


def test_what_was_told_is_not_compared(vessel):
    _, beside = inertia_beside(record(J_fore=object()), vessel)
    independent = {row.expected.name: row.independent for row in beside}
    assert independent == {"tau_up": False, "tau_dn": True, "I_up": False, "I_dn": True}
