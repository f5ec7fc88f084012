"""A vessel file from a card: its numbers are worked out by hand, or stand in the documents of the Stan Tug."""

import math

import pytest

from shaftprint.card import disagreements
from shaftprint.card._card import Card, Gauge, Pulses
from shaftprint.card._vessel_text import vessel_text
from shaftprint.card._write import write_vessel
from shaftprint.errors import SettingsError
from shaftprint.vessel import load_vessel

TUG = {
    "rated_power_kw": 221.0,
    "rated_speed_rpm": 1800.0,
    "cylinders": 6,
    "diameter_m": 1.05,
    "blades": 3,
    "pitch_ratio": 1.11,
    "gear_ratio": 3.82,
    "in_nozzle": True,
}


@pytest.fixture
def ship(tmp_path):
    """The vessel of a card, the Stan Tug's but for what is stated."""

    def make(**changed):
        return write_vessel(Card(**TUG | changed), tmp_path / "ship.toml")

    return make


def test_what_stands_on_the_card_is_in_the_file(ship):
    vessel = ship(name='My "tug"', cylinders=8, area_ratio=0.65, idle_speed_rpm=650.0, water_density_kg_m3=1000.0)
    assert vessel.name == 'My "tug"'
    assert (vessel.engine.rated_power_kw, vessel.engine.rated_speed_rpm, vessel.engine.cylinders) == (221.0, 1800.0, 8)
    assert (vessel.gearbox.ratio, vessel.engine.idle_speed_rpm, vessel.water_density_kg_m3) == (3.82, 650.0, 1000.0)
    propeller = vessel.propeller
    assert (propeller.diameter_m, propeller.blades, propeller.pitch_ratio, propeller.area_ratio) == (
        1.05,
        3,
        1.11,
        0.65,
    )


def test_torque_at_the_quay_is_that_of_the_series(ship):
    """1025 kg/m3 * (1183.8 / 60 / 3.82)^2 * 1.05^5 = 34898 N m; Ka4-70 at P/D 1.11 takes 0.0560555 of it."""
    vessel = ship(engine_speed_rpm=1183.8)
    assert vessel.working_point.shaft_torque_nm == pytest.approx(1956.2, abs=0.1)
    assert vessel.propeller.torque_coefficient == pytest.approx(0.0560555, rel=1e-4)
    assert vessel.torque_coefficient_std == pytest.approx(0.15 * 0.0560555, rel=1e-4)
    # measured were 1725 N m, 88.2 %: within the 15 % that the file states
    assert load_vessel("stan-tug-1205").working_point.shaft_torque_nm == pytest.approx(0.882 * 1956.2, rel=1e-3)


def test_torque_underway_is_that_of_the_propeller_law(ship):
    """221 kW at 30 rev/s are 1172.44 N m, 4344.4 N m behind the gear of 3.82 and 0.97; 4/9 of it at two thirds."""
    vessel = ship(is_underway=True)
    assert vessel.working_point.engine_speed_rpm == 1200.0
    assert vessel.working_point.shaft_torque_nm == pytest.approx(4344.4 * 4.0 / 9.0, rel=1e-4)


def test_torque_of_a_propeller_of_no_series_is_that_of_the_propeller_law(ship):
    """The nozzle series ends at P/D 1.4."""
    vessel = ship(pitch_ratio=1.5)
    assert vessel.working_point.shaft_torque_nm == pytest.approx(4344.4 * 4.0 / 9.0, rel=1e-4)


def test_measured_torque_is_kept(ship):
    """The effective K_Q of the Stan Tug in its shipped file: 0.04943."""
    vessel = ship(engine_speed_rpm=1183.8, shaft_torque_nm=1725.0)
    assert vessel.working_point.shaft_torque_nm == 1725.0
    assert vessel.torque_coefficient_std is None
    assert vessel.propeller.torque_coefficient == pytest.approx(0.04943, abs=5e-6)


def test_full_load_has_rated_power_at_rated_speed_and_is_that_of_the_stan_tug(ship):
    engine, tug = ship().engine, load_vessel("stan-tug-1205").engine
    torque, turns = engine.full_load_torque_nm[-1], engine.full_load_speed_rpm[-1] / 60.0
    assert 2.0 * math.pi * turns * torque == pytest.approx(221e3, rel=1e-4)
    assert engine.full_load_speed_rpm == pytest.approx(tug.full_load_speed_rpm)
    assert engine.full_load_torque_nm == pytest.approx(tug.full_load_torque_nm, rel=1e-3)
    assert engine.idle_speed_rpm == tug.idle_speed_rpm


