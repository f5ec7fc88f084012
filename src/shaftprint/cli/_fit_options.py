"""The options of the commands that fit structures: which, what is known, how they are weighed and searched."""

from __future__ import annotations

import click

from shaftprint.cli._gathered_options import gathered_options
from shaftprint.cli._known_values import hold_option, prior_option
from shaftprint.late import late

with late():
    from shaftprint.survey._fit_options import FitOptions


_OPTIONS = (
    prior_option,
    click.option(
        "--free",
        "freed",
        metavar="NAME",
        multiple=True,
        help="Ignore what is known of a parameter beforehand, such as tau_up, whose inertia the vessel file has.",
    ),
    hold_option,
    click.option(
        "--mode",
        type=click.Choice(["shaftprint", "thesis"]),
        default="shaftprint",
        show_default=True,
        help="How signals and responses are prepared; thesis: as in the master thesis, to compare.",
    ),
    click.option(
        "--unweighted", is_flag=True, help="Weigh all frequencies alike, as the thesis did; intervals are wider."
    ),
    click.option(
        "--starts", type=click.IntRange(min=1), default=50, show_default=True, help="Starting points of each search."
    ),
    click.option(
        "--seed", type=click.IntRange(min=0), default=1, show_default=True, help="Seed of the starting points."
    ),
)

fit_options = gathered_options(lambda **values: FitOptions(**values), _OPTIONS)
"""Adds ``--prior``, ``--free``, ``--hold``, ``--mode``, ``--unweighted``, ``--starts`` and ``--seed``, taken as one
``options``."""
