"""The shipped vessel against the numbers of the thesis and of its torsional vibration calculation."""

import math

import pytest

from shaftprint.settings import write_template
from shaftprint.vessel import load_vessel


@pytest.fixture(scope="module")
def tug():
    return load_vessel("stan-tug-1205")


def test_the_engine_turns_3_82_times_as_fast_as_the_propeller(tug):
    gearbox = tug.gearbox
    assert (gearbox.engine_over("engine"), gearbox.engine_over("propeller")) == (1.0, 3.82)
    assert (gearbox.over_propeller("engine"), gearbox.over_propeller("propeller")) == (3.82, 1.0)


def test_inertias_add_up_to_the_printed_totals(tug):
    table = [row for row in tug.inertia if row.name not in ("Entrained water", "Propeller shaft")]
    assert len(table) == 19
    total = sum(row.inertia_kg_m2 * (3.82**2 if row.shaft == "engine" else 1.0) for row in table)
    assert total == pytest.approx(66.2960, abs=5e-5)
    assert tug.inertia_upstream_kg_m2 == pytest.approx(54.006, abs=5e-5)
    assert tug.inertia_downstream_kg_m2 == pytest.approx(17.0, abs=1e-9)


def test_low_side_rows_are_those_of_the_table(tug):
    rows = {row.name: row.inertia_kg_m2 for row in tug.inertia if row.shaft == "propeller"}
    assert rows == {
        "Output gear": 0.513,
        "Flanges": 0.281,
        "Propeller, 3 blades": 12.290,
        "Entrained water": 4.41,
        "Propeller shaft": 0.3,
    }


def test_lost_rows_are_marked(tug):
    marked = {row.name for row in tug.inertia if row.source != "table"}
    assert marked == {
        "Damper housing",
        "Damper ring",
        "Cylinder 1",
        "Cylinder 2",
        "Reverse pinion",
        "Entrained water",
        "Propeller shaft",
    }


def test_water_lies_between_two_estimates(tug):
    water = next(row.inertia_kg_m2 for row in tug.inertia if row.name == "Entrained water")
    # Schwanecke (1963) for four blades, area ratio 0.70, pitch ratio 1.11, diameter 1.05 m
    schwanecke = 0.0703 / (math.pi * 4) * 1.11**2 * 0.70**2 * 1025.0 * 1.05**5
    assert schwanecke == pytest.approx(4.42, abs=0.005)
    assert 4.26 < water < schwanecke


def test_every_row_has_a_standard_deviation_that_adds_up(tug):
    assert all(row.std_kg_m2 for row in tug.inertia)
    # 14.5924 x the root of the sum of squares of the engine rows, and the two gear rows
    engine = [0.030, 0.0094, 0.0070, 0.0028, 0.0028, 0.0021, 0.0028, 0.0027, 0.054, 0.018, 0.0024, 0.0016, 0.0003]
    engine += [0.0016, 0.0010, 0.034]
    expected = math.sqrt(sum((14.5924 * value) ** 2 for value in engine) + 0.015**2 + 0.008**2)
    assert tug.inertia_upstream_std_kg_m2 == pytest.approx(expected, rel=1e-12)
    assert tug.inertia_downstream_std_kg_m2 == pytest.approx(1.6224, abs=1e-4)


def test_equilibrium_at_the_working_point(tug):
    shaft_rev_s = tug.working_point.engine_speed_rpm / 60.0 / tug.gearbox.ratio
    assert shaft_rev_s == pytest.approx(5.16492, abs=5e-6)
    torque = tug.propeller.torque_coefficient * tug.water_density_kg_m3 * shaft_rev_s**2 * tug.propeller.diameter_m**5
    assert torque == pytest.approx(1725.0, rel=2e-4)
    assert 2.0 * math.pi * shaft_rev_s * 1725.0 == pytest.approx(55.98e3, abs=5.0)
    engine_torque = tug.working_point.shaft_torque_nm / tug.gearbox.ratio / tug.gearbox.efficiency
    assert engine_torque == pytest.approx(465.54, abs=0.005)


def test_rack_map_gives_rated_torque_and_the_working_point(tug):
    rack = tug.engine.rack_map
    assert tug.engine.rated_torque_nm == pytest.approx(1172.4, abs=0.05)
    assert rack.rack_slope_nm + 30.0 * rack.speed_slope_nm_per_rev_s + rack.intercept_nm == pytest.approx(
        tug.engine.rated_torque_nm, abs=0.01
    )
    assert 465.54 / rack.rack_slope_nm == pytest.approx(0.39707, abs=1e-5)


