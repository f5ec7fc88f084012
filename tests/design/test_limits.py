"""Limits of the ship, and what is left of them about a speed, by hand."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.design import assumed_ship, limits_from_vessel
from shaftprint.design.inputs._gauge_range import GaugeRange
from shaftprint.design.inputs._known_ship import ship_before_test
from shaftprint.design.inputs._limits import usual_speeds
from shaftprint.errors import DesignError, SettingsError
from shaftprint.identify import Prior
from shaftprint.models._nyquist import stable_rows
from shaftprint.settings import write_template
from shaftprint.vessel import OperatingLimits, load_vessel


def test_of_a_vessel_file_without_operating_limits():
    tug = load_vessel("stan-tug-1205").model_copy(update={"limits": OperatingLimits()})
    limits = limits_from_vessel(tug, set_point_rpm=100.0)
    assert (limits.lowest_speed_rpm, limits.highest_speed_rpm) == (600.0, 1800.0)
    assert limits.brake_torque_nm == pytest.approx(465.54, abs=0.01)
    assert limits.full_load[4] == (1227.6, 1325.0)
    assert limits.motoring == ((0.0, 0.0),)
    assert limits.demand_delay_s == 0.0


def test_of_the_shipped_tug():
    # 300 N m at 1183.8 rpm, half of it independent of the speed and half proportional
    limits = limits_from_vessel(load_vessel("stan-tug-1205"), set_point_rpm=100.0)
    assert (limits.lowest_speed_rpm, limits.highest_speed_rpm) == (600.0, 1800.0)
    speeds, torques = zip(*limits.motoring, strict=True)
    assert np.interp([600.0, 1183.8, 1800.0], speeds, torques) == pytest.approx([226.03, 300.0, 378.08], abs=0.01)


def test_of_the_template_with_its_limits_switched_on(tmp_path):
    path = tmp_path / "vessel.toml"
    write_template("vessel", path)
    text = path.read_text(encoding="utf-8")
    start = text.index("# [limits]")
    stop = text.index("\n\n", start)
    path.write_text(text[:start] + text[start:stop].replace("\n# ", "\n")[2:] + text[stop:], encoding="utf-8")
    limits = limits_from_vessel(load_vessel(path), set_point_rpm=100.0)
    assert (limits.lowest_speed_rpm, limits.highest_speed_rpm) == (650.0, 1800.0)
    assert limits.motoring == ((600.0, 220.0), (1800.0, 380.0))
    assert limits.barred_rpm == ((900.0, 960.0),)
    # half a cycle of 20 ms, and half of a step of 4.8 rpm at 600 rpm/s
    assert limits.demand_delay_s == pytest.approx(0.010 + 0.004)
    # four messages a period
    assert limits.last_frequency_hz == 3.4
    assert replace(limits, demand_cycle_s=0.1).last_frequency_hz == pytest.approx(2.5)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("lowest_speed_rpm = 650.0", "lowest_speed_rpm = 2000.0", "expected lowest_speed_rpm below highest_speed_rpm"),
        ("motoring_torque_nm = [220.0, 380.0]", "motoring_torque_nm = [220.0]", "of equal length, found 2 and 1"),
        ("[[900.0, 960.0]]", "[[960.0, 900.0]]", "from a lower to a higher speed, found 960 to 900"),
    ],
)
def test_what_cannot_be_in_a_vessel_file(tmp_path, old, new, words):
    path = tmp_path / "vessel.toml"
    write_template("vessel", path)
    text = path.read_text(encoding="utf-8")
    start = text.index("# [limits]")
    stop = text.index("\n\n", start)
    switched = text[start:stop].replace("\n# ", "\n")[2:]
    path.write_text(text[:start] + switched.replace(old, new) + text[stop:], encoding="utf-8")
    with pytest.raises(SettingsError, match=words):
        load_vessel(path)


def test_usual_speeds_are_those_of_the_vessel_file_after_a_first_test_too(limits):
    # 1.15 of 1183.8 rpm; below, 540 rpm and 1.3 times 251 rpm are 866.3 rpm, less than 0.78 of 1183.8 rpm
    levels = [1.15 * 1183.8, 0.78 * 1183.8]
    tug = replace(
        limits, engine_speed_rpm=1183.8, lowest_speed_rpm=540.0, highest_speed_rpm=1800.0, set_point_rpm=251.0
    )
    assert usual_speeds(tug) == pytest.approx((1.15, 0.78))
    first_test = replace(tug, engine_speed_rpm=1361.4)
    shares = usual_speeds(first_test, working_point_rpm=1183.8)
    assert [1361.4 * share for share in shares] == pytest.approx(levels)


def test_usual_speeds_leave_room_below_full_load_and_in_the_range_of_the_gauge(limits):
    tug = replace(
        limits,
        engine_speed_rpm=1000.0,
        brake_torque_nm=100.0,
        lowest_speed_rpm=300.0,
        highest_speed_rpm=2000.0,
        set_point_rpm=50.0,
        full_load=((500.0, 150.0), (2000.0, 150.0)),
        gauge=None,
    )
    # 1.5 times the load is 150 N m at 1000 rpm; the second speed is as many times lower as between 1.15 and 0.78
    high, low = usual_speeds(tug)
    assert 0.985 <= high <= 1.0
    assert low / high == pytest.approx(0.78 / 1.15, abs=2e-3)
    gauge = GaugeRange(vessel="Tug", lowest_nm=-640.0, highest_nm=640.0, shaft_over_brake=4.0, ripple=0.5)
    # 640 N m over 400 N m: 1.8 times the load of 0.943 of the speed
    high, _ = usual_speeds(replace(tug, full_load=((500.0, 900.0), (2000.0, 900.0)), gauge=gauge))
    assert 0.93 <= high <= 0.943


def test_barred_ranges_narrow_the_free_speeds(limits):
    barred = replace(limits, barred_rpm=((700.0, 760.0), (1000.0, 1060.0)))
    assert barred.free_speeds(850.0) == (760.0, 1000.0)
    assert barred.free_speeds(1200.0) == (1060.0, 1800.0)
    with pytest.raises(DesignError, match=r"leg at 1020 rpm: expected .* outside of the barred 1000 to 1060 rpm"):
        barred.free_speeds(1020.0)


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"set_point_rpm": 0.0}, "a positive set_point_rpm, found 0"),
        ({"lowest_speed_rpm": 1900.0}, "speeds from lower to higher, found 1900 to 1800 rpm"),
        ({"full_load": ((800.0, 1.0), (700.0, 1.0))}, "full_load with ascending speeds, found 800, 700"),
    ],
)
def test_limits_that_contradict_each_other(limits, changed, words):
    with pytest.raises(DesignError, match=words):
        replace(limits, **changed)


def test_gains_that_nobody_states_are_lowered_for_a_light_line():
    closed = structure("GAUGE-CLOSED")
    light = {"tau_up": Prior(0.12, 0.06), "tau_dn": Prior(0.05, 0.02)}
    (held,) = stable_rows(closed, assumed_ship(closed, {"tau_up": 0.12, "tau_dn": 0.05}).values[np.newaxis])
    assert not held
    ship = ship_before_test(closed, light)
    lowered, usual = ship.by_name, assumed_ship(closed).by_name
    assert lowered["K_p"] < 0.5 * usual["K_p"]
    assert lowered["K_p"] / lowered["K_i"] == pytest.approx(usual["K_p"] / usual["K_i"])
    # with gains half as large again it does not hunt either
    more = assumed_ship(closed, lowered | {"K_p": 1.5 * lowered["K_p"], "K_i": 1.5 * lowered["K_i"]})
    assert stable_rows(closed, more.values[np.newaxis]).all()
    # what is stated stays
    stated = ship_before_test(closed, light, {"K_p": 5.0, "K_i": 4.0})
    assert (stated.by_name["K_p"], stated.by_name["K_i"]) == (5.0, 4.0)
