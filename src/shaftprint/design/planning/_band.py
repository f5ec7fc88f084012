"""How far a plan's promise reaches: its lines on other possible ships, in other possible noise."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.design.inputs._assumed_ship import AssumedShip
from shaftprint.design.plan._band import HELD, Band
from shaftprint.design.plan._plan import Plan, noise_freedom
from shaftprint.distributions import deviations_passed
from shaftprint.errors import DesignError
from shaftprint.identify.prediction._accuracy import predict_joint_deviations
from shaftprint.identify.prediction._noise_of_line import noise_of_line
from shaftprint.identify.prediction._planned_response import planned_lines
from shaftprint.models._nyquist import stable_rows

# Possible ships, and noises, that are looked at.
_DRAWS = 64
# Lines that share most of the bins beside them.
_SHARED_LINES = 4
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

    ``plan``: the plan, whose noise is the middle of what is possible. ``noise_spread``: standard deviation of the
    logarithm of the noise's amplitude; 0 where it was measured well. ``rng``: draws the possible ships.
    ``noise_is_assumed``: whether the noise was recorded nowhere: what disturbs the torques then goes through the loop
    of each ship. ``possible``: the ships on which it may be sailed; those of the plan where not given.
    """
    drawn = _ships(possible or plan.ship, rng)
    if len(drawn) == 1 and noise_spread == 0.0:
        return plan
    ships = np.resize(drawn, (_DRAWS, drawn.shape[1]))
    factors = np.exp(noise_spread * rng.permutation(_normal_quantiles(_DRAWS)))
    freedom = noise_freedom(plan.legs)
    rows = [
        _deviations(plan, ship, float(factor), freedom, rng, noise_is_assumed=noise_is_assumed)
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
    plan: Plan,
    ship: FloatArray,
    factor: float,
    freedom: Sequence[FloatArray],
    rng: np.random.Generator,
    *,
    noise_is_assumed: bool,
) -> dict[str, float]:
    """Return what a fit might state on one possible ship, in one possible noise."""
    values = dict(zip(plan.ship.structure.names, ship.tolist(), strict=True))
    noise = [level.times(factor**2) for level in plan.noise]
    if noise_is_assumed:
        noise = [
            noise_of_line(level, structure, measured_at=plan.ship.by_name, values=values)
            for structure, level in zip(plan.structures, noise, strict=True)
        ]
    pairs = [
        (
            structure,
            planned_lines(
                leg.frequency_hz,
                noise=level,
                amplitude=np.abs(leg.amplitudes),
                duration_s=leg.window_s / _estimated_variance(of_leg, rng),
                degrees_of_freedom=of_leg,
            ),
        )
        for structure, leg, level, of_leg in zip(plan.structures, plan.legs, noise, freedom, strict=True)
    ]
    every = [*pairs, *plan.earlier]
    deviations, covariance = predict_joint_deviations(every, values=values, priors=plan.priors)
    free = list(deviations)[: len(covariance)]
    estimate = _estimate(plan.ship, ship, free, covariance, rng)
    if estimate is None:
        return deviations
    stated, _ = predict_joint_deviations(every, values=estimate, priors=plan.priors)
    return stated


def _estimate(
    assumed: AssumedShip, ship: FloatArray, free: Sequence[str], covariance: FloatArray, rng: np.random.Generator
) -> dict[str, float] | None:
    """Return what a test might find, at which its fit states deviations; None where it may find anything.

    ``assumed``, ``ship``: the ship of the plan, and the values of a possible one, shape (parameters,). ``free``,
    ``covariance``: names of the free parameters, and their covariance, shape (free, free).
    """
    if not np.isfinite(covariance).all():
        return None
    structure, values = assumed.structure, ship.copy()
    places = [structure.names.index(name) for name in free]
    values[places] = rng.multivariate_normal(ship[places], covariance, method="eigh")
    values = assumed.within_bounds(values)
    is_stable = bool(stable_rows(structure, values[None, :]).all())
    return dict(zip(structure.names, values.tolist(), strict=True)) if is_stable else None


def _estimated_variance(freedom: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Return an estimate of the noise beside each line, over what it is, shape (lines,).

    Lines that stand near to each other share most of the bins from which it is estimated.
    """
    count = freedom.size
    apart = np.arange(0.0, count + _SHARED_LINES, _SHARED_LINES)
    of_stretches = rng.standard_normal(apart.size)
    near = np.interp(np.arange(count), apart, of_stretches)
    # between two independent numbers the deviation of a straight line is smaller than theirs
    share = np.interp(np.arange(count) % _SHARED_LINES, [0.0, _SHARED_LINES], [0.0, 1.0])
    near /= np.hypot(share, 1.0 - share)
    return np.asarray(np.exp(np.sqrt(2.0 / freedom) * near))


def _normal_quantiles(count: int) -> FloatArray:
    """Return standard normal numbers in the middle of so many equal shares, shape (count,)."""
    upper = [deviations_passed((place + 0.5) / count) for place in range(count // 2)]
    return np.array([*upper, *(-one for one in upper), *([0.0] * (count % 2))])
