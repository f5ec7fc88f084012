"""The tug underway and the free-sailing structures share no code; at the same truth they are the same ship."""

import numpy as np
import pytest
from tests.tug.linearised import linearised_response

from shaftprint.catalogue import KnownPropeller, structure, with_known_propeller
from shaftprint.propeller import ka4_70_in_19a
from shaftprint.tug import Sailing, Tug, normalised_truth

OMEGA_RAD_S = np.geomspace(0.01, 10.0, 100)
SHIPS = {
    "reference": {},
    "full speed": {"engine_speed_rpm": 1800.0},
    "another ship": {
        "sailing": Sailing(wake_fraction=0.11, thrust_deduction=0.22, resistance_exponent=2.0, surging_mass_kg=81e3),
        "engine_speed_rpm": 1500.0,
        "g": -0.3,
        "v": 1.1,
    },
    "no delay": {"governor_delay_s": 0.0, "set_point_latency_s": 0.0},
}


def known(tug, vessel):
    truth = normalised_truth(tug, vessel)
    return truth | {"c_set": 1.0}


@pytest.mark.parametrize("given", SHIPS.values(), ids=SHIPS)
def test_linearised_ship_is_the_composed_structure(vessel, given):
    tug = Tug(**({"sailing": Sailing()} | given))
    truth = known(tug, vessel)
    model = structure("FREE-LOG")
    composed = model.response(model.vector({k: v for k, v in truth.items() if k in model.names}), 1j * OMEGA_RAD_S)
    simulated = linearised_response(tug, vessel, OMEGA_RAD_S / (2.0 * np.pi), outputs=("n", "M_s", "v_s"))[:, 0]
    assert simulated == pytest.approx(composed, rel=2e-5)


@pytest.mark.parametrize("given", SHIPS.values(), ids=SHIPS)
def test_known_propeller_gives_the_same_from_wake_and_resistance(vessel, given):
    tug = Tug(**({"sailing": Sailing()} | given))
    truth = known(tug, vessel)
    propeller = KnownPropeller(
        curve=ka4_70_in_19a(),
        pitch_ratio=1.11,
        diameter_m=1.05,
        propellers=2,
        water_density_kg_m3=1025.0,
        shaft_speed_rev_s=(tug.engine_speed_rpm or 1183.8) / 60.0 / 3.82,
        ship_speed_m_s=truth["v_0"],
    )
    mass = tug.sailing.surging_mass_kg or 57240.0
    model = with_known_propeller(structure("FREE-LOG"), propeller, mass_kg=mass)
    values = model.vector({k: v for k, v in truth.items() if k in model.names})
    simulated = linearised_response(tug, vessel, OMEGA_RAD_S / (2.0 * np.pi), outputs=("n", "M_s", "v_s"))[:, 0]
    assert simulated == pytest.approx(model.response(values, 1j * OMEGA_RAD_S), rel=5e-5)
    (deduction,) = (c.of(model.named(values)) for c in model.combinations if c.name == "t")
    assert deduction == pytest.approx(truth["t"], abs=1e-5)


def test_tie_would_notice_a_ship_that_stands_still(vessel):
    tug = Tug(sailing=Sailing())
    moved = linearised_response(tug, vessel, OMEGA_RAD_S / (2.0 * np.pi))
    model = structure("GAUGE-CLOSED")
    truth = known(tug, vessel) | {"k_q": 2.0}
    still = model.response(model.vector({k: v for k, v in truth.items() if k in model.names}), 1j * OMEGA_RAD_S)
    assert np.abs(moved[:, 0] / still - 1.0).max() > 0.1
