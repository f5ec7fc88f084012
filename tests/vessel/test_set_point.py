"""The set point in every unit: volts of the campaign, tables, and the unit that would fit."""

import numpy as np
import pytest
from pydantic import ValidationError

from shaftprint.vessel._set_point import SetPointSensor


def sensor(unit, **fields):
    return SetPointSensor.model_validate({"channel": "U", "unit": unit} | fields)


@pytest.mark.parametrize(
    ("unit", "fields", "reading"),
    [
        ("V", {}, -5.0),
        ("volts", {"v_per_unit": 2.0}, -2.5),
        # -10 to 0 V as 4 to 20 mA
        ("mA", {"v_per_unit": 0.625, "v_at_zero": -12.5}, 12.0),
        ("percent", {"v_per_unit": -0.1}, 50.0),
        ("1/min", {"v_per_unit": -0.004, "v_at_zero": -0.2}, 1200.0),
        # the readings of channels in these units are converted as the file gives them
        ("mV", {}, -5.0),
        ("millivolts", {"v_per_unit": 0.002}, -2.5),
        ("A", {"v_per_unit": 625.0, "v_at_zero": -12.5}, 12.0),
        ("µA", {"v_per_unit": 0.000625, "v_at_zero": -12.5}, 12.0),
    ],
)
def test_five_volts_below_zero_in_every_unit(unit, fields, reading):
    found = sensor(unit, **fields)
    assert float(found.volts(reading)) == pytest.approx(-5.0)
    assert float(found.reading(-5.0)) == pytest.approx(reading)


@pytest.mark.parametrize(
    ("unit", "fields", "sentence"),
    [
        ("mA", {}, "expected v_per_unit for a channel in mA, the volts of the campaign for one mA, found none"),
        ("V", {"v_per_unit": 0.0}, "v_per_unit other than 0"),
        ("V", {"table_rpm": [[0.0, 600.0]]}, "at least 2"),
        ("V", {"table_rpm": [[1.0, 600.0], [0.0, 900.0]]}, "readings in table_rpm that rise"),
        ("V", {"table_rpm": [[0.0, 600.0], [1.0, 900.0], [2.0, 800.0]]}, "speeds in table_rpm that all rise or all"),
        ("V", {"table_rpm": [[0.0, 600.0], [1.0, 600.0]]}, "speeds in table_rpm that all rise or all"),
        ("Hz", {}, "Input should be"),
    ],
)
def test_what_is_no_set_point_is_refused(unit, fields, sentence):
    with pytest.raises(ValidationError, match=sentence):
        sensor(unit, **fields)


def test_a_table_in_millivolts_is_that_in_volts():
    found = sensor("mV", table_rpm=[[0.0, 500.0], [5000.0, 1500.0]])
    assert found == sensor("V", table_rpm=[[0.0, 500.0], [5.0, 1500.0]])


def test_a_table_becomes_a_line_that_touches_it():
    # 200 rpm a volt up to 5 V, 400 beyond
    bent = sensor("V", table_rpm=[[0.0, 500.0], [5.0, 1500.0], [10.0, 3500.0]])
    volts = np.array([2.0, 3.0, 5.0, 6.0, 8.0, 11.0])
    # about 2 V one volt is 200 rpm: 6 V ask for 1900 rpm, 1000 more than 2 V; the last piece goes on beyond the table
    assert bent.straightened(volts, about_v=2.0) == pytest.approx([2.0, 3.0, 5.0, 7.0, 11.0, 17.0])
    assert bent.straightened(volts, about_v=8.0) == pytest.approx([3.5, 4.0, 5.0, 6.0, 8.0, 11.0])
    assert bent.covers(8.0)
    assert not bent.covers(11.0)


@pytest.mark.parametrize(
    ("stated", "reading", "fits"),
    [
        ("V", -5.0, None),
        ("V", 1184.0, "rpm"),
        ("V", 60.0, "%"),
        ("mA", -5.0, "V"),
        ("mA", 12.0, None),
        ("rpm", 12.0, "mA"),
        ("rpm", 60.0, "%"),
        ("rpm", 900.0, None),
        ("%", 1184.0, "rpm"),
        ("%", 40.0, None),
    ],
)
def test_the_unit_that_would_fit(stated, reading, fits):
    line = {} if stated == "V" else {"v_per_unit": 0.1}
    assert sensor(stated, **line).unit_that_fits(reading, 1184.0) == fits
