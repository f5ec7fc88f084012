"""What cannot be a ship is refused with a message that says why."""

import re

import pytest
from pydantic import ValidationError

from shaftprint.errors import SettingsError
from shaftprint.settings import write_template
from shaftprint.vessel import SpeedSensor, load_vessel
from shaftprint.vessel._shaft_torque import ShaftTorqueSensor


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("ratio = 3.82 ", "ratio = 0.0 ", r"gearbox\.ratio: expected a number greater than 0, found 0\.0"),
        (
            "inertia_kg_m2 = 12.3",
            "inertia_kg_m2 = -1.0",
            r"inertia\[3\]\.inertia_kg_m2 \(Propeller, dry\).*not less than 0",
        ),
        ("1500.0, 1800.0]", "1800.0]", "of equal length, at least 2, found 3 and 4"),
        ("1200.0, 1500.0", "1500.0, 1200.0", "expected ascending speeds in full_load_speed_rpm"),
        ("strokes_per_cycle = 4", "strokes_per_cycle = 3", "expected strokes_per_cycle 2 or 4, found 3"),
        (
            "idle_speed_rpm = 600.0",
            "idle_speed_rpm = 1900.0",
            "idle_speed_rpm below rated_speed_rpm = 1800, found 1900",
        ),
        ('name = "n_e4"', 'name = "n_e"', "every sensor to have its own name, found n_e twice"),
        ('channel = "PTM_4"', 'channel = "M_s"', "every sensor to have its own channel, found M_s twice"),
        ("efficiency = 0.97", "efficiency = 1.2", r"gearbox\.efficiency: expected a number not greater than 1"),
        ("scale_nm_per_unit = 500.0", "scale_nm_per_unit = 0.0", "scale_nm_per_unit other than 0"),
        ("pulse_width_deg = 20.0", "pulse_width_deg = 400.0", "pulse_width_deg below 360 for 1 strips, found 400"),
        (
            "pulses_per_revolution = 4",
            "pulses_per_revolution = 4\nstrip_angles_deg = [90.0, 90.0, 90.0, 80.0]",
            "4 angles that add up to 360, found 4 that add up to 350",
        ),
        ('name = "Entrained water"', 'name = "Propeller, dry"', "its own name, found Propeller, dry twice"),
        (
            'unit = "V"                          #',
            'unit = "bar" #',
            r"sensors\.shaft_torque\.unit: expected 'V', 'mA', '%', 'mV/V', 'N m' or 'kN m', found 'bar'",
        ),
        ("cylinders = 6", "cylinders = 6.5", "cylinders: expected a whole number"),
        ("# [sensors.rack]", '[sensors.rack]\nchannel = "X"', r"sensors\.rack\.cycle_s: expected a value, found none"),
        ("# [sensors.rack]", "[sensors.rack]\ncycle_s = 0.0", r"sensors\.rack\.cycle_s: expected a number greater"),
        (
            "# [sensors.rack]",
            '[sensors.rack]\nunit = "bit"',
            r"sensors\.rack\.unit: expected '%' or 'L/h', found 'bit'",
        ),
        (
            "# [sensors.rack]",
            '[sensors.rack]\nchannel = "M_s"\nunit = "%"\ncycle_s = 0.05\nlatency_s = 0.0',
            "every sensor to have its own channel, found M_s twice",
        ),
    ],
)
def test_an_impossible_ship_is_refused(tmp_path, old, new, expected):
    path = tmp_path / "ship.toml"
    write_template("vessel", path)
    text = path.read_text()
    assert text.count(old) == 1
    path.write_text(text.replace(old, new))
    with pytest.raises(SettingsError, match=expected):
        load_vessel(path)


@pytest.mark.parametrize(("written", "unit"), [("kNm", "kN m"), ("kN m", "kN m"), ("Nm", "N m"), ("N·m", "N m")])
def test_units_of_torque_are_read_as_people_write_them(tmp_path, written, unit):
    path = tmp_path / "ship.toml"
    write_template("vessel", path)
    text = path.read_text(encoding="utf-8").replace('unit = "V"                          #', f'unit = "{written}" #')
    path.write_text(text.replace("scale_nm_per_unit = 500.0", "scale_nm_per_unit = 1000.0"), encoding="utf-8")
    assert load_vessel(path).sensors.shaft_torque.unit == unit


def test_a_gauge_in_kilonewton_metres_needs_their_scale(tmp_path):
    path = tmp_path / "ship.toml"
    write_template("vessel", path)
    text = path.read_text(encoding="utf-8").replace('unit = "V"                          #', 'unit = "kNm" #')
    path.write_text(text.replace("scale_nm_per_unit = 500.0", "scale_nm_per_unit = 1.0"), encoding="utf-8")
    with pytest.raises(SettingsError, match=r"expected scale_nm_per_unit near 1000 for a channel in kN m.*, found 1"):
        load_vessel(path)


def test_an_engine_side_mass_cannot_lie_behind_the_gauge(tmp_path):
    path = tmp_path / "ship.toml"
    write_template("vessel", path)
    path.write_text(
        path.read_text().replace('shaft = "propeller"\ngauge = "downstream"', 'shaft = "engine"\ngauge = "downstream"')
    )
    with pytest.raises(SettingsError, match="engine shaft to lie upstream of the gauge"):
        load_vessel(path)


def test_both_sides_of_the_gauge_need_inertia(tmp_path):
    path = tmp_path / "ship.toml"
    write_template("vessel", path)
    path.write_text(path.read_text().replace('gauge = "downstream"', 'gauge = "upstream"'))
    with pytest.raises(SettingsError, match="expected some inertia downstream of the torque gauge, found none"):
        load_vessel(path)


