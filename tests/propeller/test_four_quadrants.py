"""Wageningen B4-70 in four quadrants: the polynomials of the series ahead, printed numbers astern, signs."""

import math

import numpy as np
import pytest

from shaftprint.errors import PropellerError
from shaftprint.propeller import four_quadrants, wageningen_b

CURVE = four_quadrants(blades=4, area_ratio=0.70)
AHEAD = wageningen_b(blades=4, area_ratio=0.70)
SHIP = {"pitch_ratio": 1.0, "diameter_m": 2.0, "water_density_kg_m3": 1025.0}


@pytest.mark.parametrize("pitch_ratio", [0.5, 0.8, 1.0, 1.2, 1.4])
def test_bollard_ahead_meets_the_polynomials_of_the_series(pitch_ratio):
    """Another regression of the same models: within 6 % of the thrust and 3 % of the torque."""
    found, expected = CURVE.bollard(pitch_ratio, astern=False), AHEAD.at(0.0, pitch_ratio)
    assert found.thrust == pytest.approx(expected.thrust, rel=0.06)
    assert found.torque == pytest.approx(expected.torque, rel=0.031)


@pytest.mark.parametrize("advance", np.arange(0.0, 0.85, 0.1))
def test_first_quadrant_meets_the_polynomials_of_the_series(advance):
    n, diameter = 3.0, SHIP["diameter_m"]
    found = CURVE.forces(n, advance * n * diameter, **SHIP)
    force = SHIP["water_density_kg_m3"] * n**2 * diameter**4
    expected = AHEAD.at(float(advance), 1.0)
    assert found.thrust_n / force == pytest.approx(expected.thrust, rel=0.05)
    assert found.torque_nm / (force * diameter) == pytest.approx(expected.torque, rel=0.025)


def test_bollard_astern_has_the_printed_coefficients():
    """Smogeli, Control of marine propellers (NTNU, 2006): K_T 0.445 and 0.347 astern, K_Q 0.0666 and 0.0628 astern."""
    assert CURVE.bollard(1.0, astern=False) == pytest.approx((0.445, 0.0666), rel=2e-3)
    assert CURVE.bollard(1.0, astern=True) == pytest.approx((0.347, 0.0628), rel=2e-3)


def test_between_the_pitches_astern_torque_stays_below_that_ahead():
    ratios = [
        CURVE.bollard(pitch, astern=True).torque / CURVE.bollard(pitch, astern=False).torque
        for pitch in np.linspace(0.8, 1.4, 13)
    ]
    assert 0.9 < min(ratios) < max(ratios) < 1.0


def test_signs_in_the_four_quadrants():
    ahead, crash_stop, astern, crash_ahead = (
        CURVE.forces(n, v, **SHIP) for n, v in ((3, 4), (-3, 4), (-3, -4), (3, -4))
    )
    assert (ahead.thrust_n > 0.0, ahead.torque_nm > 0.0) == (True, True)
    assert (crash_ahead.thrust_n > 0.0, crash_ahead.torque_nm > 0.0) == (True, True)
    assert (astern.thrust_n < 0.0, astern.torque_nm < 0.0) == (True, True)
    assert (crash_stop.thrust_n < 0.0, crash_stop.torque_nm < 0.0) == (True, True)
    # against the water a shaft takes more torque than with it
    assert crash_stop.torque_nm < astern.torque_nm
    # the water that comes from ahead brakes the ship and turns a free shaft ahead
    standing = CURVE.forces(0.0, 4.0, **SHIP)
    assert standing.thrust_n < 0.0
    assert standing.torque_nm < 0.0


def test_where_all_stands_there_is_no_force():
    assert tuple(CURVE.forces(0.0, 0.0, **SHIP)) == (0.0, 0.0)


def test_forces_have_the_shape_of_the_speeds_and_go_with_their_square():
    once = CURVE.forces(np.array([1.0, -2.0]), np.array([3.0, 1.0]), **SHIP)
    twice = CURVE.forces(np.array([2.0, -4.0]), np.array([6.0, 2.0]), **SHIP)
    assert twice.thrust_n == pytest.approx(4.0 * once.thrust_n)
    assert twice.torque_nm == pytest.approx(4.0 * once.torque_nm)


def test_a_definition_by_hand():
    """At 90 degrees: T = C_T rho/2 v^2 pi/4 D^2, with the sum of the coefficients at that angle."""
    thrust, _ = CURVE.at(math.pi / 2.0, 1.0)
    forces = CURVE.forces(0.0, 4.0, **SHIP)
    assert forces.thrust_n == pytest.approx(float(thrust) * 0.5 * 1025.0 * 16.0 * math.pi / 4.0 * 4.0)


@pytest.mark.parametrize(("blades", "area_ratio"), [(3, 0.70), (4, 0.55)])
def test_other_propellers_are_refused(blades, area_ratio):
    with pytest.raises(PropellerError, match=f"expected the Wageningen B4-70.*found {blades} blades with {area_ratio}"):
        four_quadrants(blades=blades, area_ratio=area_ratio)


def test_other_pitches_are_refused():
    with pytest.raises(PropellerError, match=r"from 0\.5 to 1\.4, found 1\.5"):
        CURVE.bollard(1.5, astern=True)
