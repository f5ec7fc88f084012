"""The card for the bridge and the legs of a plan, in the unit in which the lever is moved."""

from types import SimpleNamespace

import pytest

from shaftprint.design import SetPointLine
from shaftprint.tables._plan import abort_table, planned_leg_table, swing_words

# 4 to 20 mA for 2 to 10 V; shown by hand: 6.16 V are 12.32 mA, and a volt of 162.5 rpm is 2 mA
CURRENT = SimpleNamespace(unit="mA", v_per_unit=0.5, v_at_zero=0.0, reading=lambda volts: [one / 0.5 for one in volts])


def card(lever):
    """What the bridge may see."""
    return SimpleNamespace(
        set_point_v=(5.5, 6.8), set_point_rpm=(1012.0, 1224.0), speed_rpm=(990.0, 1250.0),
        brake_torque_nm=(100.0, 900.0), share_at_limit=3e-4, rate_rpm_per_s=40.0, step_rpm=0.0,
        duration_s=719.3, leave_rpm=(530.0, 1600.0), level_v=6.16, level_rpm=1120.0, lever=lever,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("lever", "level", "seen", "stop"),
    [
        (None, "6.16 V", "5.50 to 6.80 V", "the voltage is another"),
        (CURRENT, "12.32 mA (6.16 V of the campaign)", "11.00 to 13.60 mA (5.50 to 6.80 V of the campaign)",
         "the lever shows another value in mA"),
    ],
)  # fmt: skip
def test_the_bridge_holds_what_its_lever_shows(lever, level, seen, stop):
    table = abort_table(card(lever))
    assert f"To stop: hold the set point at {level}, which asks for" in table.note
    assert table.rows[2] == ("set point", seen, stop)
    assert table.rows[1][1] == "100 to 900 N·m, at the limits of the engine for at most 0.03 % of the time"


@pytest.mark.parametrize(
    ("lever", "cells", "words"), [(None, {"V": "± 0.615"}, "0.62 V"), (CURRENT, {"mA": "± 1.23", "V": "± 0.615"},
    "1.23 mA (0.62 V)")],
)  # fmt: skip
def test_legs_and_cover_say_how_far_the_lever_goes(lever, cells, words):
    line = SetPointLine(slope_rpm_per_v=162.5, offset_v=6.16, lever=lever)
    leg = SimpleNamespace(
        level_rpm=1120.0, harmonics=(1,), frequency_hz=(0.1,), periods=4, period_s=10.0, peak_rpm=100.0
    )
    peaks = SimpleNamespace(speed_rpm=(990.0, 1250.0), brake_torque_nm=(100.0, 900.0), binding=())
    table = planned_leg_table(SimpleNamespace(line=line, plan=SimpleNamespace(legs=(leg,), peaks=(peaks,))))
    (row,) = table.rows
    shown = {column.heading: cell for column, cell in zip(table.columns, row, strict=True)}
    assert {f"set point [{unit}]": cell for unit, cell in cells.items()}.items() <= shown.items()
    assert ("set point [mA]" in shown) == (lever is not None)
    assert swing_words(line, 100.0) == words
