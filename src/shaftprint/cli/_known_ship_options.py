"""The options of ``plan`` that say what is known of the ship and its limits."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import click

from shaftprint.cli._gathered_options import gathered_options
from shaftprint.cli._known_values import hold_option, named_value, prior_option, rpm_per_volt_option
from shaftprint.cli._plan_options import LIMITS, StatedLimit, limit_of, shares_of
from shaftprint.identify.likelihood._prior import Prior

_OPTIONS = (
    click.option(
        "--limit",
        "limits",
        metavar="NAME=VALUE",
        type=limit_of,
        multiple=True,
        help=f"Limit, such as set-point=1.0V or rate=600rpm/s; one of {', '.join(LIMITS)}.",
    ),
    click.option(
        "--speeds",
        metavar="SHARE,...",
        type=shares_of,
        help="Speeds of the legs over that of the working point; as far apart as limits allow, within 1.15,0.78.",
    ),
    rpm_per_volt_option,
    click.option("--offset", "offset_v", type=float, help="Set point at the working point [V]."),
    click.option(
        "--after",
        type=click.Path(path_type=Path),
        help="Fingerprint of a first test: its values with their covariance.",
    ),
    click.option("--noise-from", type=click.Path(path_type=Path), help="Recording of the ship, for its noise."),
    click.option("--noise-campaign", metavar="CAMPAIGN", help="Campaign of that recording."),
    prior_option,
    click.option("--free", "freed", metavar="NAME", multiple=True, help="Take nothing as known of a parameter."),
    hold_option,
    click.option(
        "--value", "values", metavar="NAME=VALUE", type=named_value, multiple=True, help="Value that is assumed."
    ),
)


@dataclass(frozen=True, kw_only=True, slots=True)
class KnownShipOptions:
    """What the user states of the ship and its limits."""

    limits: tuple[StatedLimit, ...]
    """Limits instead of those of the vessel file."""
    speeds: tuple[float, ...] | None
    """Speeds of the legs over that of the vessel file's working point; None for the usual ones."""
    rpm_per_volt: float | None
    """Slope of the set point [rpm/V]."""
    offset_v: float | None
    """Set point at the working point [V]."""
    after: Path | None
    """Fingerprint of a first test."""
    noise_from: Path | None
    """Recording that shows the noise."""
    noise_campaign: str | None
    """Its campaign."""
    priors: tuple[tuple[str, Prior], ...]
    """Priors instead of those of the vessel file, by parameter."""
    freed: tuple[str, ...]
    """Parameters of which nothing is taken as known."""
    held: tuple[tuple[str, float], ...]
    """Parameters that are held, and at what value."""
    values: tuple[tuple[str, float], ...]
    """Assumed values, by parameter."""


def known_ship_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add what ``plan`` asks of the ship, from ``--limit`` to ``--value``.

    The command takes them as one ``options``, a ``KnownShipOptions``.
    """
    return gathered_options(KnownShipOptions, _OPTIONS)(command)
