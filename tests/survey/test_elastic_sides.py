"""On which side of a coupling the first speed sensor sits, and what of the line is left open there."""

import pytest

from shaftprint.catalogue import structure
from shaftprint.survey import of_vessel
from shaftprint.survey._elastic_line import elastic_structures, sides
from shaftprint.vessel import load_vessel

TOWBOAT = load_vessel("pt-may")
SHAFT, ENGINE = "GAUGE-ELASTIC", "GAUGE-ELASTIC-ENGINE"


def ship(first, **changes):
    """Return the towboat with the sensor on one of its shafts as the first."""
    speeds = tuple(sorted(TOWBOAT.sensors.speed, key=lambda sensor: sensor.shaft != first))
    return TOWBOAT.model_copy(update={"sensors": TOWBOAT.sensors.model_copy(update={"speed": speeds}), **changes})


@pytest.mark.parametrize(
    ("vessel", "expected"),
    [
        (ship("propeller"), (SHAFT,)),
        (ship("propeller", links=()), (SHAFT,)),
        # both ends of the coupling are on the engine's shaft, where the strip may be on either
        (ship("engine"), (ENGINE, SHAFT)),
        (ship("engine", links=()), (ENGINE,)),
        (ship("engine", links=(), gearbox=TOWBOAT.gearbox.model_copy(update={"ratio": 1.0})), (ENGINE, SHAFT)),
        (ship("propeller", links=(), gearbox=TOWBOAT.gearbox.model_copy(update={"ratio": 1.0})), (SHAFT, ENGINE)),
    ],
)
def test_shaft_and_links_say_the_side(vessel, expected):
    assert sides(vessel) == expected
    assert tuple(one.name for one in elastic_structures(structure("GAUGE-CLOSED"), vessel)) == expected


def test_other_structures_have_no_elastic_line_beside_them():
    assert elastic_structures(structure("GAUGE-INFLOW"), TOWBOAT) == ()


def test_what_the_coupling_drives_is_open_where_the_engine_is_seen_and_nobody_states_it():
    bare = ship("engine", links=())
    driven = {p.name: p for p in of_vessel(structure(ENGINE), bare).free}["tau_m"]
    # half of 7.8 + 0.65 kg m2 at 6.16 times the speed and 6 kg m2, at 1400 rpm / 6.16 and 5999 N m
    upstream = 8.45 * 6.16**2 + 6.0
    assert driven.upper == pytest.approx(0.5 * upstream * 2.0 * 3.141592653589793 * 1400.0 / 60.0 / 6.16 / 5999.0)
    assert "tau_m" not in {p.name for p in of_vessel(structure(SHAFT), bare).free}
    assert "tau_m" in {p.name for p in of_vessel(structure(SHAFT), TOWBOAT).free}