def test_full_load_curve_ends_at_rated_torque(tug):
    engine = tug.engine
    assert engine.full_load_speed_rpm[-1] == engine.rated_speed_rpm
    assert engine.full_load_torque_nm[-1] == pytest.approx(engine.rated_torque_nm, abs=0.5)
    assert max(engine.full_load_torque_nm) == 1325.0
    assert len(engine.full_load_speed_rpm) == 9


def test_time_constants_of_the_thesis(tug):
    # thesis eq. 5.1 with the shaft speed of table 3.2; 1.016 s upstream, 0.320 s downstream
    slope = 2.0 * math.pi * 5.16492 / 1725.0
    assert slope * tug.inertia_upstream_kg_m2 == pytest.approx(1.016, abs=5e-4)
    assert slope * tug.inertia_downstream_kg_m2 == pytest.approx(0.320, abs=5e-4)


def test_sensors_are_those_of_the_thesis(tug):
    assert [(sensor.name, sensor.channel) for sensor in tug.sensors.speed] == [
        ("n_e", "PTM_e"),
        ("n_e1", "PTM_1"),
        ("n_e4", "PTM_4"),
    ]
    assert [sensor.pulses_per_revolution for sensor in tug.sensors.speed] == [1, 1, 4]
    # 20 mm on 283 mm circumference lasts 13.7 ms at the working point
    width = tug.sensors.speed[1].pulse_width_deg
    assert width == pytest.approx(360.0 * 20.0 / 283.0, abs=0.05)
    assert width / 360.0 / 5.16492 == pytest.approx(13.7e-3, abs=1e-4)
    assert tug.sensors.set_point.channel == "U_setpoint"
    assert tug.logger.sample_rate_hz == 2000.0


def test_torque_gauge_is_scaled_to_newton_metre(tug):
    gauge = tug.sensors.shaft_torque
    assert gauge.torque_nm([0.0, 3.45, -10.0]).tolist() == [0.0, 1725.0, -5000.0]
    assert gauge.full_scale_nm > 3.82 * 0.97 * 1172.44
    assert gauge.resolution_nm == pytest.approx(2 * gauge.full_scale_nm / 2**12, abs=0.005)


def test_ship_with_percent_torque_is_the_same_ship(tug):
    with_rack = load_vessel("stan-tug-1205-ecu").model_dump()
    rack = with_rack["sensors"].pop("rack")
    without = tug.model_dump()
    assert without["sensors"].pop("rack") is None
    assert with_rack.pop("name") == without.pop("name") + ", with percent torque"
    assert with_rack == without
    # SAE J1939: 1 % a bit, 10 to 100 ms
    assert (rack["unit"], rack["resolution_percent"]) == ("%", 1.0)
    assert 0.01 <= rack["cycle_s"] <= 0.1


def test_ship_underway_is_the_same_ship(tug):
    underway, at_the_quay = load_vessel("stan-tug-1205-underway"), tug.model_dump()
    moving = underway.model_dump()
    assert underway.is_underway
    assert not tug.is_underway
    log = moving["sensors"].pop("ship_speed")
    assert at_the_quay["sensors"].pop("ship_speed") is None
    assert (log["unit"], log["cycle_s"]) == ("m/s", 0.2)
    assert moving.pop("working_point") == {
        "engine_speed_rpm": 1600.0,
        "shaft_torque_nm": 2570.0,
        "ship_speed_m_s": 4.75,
        "direction": None,
    }
    at_the_quay.pop("working_point")
    stated = {name: moving["hull"].pop(name) for name in ("wake_fraction", "thrust_deduction")}
    assert stated == {"wake_fraction": 0.2, "thrust_deduction": 0.15}
    for content in (moving, at_the_quay):
        for name in ("wake_fraction", "wake_fraction_std", "thrust_deduction", "thrust_deduction_std"):
            content["hull"].pop(name, None)
    assert moving.pop("name") == at_the_quay.pop("name") + ", underway"
    assert moving == at_the_quay


def test_rack_of_the_template_can_be_switched_on(tmp_path):
    path = tmp_path / "ship.toml"
    write_template("vessel", path)
    assert load_vessel(path).sensors.rack is None
    head, rack = path.read_text(encoding="utf-8").split("# [sensors.rack]")
    block, rest = rack.split("\n\n", 1)
    text = head + "[sensors.rack]" + block.replace("\n# ", "\n") + "\n\n" + rest
    path.write_text(text, encoding="utf-8")
    found = load_vessel(path).sensors.rack
    assert (found.channel, found.cycle_s, found.latency_s, found.latency_std_s) == ("X_percent", 0.05, 0.01, 0.005)
