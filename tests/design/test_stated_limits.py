"""The largest deviation of the set point, typed in volts, in rpm or in the unit of the lever."""

import pytest

from shaftprint.design.inputs._lever import Lever
from shaftprint.design.inputs._set_point_line import SetPointLine
from shaftprint.design.inputs._stated_limits import StatedLimit, set_point_rpm_of
from shaftprint.errors import RequestError

# 4 to 20 mA are 2 to 10 V of the campaign and 620 to 1810 rpm: 148.75 rpm for a volt, 74.375 for 1 mA
OF_CURRENT = SetPointLine(slope_rpm_per_v=148.75, offset_v=6.0, lever=Lever(unit="mA", v_per_unit=0.5))
OF_COUNTS = SetPointLine(slope_rpm_per_v=100.0, offset_v=5.0, lever=Lever(unit="counts", v_per_unit=1e-3))
OF_VOLTS = SetPointLine(slope_rpm_per_v=-251.0, offset_v=-5.0)


@pytest.mark.parametrize(
    ("value", "unit", "line", "rpm"),
    [
        (0.8, "mA", OF_CURRENT, 59.5),
        (0.4, "V", OF_CURRENT, 59.5),
        (60, "rpm", OF_CURRENT, 60.0),
        (1, "V", OF_VOLTS, 251.0),
        (5, "%", SetPointLine(slope_rpm_per_v=100.0, offset_v=5.0, lever=Lever(unit="%", v_per_unit=-0.1)), 50.0),
        (100, "counts", OF_COUNTS, 10.0),
    ],
)
def test_of_the_set_point_in_any_unit_that_it_has(value, unit, line, rpm):
    assert set_point_rpm_of([StatedLimit(name="set-point", value=value, unit=unit)], line) == pytest.approx(rpm)


@pytest.mark.parametrize(("line", "units"), [(OF_CURRENT, "V or rpm or mA"), (OF_VOLTS, "V or rpm")])
def test_in_a_unit_that_the_lever_has_not(line, units):
    with pytest.raises(RequestError, match=rf"in {units}, as sensors\.set_point of the vessel file has it, found 5 %"):
        set_point_rpm_of([StatedLimit(name="set-point", value=5.0, unit="%")], line)


def test_other_limits_are_none_of_the_set_point():
    assert set_point_rpm_of([StatedLimit(name="rate", value=600.0, unit="rpm/s")], OF_CURRENT) is None
