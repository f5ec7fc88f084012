"""Stability margins with their standard deviations."""

from collections.abc import Callable, Mapping
from functools import cache

import numpy as np

from shaftprint.fingerprint._fingerprint import Quantity
from shaftprint.identify import Identification
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


def margin_quantities(identification: Identification) -> tuple[Quantity, ...]:
    """Return gain, phase and delay margin with standard deviations to first order; nothing without feedback.

    A margin that does not exist, because no gain or delay reaches instability, is left out.
    """
    if identification.structure.loop is None:
        return ()

    # all three margins are asked for at the same points, and each point costs a sweep of the loop
    @cache
    def at(values: tuple[float, ...]) -> Margins:
        return margins(identification.structure, values)

    def follow(number: Callable[[Margins], float]) -> Callable[[Mapping[str, float]], float]:
        return lambda named: number(at(tuple(float(value) for value in named.values())))

    estimates = (
        (identification.derived(name, unit, follow(number)), meaning) for name, unit, number, meaning in MARGINS
    )
    return tuple(
        Quantity(name=found.name, unit=found.unit, value=found.value, std=found.std, meaning=meaning)
        for found, meaning in estimates
        if np.isfinite(found.value)
    )
