"""The torque gauge in every unit that telemetries have: the scale that follows, and what is refused."""

import re

import pytest
from pydantic import ValidationError

from shaftprint.settings import write_template
from shaftprint.vessel import load_vessel
from shaftprint.vessel._shaft_torque import GaugedShaft, ShaftTorqueSensor

STEEL = {"outer_diameter_m": 0.1, "shear_modulus_gpa": 80.0, "gauge_factor": 2.0}


def gauge(unit, **fields):
    stated = {"channel": "M_s", "unit": unit, "zero_nm": 0.0, "latency_s": 0.0, "full_scale_nm": 5000.0}
    return ShaftTorqueSensor.model_validate(stated | fields)


def test_a_solid_shaft_of_a_tenth_of_a_metre():
    # M = (V/U) pi G D^4 / (2 k B D) = 1e-3 * pi * 80e9 * 1e-4 / (2 * 2 * 4 * 0.1) = 5000 pi
    assert GaugedShaft(**STEEL).scale_nm_per_unit == pytest.approx(15_707.963, abs=0.001)


def test_stress_by_way_of_the_section_modulus():
    # 1000 N m on 90 mm with a bore of 45 mm: W = pi (0.09^4 - 0.045^4) / (16 * 0.09) = 1.34192e-4 m3, so 7.45199 MPa of
    # shear, 93.1499 um/m of gamma at 80 GPa, 46.5750 um/m at 45 degrees, times k = 2.1 for a full bridge: 97.8074 uV/V
    hollow = GaugedShaft(outer_diameter_m=0.09, inner_diameter_m=0.045, shear_modulus_gpa=80.0, gauge_factor=2.1)
    assert 1000.0 / hollow.scale_nm_per_unit == pytest.approx(0.0978074, rel=1e-5)


def test_the_number_of_a_maker_of_telemetries():
    # imc, CAEMAX Dx manual, chapter 12: 62 M / d^3 in mV/V for steel, N m and mm, k = 2, full bridge
    shaft = GaugedShaft(outer_diameter_m=0.12, shear_modulus_gpa=82.0, gauge_factor=2.0)
    assert 1000.0 / shaft.scale_nm_per_unit == pytest.approx(62.0 * 1000.0 / 120.0**3, rel=0.005)


def test_half_a_bridge_shows_half_and_a_reversed_one_the_opposite():
    full = GaugedShaft(**STEEL).scale_nm_per_unit
    assert GaugedShaft(**STEEL, bridge_factor=2.0).scale_nm_per_unit == 2.0 * full
    assert GaugedShaft(**STEEL, reversed=True).scale_nm_per_unit == -full


@pytest.mark.parametrize(
    ("unit", "fields", "reading"),
    [
        ("N m", {}, 1000.0),
        ("kNm", {}, 1.0),
        ("kN m", {"scale_nm_per_unit": -1000.0}, -1.0),
        ("V", {"scale_nm_per_unit": 500.0}, 2.0),
        ("mA", {"scale_nm_per_unit": 625.0, "reading_at_zero": 12.0}, 13.6),
        ("mA", {"scale_nm_per_unit": 312.5, "reading_at_zero": 4.0}, 7.2),
        ("percent", {"scale_nm_per_unit": 50.0}, 20.0),
        ("mV/V", {"shaft": STEEL}, 0.0636620),
        ("mV/V", {"shaft": STEEL | {"reversed": True}, "zero_nm": 20.0}, -0.0649352),
        ("mV/V", {"scale_nm_per_unit": 15_000.0}, 0.0666667),
    ],
)
def test_a_thousand_newton_metres_in_every_unit(unit, fields, reading):
    sensor = gauge(unit, **fields)
    assert float(sensor.torque_nm(reading)) == pytest.approx(1000.0, rel=1e-5)
    # what is written again can be read again
    assert ShaftTorqueSensor.model_validate(sensor.model_dump()) == sensor


@pytest.mark.parametrize(
    ("unit", "fields", "sentence"),
    [
        ("V", {}, r"scale_nm_per_unit\s+Field required"),
        ("mV/V", {}, r"scale_nm_per_unit\s+Field required"),
        ("V", {"shaft": STEEL}, 'expected shaft left out for a channel in "V"'),
        (
            "mV/V",
            {"shaft": STEEL, "scale_nm_per_unit": 15_000.0},
            "left out beside shaft, which gives 15708, found 15000; leave out shaft where the scale was calibrated",
        ),
        ("mV/V", {"shaft": STEEL | {"inner_diameter_m": 0.1}}, r"inner_diameter_m below outer_diameter_m = 0\.1"),
        ("mV/V", {"shaft": STEEL | {"shear_modulus_gpa": 80e9}}, "less than or equal to 500"),
        ("mV/V", {"shaft": STEEL | {"bridge_factor": 8.0}}, "less than or equal to 4"),
    ],
)
def test_what_does_not_fit_together_is_refused(unit, fields, sentence):
    with pytest.raises(ValidationError, match=sentence):
        gauge(unit, **fields)


def test_a_gauge_in_milliampere_or_millivolt_by_other_names():
    in_ma = gauge("mA", scale_nm_per_unit=312.5, reading_at_zero=4.0)
    assert gauge("A", scale_nm_per_unit=312_500.0, reading_at_zero=0.004) == in_ma
    assert gauge("mV", scale_nm_per_unit=0.5) == gauge("V", scale_nm_per_unit=500.0)


