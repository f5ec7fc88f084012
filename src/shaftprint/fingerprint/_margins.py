"""Stability margins with their standard deviations and intervals."""

from collections.abc import Callable, Mapping
from functools import cache

import numpy as np

from shaftprint.fingerprint._fingerprint import Quantity
from shaftprint.identify import Identification, Profile
from shaftprint.models import Margins, margins

MARGINS: tuple[tuple[str, str, Callable[[Margins], float], str], ...] = (
    ("gain margin", "-", lambda found: found.gain_margin, "factor on the loop gain that makes the line hunt"),
    (
        "phase margin",
        "deg",
        lambda found: float(np.degrees(found.phase_margin_rad)),
        "smallest phase reserve over all crossovers",
    ),
    ("delay margin", "s", lambda found: found.delay_margin_s, "extra delay in the loop that makes the line hunt"),
)


def margin_quantities(identification: Identification, profile: Profile | None = None) -> tuple[Quantity, ...]:
    """Return gain, phase and delay margin with standard deviations to first order; nothing without feedback.

    A margin that does not exist, because no gain or delay reaches instability, is left out.

    Parameters
    ----------
    identification
        The fit.
    profile
        Its profile likelihood. The 95 % interval of a margin is its range over the parameter sets at the ends of all
        intervals: a margin follows the valley in which the parameters trade, where a standard deviation does not.
    """
    if identification.structure.loop is None:
        return ()

    names = identification.structure.names
    experiment = identification.objective.experiments[0]

    # all three margins are asked for at the same points, and each point costs a sweep of the loop
    @cache
    def at(values: tuple[float, ...]) -> Margins:
        return margins(identification.structure, values)

    def follow(number: Callable[[Margins], float]) -> Callable[[Mapping[str, float]], float]:
        return lambda named: number(at(tuple(float(named[name]) for name in names)))

    found = []
    for name, unit, number, meaning in MARGINS:
        estimate = identification.derived(name, unit, follow(number))
        if not np.isfinite(estimate.value):
            continue
        points = [] if profile is None else [experiment.own(point).tolist() for point in profile.points]
        reached = [number(at(tuple(point))) for point in points]
        interval = (min(*reached, estimate.value), max(*reached, estimate.value)) if reached else None
        found.append(
            Quantity(
                name=name, unit=unit, value=estimate.value, std=estimate.std, interval_95=interval, meaning=meaning
            )
        )
    return tuple(found)