def test_all_that_is_wrong_with_a_table_is_told_at_once(tmp_path):
    path = tmp_path / "ship.toml"
    write_template("vessel", path)
    text = path.read_text().replace('gauge = "downstream"', 'gauge = "upstream"')
    path.write_text(text.replace('name = "Entrained water"', 'name = "Propeller, dry"'))
    with pytest.raises(SettingsError, match=r"found Propeller, dry twice.*some inertia downstream .*, found none"):
        load_vessel(path)
    with pytest.raises(ValidationError, match=r"below 90 for 4 strips, found 95.*add up to 360, found 4 that .* 350"):
        SpeedSensor(
            name="n",
            channel="P",
            shaft="engine",
            pulses_per_revolution=4,
            unit="V",
            pulse_width_deg=95.0,
            strip_angles_deg=(90.0, 90.0, 90.0, 80.0),
        )


def test_the_only_speed_sensor_is_told_by_its_own_fault_alone(tmp_path):
    """Entries with a fault were not counted, and none seemed to be there."""
    path = tmp_path / "ship.toml"
    write_template("vessel", path)
    tables = re.split(r"^(?=\[)", path.read_text(), flags=re.MULTILINE)
    first, *others = [table for table in tables if table.startswith("[[sensors.speed]]")]
    kept = [table for table in tables if table not in others]
    path.write_text("".join(kept).replace(first, first.replace('shaft = "', 'latency_s = -1.0\nshaft = "')))
    with pytest.raises(SettingsError) as refused:
        load_vessel(path)
    assert str(refused.value).splitlines()[0].endswith("1 field cannot be used.")
    assert "sensors.speed[1].latency_s" in str(refused.value)


def test_rows_without_standard_deviation_take_that_of_the_trade(tmp_path):
    path = tmp_path / "ship.toml"
    write_template("vessel", path)
    lines = [line for line in path.read_text().splitlines() if not line.startswith("std_kg_m2")]
    path.write_text("\n".join(lines))
    vessel = load_vessel(path)
    upstream = [row for row in vessel.inertia if row.gauge == "upstream"]
    referred = [row.inertia_kg_m2 * (vessel.gearbox.ratio**2 if row.shaft == "engine" else 1.0) for row in upstream]
    assert vessel.inertia_upstream_std_kg_m2 == pytest.approx(0.05 * sum(one**2 for one in referred) ** 0.5)
    assert "= 0.05 of the inertia" in vessel.taken_as_usual[-1]
    assert vessel.inertia_downstream_kg_m2 == pytest.approx(16.7)


def test_the_zero_of_the_gauge_is_subtracted_and_a_reversed_gauge_turned():
    gauge = ShaftTorqueSensor(
        channel="M_s", unit="V", scale_nm_per_unit=-500.0, zero_nm=20.0, latency_s=0.0, full_scale_nm=5000.0
    )
    assert gauge.torque_nm(-2.0) == pytest.approx(980.0)


def with_wheel(tmp_path, text):
    path = tmp_path / "ship.toml"
    write_template("vessel", path)
    lines = path.read_text(encoding="utf-8").splitlines()
    first = next(number for number, line in enumerate(lines) if line.startswith("pulses_per_revolution = 4"))
    path.write_text("\n".join([*lines[:first], text, *lines[first + 1 :]]), encoding="utf-8")
    return load_vessel(path)


@pytest.mark.parametrize(
    ("wheel", "counted", "closest"),
    [("60", 60, 60), ("60-2", 58, 60), ("36-1", 35, 36), ("36-2-1", 33, 36), ("36-2-2-2", 30, 36), ("12+1", 12, 24)],
)
def test_teeth_of_a_wheel_are_counted(tmp_path, wheel, counted, closest):
    vessel = with_wheel(tmp_path, f'wheel = "{wheel}"')
    sensor = vessel.sensors.speed[1]
    assert (sensor.pulses_per_revolution, sensor.toothed.closest, str(sensor.toothed)) == (counted, closest, wheel)
    # what is written again can be read again
    assert type(vessel).model_validate(vessel.model_dump()) == vessel


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ('wheel = "60 teeth"', r'sensors\.speed\[2\].*expected a wheel such as "60-2" .*found "60 teeth"'),
        ('wheel = "60-"', 'expected a wheel such as "60-2"'),
        ('wheel = "60-0"', "expected at least one tooth missing in each gap"),
        ('wheel = "60-2+1"', "expected either gaps or further teeth, not both"),
        ('wheel = "4-2"', "expected at least 4 evenly spaced teeth for each gap"),
        ('wheel = "0"', "expected at least 4 evenly spaced teeth"),
        ('wheel = "2000"', "expected at most 1000 teeth"),
        (
            'wheel = "60-2"\npulses_per_revolution = 60',
            'pulses_per_revolution left out beside wheel = "60-2", found 60',
        ),
        ('wheel = "60-2"\npulse_width_deg = 6.0', "pulse_width_deg below 6 for 60 strips, found 6"),
        ("wheel = 60", r"wheel \(n_e4\): expected text in quotes, found 60"),
    ],
)
def test_an_impossible_wheel_is_refused(tmp_path, text, expected):
    with pytest.raises(SettingsError, match=expected):
        with_wheel(tmp_path, text)


def test_least_rate_is_four_samples_a_tooth_in_round_numbers():
    # 60 teeth at 30 turns a second, 24 at 7.9, 36 at 1.01
    rates = [SpeedSensor.model_validate(SPEED | {"wheel": wheel}).toothed for wheel in ("60-2", "12+1", "36-1")]
    found = [wheel.least_rate_hz(turns) for wheel, turns in zip(rates, (30.0, 7.9, 1.01), strict=True)]
    assert found == pytest.approx([7200.0, 760.0, 150.0])


SPEED = {"name": "n", "channel": "P", "shaft": "engine", "unit": "V"}
