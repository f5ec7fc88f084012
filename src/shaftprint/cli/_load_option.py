"""How far the torque of a propeller may be another on another day, as ``compare`` and ``drift`` take it."""

from collections.abc import Callable
from typing import Any

import click

from shaftprint.choices import LOAD_REPEATABILITY

PERCENT = 100.0


def load_repeatability_option(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the option ``--load-repeatability``, handed over as ``load_percent``."""
    return click.option(
        "--load-repeatability",
        "load_percent",
        type=click.FloatRange(min=0.0),
        default=PERCENT * LOAD_REPEATABILITY,
        show_default=True,
        metavar="PERCENT",
        help="Standard deviation of the propeller's torque at one speed from day to day.",
    )(command)
