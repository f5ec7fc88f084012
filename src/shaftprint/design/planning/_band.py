"""How far a plan's promise reaches: its lines on other possible ships, in other possible noise."""

from dataclasses import replace

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.design.plan import HELD, Band, Plan, predicted_accuracy
from shaftprint.distributions import deviations_passed
from shaftprint.identify.prediction import Accuracy

# Possible ships, and noises, that are looked at.
_DRAWS = 24


def with_band(plan: Plan, *, noise_spread: float, rng: np.random.Generator) -> Plan:
    """Return a plan with the band of what it promises.

    Parameters
    ----------
    plan
        The plan, whose noise is the middle of what is possible.
    noise_spread
        Standard deviation of the logarithm of the noise's amplitude; 0 where it was measured well.
    rng
        Draws the possible ships.
    """
    ships = plan.ship.draws(_DRAWS, rng)
    if len(ships) == 1 and noise_spread == 0.0:
        return plan
    ships = np.resize(ships, (_DRAWS, ships.shape[1]))
    factors = np.exp(noise_spread * rng.permutation(_normal_quantiles(_DRAWS)))
    rows = [_deviations(plan, ship, float(factor)) for ship, factor in zip(ships, factors, strict=True)]
    here = _by_name(plan.predicted)
    # of what the plan does not tell at all nothing is said
    names = [name for name, std in here.items() if 0.0 < std < np.inf]
    table = np.array([[row[name] / here[name] for name in names] for row in rows])
    table[~np.isfinite(table)] = np.inf
    ends = np.quantile(table, (0.5 * (1.0 - HELD), 0.5 * (1.0 + HELD)), axis=0, method="nearest")
    every = {name: (float(low), float(high)) for name, low, high in zip(names, *ends, strict=True)}
    deviations = {name: both for name, both in every.items() if np.isfinite(both).all()}
    seconds = _seconds(plan, dict(zip(names, table.T, strict=True)))
    return replace(plan, band=Band(deviations=deviations, seconds=seconds))


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


def _deviations(plan: Plan, ship: FloatArray, factor: float) -> dict[str, float]:
    values = dict(zip(plan.ship.structure.names, ship.tolist(), strict=True))
    noise = [level.times(factor**2) for level in plan.noise]
    accuracy = predicted_accuracy(
        plan.structures, plan.legs, noise, values=values, priors=plan.priors, earlier=plan.earlier
    )
    return _by_name(accuracy)


def _by_name(accuracy: Accuracy) -> dict[str, float]:
    return {one.name: one.std for one in (*accuracy.parameters, *accuracy.combinations)}


def _normal_quantiles(count: int) -> FloatArray:
    """Return standard normal numbers in the middle of so many equal shares, shape (count,)."""
    upper = [deviations_passed((place + 0.5) / count) for place in range(count // 2)]
    return np.array([*upper, *(-one for one in upper), *([0.0] * (count % 2))])