def test_inertias_agree_with_the_table_of_the_stan_tug(ship):
    """The table has 54.0 kg m2 before and 17.0 behind the gauge; the water of three blades is 5.89 by Schwanecke."""
    vessel = ship()
    upstream, downstream = vessel.inertia_upstream_kg_m2, vessel.inertia_downstream_kg_m2
    assert vessel.inertia[-1].inertia_kg_m2 == pytest.approx(5.89, abs=0.01)
    assert abs(upstream - 54.0) < vessel.inertia_upstream_std_kg_m2
    assert abs(downstream - 17.0) < vessel.inertia_downstream_std_kg_m2
    # 0.3 s of 221 kW: 66.3 kJ in 0.5 I omega^2 at 188.496 rad/s
    assert vessel.inertia[0].inertia_kg_m2 == pytest.approx(2.0 * 66.3e3 / 188.496**2, rel=1e-4)


def test_stated_inertias_have_the_deviation_of_a_table(ship):
    vessel = ship(inertia_upstream_kg_m2=54.0, inertia_downstream_kg_m2=17.0)
    assert (vessel.inertia_upstream_kg_m2, vessel.inertia_downstream_kg_m2) == (54.0, 17.0)
    assert vessel.inertia_upstream_std_kg_m2 == pytest.approx(0.05 * 54.0)


def test_speed_of_the_propeller_gives_the_ratio(ship):
    assert ship(gear_ratio=None, propeller_rated_rpm=450.0).gearbox.ratio == 4.0


def test_speed_of_the_propeller_beside_the_ratio_checks_it(ship):
    (found,) = disagreements(ship(propeller_rated_rpm=450.0))
    assert found.field == "gearbox.ratio"


@pytest.mark.parametrize("changed", [{}, {"in_nozzle": False}, {"is_underway": True}, {"blades": 5}])
def test_what_is_derived_agrees_with_itself(ship, changed):
    assert disagreements(ship(**changed)) == ()


def test_sensors(ship):
    vessel = ship(
        engine_pulses=(Pulses(channel="crank", wheel="60-2"),),
        shaft_pulses=(Pulses(channel="PTM_1"), Pulses(channel="PTM_4", wheel="4")),
        gauge=Gauge(channel="T", unit="V", scale_nm_per_unit=500.0, full_scale_nm=5000.0),
        set_point_channel="lever",
        sample_rate_hz=10000.0,
    )
    speeds = [(sensor.name, sensor.channel, sensor.pulses_per_revolution) for sensor in vessel.sensors.speed]
    assert speeds == [("n_e", "crank", 58), ("n_s", "PTM_1", 1), ("n_s2", "PTM_4", 4)]
    assert float(vessel.sensors.shaft_torque.torque_nm(2.0)) == 1000.0
    assert (vessel.sensors.shaft_torque.full_scale_nm, vessel.sensors.set_point.channel) == (5000.0, "lever")
    assert vessel.logger.sample_rate_hz == 10000.0


def test_a_gauge_in_kilonewton_metres(ship):
    """One unit is 1000 N m; without a data sheet 1.5 times 4344.4 N m are passed on."""
    gauge = ship(gauge=Gauge(unit="kN m")).sensors.shaft_torque
    assert float(gauge.torque_nm(1.7)) == 1700.0
    assert gauge.full_scale_nm == pytest.approx(1.5 * 4344.4, rel=1e-4)


def test_every_number_that_is_not_on_the_card_says_where_it_is_from():
    text = vessel_text(Card(**TUG))
    for line in (
        "shaft_torque_nm = 2010.1  # Ka4-70 in nozzle 19A at zero advance, +/- 15 %",
        "idle_speed_rpm = 600.0  # usual: a third of rated speed, +/- 20 %",
        "inertia_kg_m2 = 5.8911  # Schwanecke (1963), +/- 30 %",
    ):
        assert line in text.splitlines()
    assert "diameter_m = 1.05\n" in text


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"gear_ratio": None}, "expected the gear ratio or the speed of the propeller at rated engine speed"),
        ({"gauge": Gauge(unit="V")}, "torque gauge M_s: expected its scale for a channel in V, found none"),
        ({"idle_speed_rpm": 1900.0}, "ship.toml: 1 field cannot be used.*idle_speed_rpm below rated_speed_rpm"),
        ({"strokes_per_cycle": 3}, "strokes_per_cycle 2 or 4, found 3"),
        ({"set_point_channel": "M_s"}, "every sensor to have its own channel, found M_s twice"),
    ],
)
def test_a_card_that_gives_no_vessel_leaves_no_file(ship, tmp_path, changed, words):
    with pytest.raises(SettingsError, match=f"(?s){words}"):
        ship(**changed)
    assert list(tmp_path.iterdir()) == []
