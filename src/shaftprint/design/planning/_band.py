"""How far a plan's promise reaches: its lines on other possible ships, in other possible noise."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.design.inputs import AssumedShip
from shaftprint.design.plan import HELD, Band, Plan, noise_freedom, predicted_accuracy
from shaftprint.distributions import deviations_passed
from shaftprint.errors import DesignError
from shaftprint.identify.prediction import noise_of_line

# Possible ships, and noises, that are looked at.
_DRAWS = 24
# A governor whose line would hunt with gains so many times as large has been set to others before any test.
_LEAST_GAIN_MARGIN = 1.3


def with_band(
    plan: Plan,
    *,
    noise_spread: float,
    rng: np.random.Generator,
    noise_is_assumed: bool = False,
    possible: AssumedShip | None = None,
) -> Plan:
    """Return a plan with what it promises: the middle of the possible ships, and how far 8 of 10 of them are from it.

    What a test tells depends on the ship that it is sailed on; at the numbers that a weak first test has found, or that
    are usual, it may be half or twice as much as on most ships that are possible.

    Parameters
    ----------
    plan
        The plan, whose noise is the middle of what is possible.
    noise_spread
        Standard deviation of the logarithm of the noise's amplitude; 0 where it was measured well.
    rng
        Draws the possible ships.
    noise_is_assumed
        Whether the noise was recorded nowhere: what disturbs the torques then goes through the loop of each ship.
    possible
        The ships on which it may be sailed; those of the plan where not given.
    """
    drawn = _ships(possible or plan.ship, rng)
    if len(drawn) == 1 and noise_spread == 0.0:
        return plan
    ships = np.resize(drawn, (_DRAWS, drawn.shape[1]))
    factors = np.exp(noise_spread * rng.permutation(_normal_quantiles(_DRAWS)))
    freedom = noise_freedom(plan.legs)
    rows = [
        _deviations(plan, ship, float(factor), noise_is_assumed=noise_is_assumed, freedom=freedom)
        for ship, factor in zip(ships, factors, strict=True)
    ]
    here = {one.name: one.std for one in plan.predicted.numbers}
    # of what the plan does not tell at all nothing is said
    names = [name for name, std in here.items() if 0.0 < std < np.inf]
    table = np.array([[row[name] / here[name] for name in names] for row in rows])
    table[~np.isfinite(table)] = np.inf
    low, middle, high = np.quantile(table, (0.5 * (1.0 - HELD), 0.5, 0.5 * (1.0 + HELD)), axis=0, method="nearest")
    known = [place for place in range(len(names)) if np.isfinite(high[place])]
    over_middle = {names[place]: table[:, place] / middle[place] for place in known}
    band = Band(
        middle={names[place]: float(middle[place]) for place in known},
        deviations={
            names[place]: (float(low[place] / middle[place]), float(high[place] / middle[place])) for place in known
        },
    )
    return replace(plan, band=replace(band, seconds=_seconds(replace(plan, band=band), over_middle)))


def _ships(ship: AssumedShip, rng: np.random.Generator) -> FloatArray:
    """Return possible ships, shape (rows, parameters); where hardly one is far enough from hunting, as they are."""
    try:
        return ship.draws(_DRAWS, rng, gain_margin=_LEAST_GAIN_MARGIN)
    except DesignError:
        return ship.draws(_DRAWS, rng)


def _seconds(plan: Plan, deviations: dict[str, FloatArray]) -> tuple[float, float] | None:
    """Return the shortest and longest test that meets every wish [s]; None without wishes, or where none does."""
    ratios = plan.ratios
    if not ratios or not set(ratios) <= set(deviations):
        return None
    worst = np.max([ratio * deviations[name] for name, ratio in ratios.items()], axis=0)
    window_s = sum(leg.window_s for leg in plan.legs)
    seconds = plan.duration_s + window_s * (worst**2 - 1.0)
    low, high = np.quantile(seconds, (0.5 * (1.0 - HELD), 0.5 * (1.0 + HELD)), method="nearest").tolist()
    return (low, high) if np.isfinite(high) else None


def _deviations(
    plan: Plan, ship: FloatArray, factor: float, *, noise_is_assumed: bool, freedom: Sequence[FloatArray]
) -> dict[str, float]:
    values = dict(zip(plan.ship.structure.names, ship.tolist(), strict=True))
    noise = [level.times(factor**2) for level in plan.noise]
    if noise_is_assumed:
        noise = [
            noise_of_line(level, structure, measured_at=plan.ship.by_name, values=values)
            for structure, level in zip(plan.structures, noise, strict=True)
        ]
    accuracy = predicted_accuracy(
        plan.structures,
        plan.legs,
        noise,
        values=values,
        priors=plan.priors,
        earlier=plan.earlier,
        degrees_of_freedom=freedom,
    )
    return {one.name: one.std for one in accuracy.numbers}


def _normal_quantiles(count: int) -> FloatArray:
    """Return standard normal numbers in the middle of so many equal shares, shape (count,)."""
    upper = [deviations_passed((place + 0.5) / count) for place in range(count // 2)]
    return np.array([*upper, *(-one for one in upper), *([0.0] * (count % 2))])
