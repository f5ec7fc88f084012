"""Options that say what is known of a ship before its test, such as ``--rpm-per-volt`` and ``--free``."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import click

from shaftprint.cli._gathered_options import gathered_options
from shaftprint.cli._known_values import by_name, hold_option, named_value, prior_option
from shaftprint.late import late

with late():
    from shaftprint.forecast._ship_before_test import ShipBeforeTest


def rpm_per_volt_option(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the option ``--rpm-per-volt``."""
    return click.option(
        "--rpm-per-volt",
        "slope_rpm_per_v",
        type=float,
        callback=_slope,
        help="Engine speed that one volt of set point asks for, with its sign, instead of slope_rpm_per_v of the "
        "campaign; needs --vessel.",
    )(command)


def _slope(context: click.Context, parameter: click.Parameter, value: float | None) -> float | None:
    if value is not None and (value == 0.0 or not math.isfinite(value)):
        raise click.BadParameter(f"expected a number other than 0, such as -250, found {value:g}.")
    return value


free_option = click.option(
    "--free",
    "freed",
    metavar="NAME",
    multiple=True,
    help="Ignore what is known of a parameter beforehand, such as tau_up.",
)
value_option = click.option(
    "--value",
    "values",
    metavar="NAME=VALUE",
    type=named_value,
    multiple=True,
    callback=by_name,
    help="Value that is assumed; the prior's mean or what is usual when not given.",
)
known_options = gathered_options(
    lambda **values: ShipBeforeTest(**values),
    (rpm_per_volt_option, prior_option, free_option, hold_option, value_option),
    name="known",
)
"""Adds ``--rpm-per-volt``, ``--prior``, ``--free``, ``--hold`` and ``--value``, taken as one ``known`` ship."""
