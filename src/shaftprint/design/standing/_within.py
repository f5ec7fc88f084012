"""Legs of a plan after its first periods: weaker where the ship that was found asks for more than was assumed."""

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import frozen_float
from shaftprint.design.inputs._assumed_ship import AssumedShip, ship_of_fit
from shaftprint.design.motion._bounds import bounds_of_leg
from shaftprint.design.motion._motion import motion, motion_noise
from shaftprint.design.plan._plan import Peaks, Plan, peaks_of
from shaftprint.design.planning._finish import FINE, SHARE_HELD, extremes
from shaftprint.design.search._uses import Uses
from shaftprint.errors import DesignError

if TYPE_CHECKING:
    from shaftprint.arrays import FloatArray
    from shaftprint.design.plan._leg import Leg
    from shaftprint.identify.fit._identification import Identification

_SHIPS = 200


def updated_ship(plan: Plan, fit: "Identification") -> AssumedShip:
    """Return the ship as it was assumed and as it was found, together: two normal distributions of one ship.

    What was assumed to be exact is taken as it was found, without a deviation: it does not move peaks.
    """
    assumed, measured = plan.ship, ship_of_fit(plan.ship.structure, fit)
    prior, data = assumed.covariance, measured.covariance
    open_ = np.flatnonzero((np.diag(prior) > 0.0) & (np.diag(data) > 0.0) & np.isfinite(np.diag(data)))
    if not open_.size:
        return replace(measured, covariance=frozen_float(np.zeros_like(prior)))
    block = np.ix_(open_, open_)
    before, told = np.linalg.inv(prior[block]), np.linalg.inv(data[block])
    covariance = np.zeros_like(prior)
    covariance[block] = np.linalg.inv(before + told)
    values = measured.values.copy()
    values[open_] = covariance[block] @ (before @ assumed.values[open_] + told @ measured.values[open_])
    return replace(measured, values=frozen_float(values), covariance=frozen_float(covariance))


def legs_within(plan: Plan, ship: AssumedShip, rng: np.random.Generator) -> tuple[tuple["Leg", ...], tuple[Peaks, ...]]:
    """Return the legs of a plan, weakened where a ship asks for more than its limits, and what they ask for.

    Limits hold for 98 % of the possible ships, as in the plan. Where most of those are unstable, so that nothing can be
    said of their peaks, the ship alone counts.
    """
    try:
        table = ship.draws(_SHIPS, rng)
    except DesignError:
        table = ship.values[None, :]
    every = [_leg_within(plan, place, ship, table) for place in range(len(plan.legs))]
    return tuple(leg for leg, _ in every), tuple(peaks for _, peaks in every)


def _leg_within(plan: Plan, place: int, ship: AssumedShip, table: "FloatArray") -> tuple["Leg", Peaks]:
    leg, structure = plan.legs[place], plan.structures[place]
    bounds = bounds_of_leg(plan.limits, leg.speed_share, motion_noise(structure, ship.values, plan.noise[place]))
    responses = motion(structure, table, 2.0 * np.pi * leg.frequency_hz)
    uses = Uses.of(responses, bounds, leg.harmonics, FINE)
    largest = uses.largest(leg.amplitudes)
    held = np.argsort(largest.max(axis=0), kind="stable")[: int(np.ceil(SHARE_HELD * len(table)))]
    strengths = uses.of_draws(held).strengths(leg.amplitudes, bounds, plan.limits.share_over)
    strength = min(1.0, float(strengths.min()))
    scaled = replace(leg, amplitudes=strength * leg.amplitudes)
    by_name: dict[str, float] = {}
    for bound, use in zip(bounds, (strength / strengths).tolist(), strict=True):
        by_name[bound.name] = max(use, by_name.get(bound.name, 0.0))
    ends = extremes(responses[held], scaled, uses.samples)
    return scaled, peaks_of(scaled, ends, by_name, strength * plan.peaks[place].start_use, plan.limits)
