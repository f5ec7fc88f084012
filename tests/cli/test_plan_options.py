"""Limits as they are typed."""

import click
import pytest

from shaftprint.cli._plan_options import limit_of


@pytest.mark.parametrize("typed", ["0.7mA", "0.7 mA", "0.7V", "0.7rpm", "0.7%", "0.7counts"])
def test_the_deviation_of_the_set_point_has_the_unit_of_the_lever_too(typed):
    limit = limit_of(f"set-point={typed}")
    assert (limit.name, limit.value, limit.unit) == ("set-point", 0.7, typed[3:].strip())


def test_other_limits_have_no_unit_of_the_lever():
    with pytest.raises(click.BadParameter, match="expected a positive number in rpm such as lowest-speed=600rpm"):
        limit_of("lowest-speed=4mA")
