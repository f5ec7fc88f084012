"""The ship in the vessel file: name, number and line."""

import pytest

from shaftprint.errors import SettingsError
from shaftprint.settings import write_template
from shaftprint.vessel import is_imo_number, load_vessel

SHIP = """
# [ship]
# name = "My ship"                  # without the line
# imo_number = 9074729              # leave out where the ship has none
# class_name = "Stan Tug 1205"      # what its sister ships have in common
# line = "port"
"""


def with_ship(tmp_path, *changes):
    path = tmp_path / "vessel.toml"
    write_template("vessel", path)
    text = path.read_text(encoding="utf-8")
    assert SHIP in text
    ship = SHIP.replace("\n# ", "\n")
    for old, new in changes:
        assert old in ship
        ship = ship.replace(old, new)
    # a table may stand anywhere between others
    path.write_text(text.replace(SHIP, "") + ship, encoding="utf-8")
    return path


def test_the_ship_of_the_template_can_be_switched_on(tmp_path):
    ship = load_vessel(with_ship(tmp_path)).ship
    assert (ship.name, ship.imo_number, ship.class_name, ship.line) == ("My ship", 9074729, "Stan Tug 1205", "port")


@pytest.mark.parametrize("number", [9074729, 9176187, 8814275, 1000019])
def test_numbers_of_ships_have_a_right_last_digit(number):
    """Published: 9074729 is the example of IMO's own pages; by hand 9*7+0*6+7*5+4*4+7*3+2*2 = 139."""
    assert is_imo_number(number)


def test_one_digit_off_is_always_found():
    """All factors but 5 and 2, 4, 6 share no divisor with 10; what 5 and the even ones miss are digits 2 or 5 apart."""
    assert not any(is_imo_number(9074720 + last) for last in range(9))
    assert not is_imo_number(9074792)


@pytest.mark.parametrize("number", [0, -9074729, 90747, 90747290])
def test_other_numbers_are_none_of_ships(number):
    assert not is_imo_number(number)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            ("9074729", "9074728"),
            "expected an IMO number, seven digits of which the last checks the others, found 9074728",
        ),
        (("9074729", '"9074729"'), "ship.imo_number: expected a whole number"),
        (('line = "port"', ""), "ship.line"),
        (('"My ship"', '""'), "ship.name: expected text"),
    ],
)
def test_a_ship_that_cannot_be_is_refused(tmp_path, change, message):
    with pytest.raises(SettingsError, match=message):
        load_vessel(with_ship(tmp_path, change))
