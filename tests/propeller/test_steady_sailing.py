"""The Stan Tug underway, with numbers worked out by hand from its data and the propeller's curve."""

import math

import numpy as np
import pytest

from shaftprint.errors import PropellerError
from shaftprint.propeller import ka4_70_in_19a, sail_steadily

# 54 t displacement and 6 % of water that surges with the hull; 70.5 kg m2 on the shaft, no water around the propeller.
MASS_KG = 54e3 * 1.06
INERTIA_KG_M2 = 70.5
KNOT_M_S = 1852.0 / 3600.0


def sailing(knots, rpm, wake=0.20, deduction=0.15, **given):
    return sail_steadily(
        ka4_70_in_19a(),
        pitch_ratio=1.11,
        diameter_m=1.05,
        water_density_kg_m3=1025.0,
        shaft_speed_rev_s=rpm / 60.0 / 3.82,
        ship_speed_m_s=knots * KNOT_M_S,
        wake_fraction=wake,
        thrust_deduction=deduction,
        propellers=2,
        **given,
    )


def test_full_speed():
    """9.9 kn at 1800 rpm: J .494, 25.3 kN a propeller, 3774 N m, 186 kW, 43 kN, tau_u 6.8 s, tau_n .92 s."""
    found = sailing(9.9, 1800.0)
    assert found.point.advance == pytest.approx(0.494, abs=5e-4)
    assert found.thrust_n == pytest.approx(25.3e3, abs=50.0)
    assert found.shaft_torque_nm == pytest.approx(3774.0, abs=1.0)
    assert 2.0 * math.pi * found.shaft_speed_rev_s * found.shaft_torque_nm == pytest.approx(186e3, abs=500.0)
    assert found.resistance_n == pytest.approx(43.0e3, abs=50.0)
    assert found.ship_time_s(MASS_KG) == pytest.approx(6.8, abs=0.05)
    assert found.shaft_time_s(INERTIA_KG_M2) == pytest.approx(0.92, abs=5e-3)


def test_seven_knots_with_less_wake():
    """7 kn at 1183.8 rpm: a -1.26, b -.58, tau_u 12.3 s and tau_n 1.50 s belong to w .15 and t .12."""
    found = sailing(7.0, 1183.8, wake=0.15, deduction=0.12)
    assert found.point.a == pytest.approx(-1.26, abs=5e-3)
    assert found.point.b == pytest.approx(-0.58, abs=5e-3)
    assert found.ship_time_s(MASS_KG) == pytest.approx(12.3, abs=0.05)
    assert found.shaft_time_s(INERTIA_KG_M2) == pytest.approx(1.50, abs=5e-3)


def test_at_the_quay():
    found = sailing(0.0, 1183.8)
    assert found.shaft_torque_nm == pytest.approx(1956.0, abs=1.0)
    assert found.thrust_n == pytest.approx(20.5e3, abs=50.0)
    assert found.ship_time_s(MASS_KG) == math.inf


def test_factor_acts_on_the_torque_alone():
    plain, light = sailing(8.0, 1500.0), sailing(8.0, 1500.0, torque_factor=0.88)
    assert light.shaft_torque_nm == pytest.approx(0.88 * plain.shaft_torque_nm, rel=1e-12)
    assert (light.thrust_n, light.resistance_n) == (plain.thrust_n, plain.resistance_n)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"shaft_speed_rev_s": 0.0}, "shaft_speed_rev_s above 0, found 0"),
        ({"diameter_m": -1.0}, "diameter_m above 0, found -1"),
        ({"wake_fraction": 1.0}, "wake_fraction below 1, found 1"),
        ({"thrust_deduction": 1.2}, "thrust_deduction below 1, found 1.2"),
        ({"ship_speed_m_s": 20.0}, "advance ratio J from 0 to"),
    ],
)
def test_what_cannot_be_is_refused(change, words):
    given = {
        "pitch_ratio": 1.11,
        "diameter_m": 1.05,
        "water_density_kg_m3": 1025.0,
        "shaft_speed_rev_s": 5.0,
        "ship_speed_m_s": 3.0,
        "wake_fraction": 0.2,
        "thrust_deduction": 0.15,
    }
    with pytest.raises(PropellerError, match=words):
        sail_steadily(ka4_70_in_19a(), **(given | change))


def test_polynomial_takes_complex_numbers_and_arrays():
    """Fits differentiate the curve by an imaginary step, and for many parameter sets at once."""
    torque = ka4_70_in_19a().torque
    advance = np.array([0.2, 0.5])
    stepped = torque.value(advance + 1e-30j, np.array(1.11)).imag / 1e-30
    assert stepped == pytest.approx(torque.advance_slope(advance, np.array(1.11)), rel=1e-12)
