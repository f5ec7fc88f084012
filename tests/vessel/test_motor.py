"""A line that a motor drives: what its file says, in its own words, and what it may not."""

import math
from importlib.resources import files

import pytest

from shaftprint.card import disagreements
from shaftprint.errors import SettingsError
from shaftprint.vessel import load_vessel
from shaftprint.vessel._machinery import Motor

SHIPPED = files("shaftprint.vessel") / "shipped" / "e_ferry_ellen.toml"


@pytest.fixture(scope="module")
def ferry():
    return load_vessel("e-ferry-ellen")


@pytest.fixture
def changed(tmp_path):
    """Return the ferry's file with something else in it, read."""

    def read(old, new):
        text = SHIPPED.read_text(encoding="utf-8")
        assert old in text
        path = tmp_path / "ferry.toml"
        path.write_text(text.replace(old, new), encoding="utf-8")
        return load_vessel(path)

    return read


def test_shipped_ferry_is_an_equilibrium_that_agrees_with_itself(ferry):
    propeller, speed = ferry.propeller, 350.0 / 60.0
    assert ferry.machine is ferry.motor
    load = propeller.torque_coefficient * ferry.water_density_kg_m3 * speed**2 * propeller.diameter_m**5
    assert ferry.working_point.shaft_torque_nm == pytest.approx(load, rel=1e-3)
    assert disagreements(ferry) == ()


def test_words_of_the_file_are_a_motors(ferry):
    assert ferry.working_point.engine_speed_rpm == 350.0
    assert [sensor.shaft for sensor in ferry.sensors.speed] == ["engine", "propeller"]
    assert "engine" not in str(ferry.summary())
    assert "motor" in ferry.summary().facts


def test_no_order_of_a_motor_is_in_the_torque(ferry):
    assert [order.name for order in ferry.orders] == ["shaft order 1", "blade rate", "twice the blade rate"]


def test_torque_without_a_statement_is_rated_power_at_base_speed():
    motor = Motor(rated_power_kw=300.0, rated_speed_rpm=1200.0, base_speed_rpm=900.0, lowest_speed_rpm=200.0)
    speeds, torques = motor.full_load
    power_kw = [torque * 2.0 * math.pi * rpm / 60.0 / 1000.0 for rpm, torque in zip(speeds, torques, strict=True)]
    assert speeds[0] == 900.0
    assert power_kw == pytest.approx([300.0] * len(speeds))
    assert motor.regenerating[1] == (0.0,) * len(speeds)


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (
            "base_speed_rpm = 500.0",
            "base_speed_rpm = 650.0",
            "expected base_speed_rpm of at most rated_speed_rpm = 600, found 650",
        ),
        (
            "lowest_speed_rpm = 100.0",
            "lowest_speed_rpm = 700.0",
            "expected lowest_speed_rpm below rated_speed_rpm = 600, found 700",
        ),
        ("[motor]", "[engine]", r"engine\.cylinders"),
        ("[logger]", "[limits]\nmotoring_speed_rpm = [1.0]\nmotoring_torque_nm = [1.0]\n[logger]", "drag of an engine"),
        (
            "[logger]",
            '[sensors.rack]\nchannel = "X"\nunit = "%"\ncycle_s = 0.05\nlatency_s = 0.0\n[logger]',
            "the fuel of an engine, leave it out",
        ),
        (
            "[motor]",
            "[engine]\nrated_power_kw = 1.0\nrated_speed_rpm = 2.0\nidle_speed_rpm = 1.0\ncylinders = 1\n"
            "strokes_per_cycle = 4\nfull_load_speed_rpm = [1.0, 2.0]\nfull_load_torque_nm = [1.0, 1.0]\n[motor]",
            r"either a table \[engine\] or a table \[motor\], found both",
        ),
    ],
)
def test_a_file_that_cannot_be_is_refused(changed, old, new, expected):
    with pytest.raises(SettingsError, match=expected):
        changed(old, new)


def test_no_machine_at_all_is_refused(tmp_path):
    text = SHIPPED.read_text(encoding="utf-8")
    begin, end = text.index("[motor]"), text.index("[gearbox]")
    path = tmp_path / "ferry.toml"
    path.write_text((text[:begin] + text[end:]).replace('"motor"', '"engine"').replace("motor_speed", "engine_speed"))
    with pytest.raises(SettingsError, match=r"either a table \[engine\] or a table \[motor\], found neither"):
        load_vessel(path)


@pytest.mark.parametrize(
    ("old", "new", "field", "words"),
    [
        (
            "regenerating_torque_nm = 4000.0",
            "maximum_torque_nm = 6000.0",
            "working_point.shaft_torque_nm",
            "at most 6000 N m at the motor, its full load",
        ),
        (
            "regenerating_torque_nm = 4000.0",
            "maximum_torque_nm = 9000.0",
            "motor.maximum_torque_nm",
            "11940 N m at 600 rpm, as 750 kW give there",
        ),
        ("motor_speed_rpm = 350.0", "motor_speed_rpm = 90.0", "motor.lowest_speed_rpm", "a speed below"),
    ],
)
def test_contradictions_are_told_in_one_sentence_without_an_engine(changed, old, new, field, words):
    found = [one for one in disagreements(changed(old, new)) if one.field == field]
    assert len(found) == 1
    sentence = found[0].sentence("ferry.toml")
    assert words in sentence
    assert "engine" not in sentence