@pytest.mark.parametrize(
    ("stated", "fields", "reading", "unit"),
    [
        ("N m", {}, 1.7, "that is about 1000 times too small: values in kN m that are called N m?"),
        ("kN m", {}, 1700.0, "that is about 1000 times too large: values in N m that are called kN m?"),
        ("V", {"scale_nm_per_unit": 500.0}, 1700.0, "N m would fit, with scale_nm_per_unit = 1 in"),
        (
            "V",
            {"scale_nm_per_unit": 500.0},
            9.5,
            "mA would fit, with scale_nm_per_unit = 312.5 and reading_at_zero = 4 in",
        ),
        (
            "V",
            {"scale_nm_per_unit": 500.0},
            14.8,
            "mA would fit, with scale_nm_per_unit = 625 and reading_at_zero = 12 in",
        ),
        ("V", {"scale_nm_per_unit": 500.0}, 34.0, "% would fit, with scale_nm_per_unit = 50 in"),
        (
            "mA",
            {"scale_nm_per_unit": 312.5, "reading_at_zero": 4.0},
            3.45,
            "V would fit, with scale_nm_per_unit = 500 in",
        ),
        ("N m", {}, 400.0, None),
        # 24 kN m of another ship: 24 % of a full scale of 5000 N m would be 1200 N m, 9.5 mA 1725 N m
        ("kN m", {}, 34.0, None),
        ("kN m", {}, 9.5, None),
        ("N m", {}, 34.0, None),
    ],
)
def test_the_unit_that_would_fit_is_named(stated, fields, reading, unit):
    sensor = gauge(stated, **fields)
    fits = sensor.scale_that_fits(float(sensor.torque_nm(reading)), 1725.0)
    assert fits is None if unit is None else fits.startswith(unit)


@pytest.mark.parametrize(("stated", "reading"), [("N m", 1.7), ("V", 1700.0), ("V", 9.5), ("V", 14.8), ("V", 34.0)])
def test_what_would_fit_shows_the_torque_that_is_expected(stated, reading):
    sensor = gauge(stated, **({"scale_nm_per_unit": 500.0} if stated == "V" else {}))
    fits = sensor.scale_that_fits(float(sensor.torque_nm(reading)), 1725.0)
    fields = {name: float(value) for name, value in re.findall(r"(\w+) = ([\d.]+)", fits)}
    assert gauge(stated, **fields).torque_nm(reading) == pytest.approx(1725.0, rel=0.02)


# what a logger shows of 1725 N m in each unit, and what its file may call it
SHOWN = {"N m": 1725.0, "Nm": 1725.0, "kN m": 1.725, "MN m": 0.001725}
FACTORS = {"N m": 1.0, "Nm": 1.0, "kN m": 1e3, "MN m": 1e6}


@pytest.mark.parametrize("scale", [None, 1.0, 1000.0, 998.0, 1e6, 0.001])
@pytest.mark.parametrize("stated", SHOWN)
@pytest.mark.parametrize("called", SHOWN)
@pytest.mark.parametrize("meant", SHOWN)
def test_the_scale_that_is_proposed_is_right_at_once(meant, called, stated, scale):
    fields = {} if scale is None else {"scale_nm_per_unit": scale}
    try:
        sensor = gauge(stated, **fields)
    except ValidationError:
        # a scale near 1 of a channel in kN m is refused as such
        assert FACTORS[stated] > abs(scale)
        return
    # by the definition of the units: the reading is converted from what the file calls it
    shown = SHOWN[meant] * FACTORS[called]
    torque_nm = float(sensor.torque_nm(shown / FACTORS[sensor.unit]))
    fits = sensor.scale_that_fits(torque_nm, 1725.0)
    share = torque_nm / 1725.0
    if 0.5 < share < 2.0 or not 3e-7 < share < 3e6:
        assert fits is None
        return
    changes = {"unit": stated, **dict(re.findall(r'(unit) = "([^"]+)"', fits))}
    changes |= {"scale_nm_per_unit": float(re.search(r"scale_nm_per_unit = (\S+)", fits)[1])}
    mended = gauge(changes.pop("unit"), **changes)
    assert float(mended.torque_nm(shown / FACTORS[mended.unit])) == pytest.approx(1725.0, rel=3e-3)
    # a file that calls its unit right is never said to call it wrong
    if FACTORS[meant] == FACTORS[called]:
        assert "that are called" not in fits


@pytest.mark.parametrize("zero_nm", [0.0, 300.0])
def test_a_current_in_place_of_a_torque_keeps_its_zero(zero_nm):
    sensor = gauge("kN m", reading_at_zero=4.0, zero_nm=zero_nm)
    reading = 4.0 + 1725.0 + zero_nm
    fits = sensor.scale_that_fits(float(sensor.torque_nm(reading)), 1725.0)
    fields = {name: float(value) for name, value in re.findall(r"(\w+) = ([\d.]+)", fits)}
    assert gauge("N m", zero_nm=zero_nm, **fields).torque_nm(1e3 * reading) == pytest.approx(1725.0)


def test_the_template_has_a_shaft_that_can_be_used(tmp_path):
    path = tmp_path / "ship.toml"
    write_template("vessel", path)
    text = path.read_text(encoding="utf-8")
    text = text.replace("scale_nm_per_unit = 500.0  ", "#").replace(
        'unit = "V"                          #', 'unit = "mV/V" #'
    )
    before, after = text.split("# [sensors.shaft_torque.shaft]\n")
    fields, rest = after.split("\n\n", 1)
    shaft = "\n".join(line.removeprefix("# ") for line in fields.splitlines())
    path.write_text(f"{before}[sensors.shaft_torque.shaft]\n{shaft}\n\n{rest}", encoding="utf-8")
    sensor = load_vessel(path).sensors.shaft_torque
    # by hand: pi times 80 GPa times 0.09 m cubed, over 2 times 2.1 times 4, and a thousand millivolts in a volt
    assert sensor.scale_nm_per_unit == pytest.approx(10_905.8, abs=0.1)
