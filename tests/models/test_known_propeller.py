"""A known propeller instead of slopes: the Stan Tug at 9.9 kn."""

import numpy as np
import pytest

from shaftprint.catalogue import KnownPropeller, structure, with_known_propeller
from shaftprint.errors import PropellerError, StructureError
from shaftprint.propeller import ka4_70_in_19a, wageningen_b

OMEGA_RAD_S = np.geomspace(0.02, 10.0, 25)
MASS_KG = 54e3 * 1.06


def propeller(**change):
    given = {
        "curve": ka4_70_in_19a(),
        "pitch_ratio": 1.11,
        "diameter_m": 1.05,
        "propellers": 2,
        "water_density_kg_m3": 1025.0,
        "shaft_speed_rev_s": 1800.0 / 60.0 / 3.82,
        "ship_speed_m_s": 9.9 * 1852.0 / 3600.0,
    }
    return KnownPropeller(**(given | change))


def values_of(model, **given):
    return model.vector({k: v for k, v in given.items() if k in model.names})


@pytest.mark.parametrize("name", ["FREE-CORE", "FREE-CLOSED", "FREE-LOG", "FREE-PITCH"])
def test_same_response_as_with_the_slopes(name):
    """w .20, t .15, e 4: a -.90, b -.41, tau_u 6.8 s, p 2.36, q 2.65, R 43.0 kN."""
    plain, known = structure(name), with_known_propeller(structure(name), propeller(), mass_kg=MASS_KG)
    slopes = {"a": -0.90177, "b": -0.40838, "e": 4.0, "tau_u": 6.78157, "p": 2.35742, "q": 2.65456}
    one = plain.response(values_of(plain, **slopes), 1j * OMEGA_RAD_S)
    other = known.response(values_of(known, w=0.20, e=4.0, R=42987.56), 1j * OMEGA_RAD_S)
    assert other == pytest.approx(one, rel=1e-4)
    assert not {"a", "b", "tau_u", "p", "q"} & set(known.names)


def test_slopes_and_thrust_deduction_are_combinations():
    known = with_known_propeller(structure("FREE-CORE"), propeller(), mass_kg=MASS_KG)
    named = known.named(values_of(known, w=0.20, e=4.0, R=42987.56))
    found = {c.name: float(c.of(named)) for c in known.combinations}
    assert found["a"] == pytest.approx(-0.9018, abs=1e-4)
    assert found["b"] == pytest.approx(-0.4084, abs=1e-4)
    assert found["tau_u"] == pytest.approx(6.782, abs=1e-3)
    assert found["t"] == pytest.approx(0.15, abs=1e-4)
    assert found["(e - a) / tau_u"] == pytest.approx((4.0 + 0.9018) / 6.782, rel=1e-3)


def test_derivatives_go_through_the_curve():
    known = with_known_propeller(structure("FREE-LOG"), propeller(), mass_kg=MASS_KG)
    values = values_of(known, w=0.20, e=4.0, R=42987.56)
    _, slopes = known.gradient(values, 1j * OMEGA_RAD_S, ("w", "R", "m"))
    for slope, name in zip(slopes, ("w", "R", "m"), strict=True):
        step = 1e-5 * values[known.names.index(name)] * np.eye(values.size)[known.names.index(name)]
        ahead, behind = (known.response(values + sign * step, 1j * OMEGA_RAD_S) for sign in (1, -1))
        assert slope == pytest.approx((ahead - behind) / (2.0 * step.sum()), rel=1e-6, abs=1e-6 * np.abs(slope).max())


def test_known_resistance_is_held():
    known = with_known_propeller(structure("FREE-CORE"), propeller(), mass_kg=MASS_KG, resistance_n=43e3)
    held = {p.name: p.value for p in known.parameters if p.held}
    assert held["R"] == 43e3
    assert held["m"] == MASS_KG


def test_wake_is_sought_where_the_propeller_pulls():
    """A propeller near the end of its thrust behind a fast ship: a small wake fraction would leave the curve."""
    fast = propeller(ship_speed_m_s=8.0, curve=wageningen_b(blades=4, area_ratio=0.70), pitch_ratio=1.0)
    (wake,) = (
        p for p in with_known_propeller(structure("FREE-CORE"), fast, mass_kg=MASS_KG).parameters if p.name == "w"
    )
    last = wageningen_b(blades=4, area_ratio=0.70).zero_thrust_advance(1.0)
    assert float(fast.advance(np.asarray(wake.lower))) == pytest.approx(0.97 * last)
    assert wake.lower < wake.value < wake.upper


@pytest.mark.parametrize(
    ("name", "change", "error", "words"),
    [
        ("GAUGE-CORE", {}, StructureError, "found no a, b, e, tau_u; use FREE-CORE"),
        ("FREE-CORE", {"ship_speed_m_s": 40.0}, StructureError, "found no thrust at 7.85"),
        ("FREE-CORE", {"pitch_ratio": 2.0}, PropellerError, "P/D from 0.6 to 1.4"),
    ],
)
def test_what_does_not_belong_together_is_refused(name, change, error, words):
    with pytest.raises(error, match=words):
        with_known_propeller(structure(name), propeller(**change), mass_kg=MASS_KG)
