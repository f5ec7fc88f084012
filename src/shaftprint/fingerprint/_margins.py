"""Stability margins with their standard deviations and intervals."""

import numpy as np

from shaftprint.catalogue._roles import ShipRole
from shaftprint.fingerprint._margin_numbers import MEANINGS, margin_numbers, margin_values
from shaftprint.fingerprint._working_point_share import std_beside_fit, widened
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.uncertainty._budget import Budget, budget
from shaftprint.identify.uncertainty._profile import Profile

UNKNOWN_STD = np.inf


def margin_quantities(
    identification: Identification, profile: Profile | None = None, stated: Budget | None = None
) -> tuple[Estimate, ...]:
    """Return gain, phase and delay margin with standard deviations to first order; nothing without feedback.

    A margin that does not exist, because no gain or delay reaches instability, is left out.

    ``identification``: the fit. ``profile``: its profile likelihood with the margins among the numbers that were asked
    for; without it there is no interval. ``stated``: its uncertainty budget with the margins among the numbers; made
    here when not given.
    """
    margins = identification.margins
    if margins is None:
        return ()
    if stated is None:
        values = identification.structure_values()
        stated = budget(identification, margin_numbers(identification.structure, values))
    std = {row.name: row.std for row in stated.rows}
    quantities = []
    for name, value in margin_values(margins).items():
        if not np.isfinite(value):
            continue
        interval = None if profile is None else profile.intervals.get(name)
        is_open = (False, False) if interval is None else (interval.lower_open, interval.upper_open)
        further = std_beside_fit(stated, name) if name in std else 0.0
        unit, meaning = MEANINGS[name]
        quantities.append(
            Estimate(
                name=name,
                unit=unit,
                value=value,
                std=std.get(name, UNKNOWN_STD),
                interval_95=None
                if interval is None
                else widened((interval.lower, interval.upper), value, further, is_open),
                interval_open=is_open,
                meaning=meaning,
                role=ShipRole.LOOP_GAIN,
            )
        )
    return tuple(quantities)
