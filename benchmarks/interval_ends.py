"""Are the ends of the 95 % intervals those of a plain scan? Random truths, noise, structures and wrong set points.

Each case draws a structure, its truth, its noise and, in half of the cases, a set point that is early or late, so that
the optimum lies where no structure means it to be. Of some of its numbers the profile is scanned: the number is held
at every point of a grid, drawn there by a stiff spring, and all else is fitted from several starts, then again from
what the neighbours on the grid have found, until nothing improves. The ends of the scan are those of the interval to 2
% of its width, or the interval is wrong. Run ``python benchmarks/interval_ends.py --cases 200``: about a quarter of an
hour.
"""

import argparse
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

# Run as a file, the folder of the benchmarks is on the path, not the one above.
sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from benchmarks.monte_carlo_cases import GAUGE, KNOWN, THESIS, TRUTH, TUG, Case, Noise
from benchmarks.monte_carlo_responses import draw
from shaftprint.arrays import FloatArray, IntArray
from shaftprint.catalogue import structure
from shaftprint.distributions import NORMAL_95
from shaftprint.errors import ShaftprintError
from shaftprint.identify import Identification, Settings, identify, profile
from shaftprint.identify.search._levenberg_marquardt import descend
from shaftprint.identify.uncertainty._numbers import Numbers, all_numbers
from shaftprint.identify.uncertainty._profile import Interval

SEED = 34
STRUCTURES: Mapping[str, Mapping[str, float]] = {
    "OL3": TRUTH,
    "OL4": TRUTH,
    "OL5": TRUTH,
    "CL3": TRUTH,
    "CL4": TRUTH,
    "GAUGE-CORE": GAUGE,
    "GAUGE-OPEN": GAUGE,
    "GAUGE-CLOSED": GAUGE,
    "GAUGE-INFLOW": GAUGE,
}
TRUTH_SPREAD, LONGEST_SHIFT_S = 0.2, 0.2
NOISE_DB = (-10.0, 6.0)
# A scan goes so many widths of the interval beyond its ends, finely and then coarsely.
NEAR, FAR = 0.5, 5.0
FINE, COARSE = 46, 16
ROUNDS = 10
# Starts of every point of the grid beside the best optima of the search: about the estimate, and between the bounds.
DRAWN, UNIFORM = 8, 4
# Spring that holds a number, over the width of its interval.
STIFF = 1e-3
SAME_END = 0.02
RISE = 0.5 * NORMAL_95**2


@dataclass(frozen=True, kw_only=True, slots=True)
class Compared:
    """One number of one case."""

    case: int
    """Number of the case."""
    structure: str
    """Name of the structure."""
    interval: Interval
    """What the program says."""
    lower: float
    """Lower end of the scan."""
    upper: float
    """Upper end of the scan."""

    @property
    def difference(self) -> float:
        """Largest distance between the ends of both over the width of the scan."""
        apart = max(abs(self.interval.lower - self.lower), abs(self.interval.upper - self.upper))
        return apart / (self.upper - self.lower)


def fitted(number: int) -> Identification:
    """Return the fit of a random case.

    Raises
    ------
    ShaftprintError
        If the case has no stable model.
    """
    rng = np.random.default_rng([SEED, number])
    name = str(rng.choice(list(STRUCTURES)))
    case = _drawn_case(name, rng)
    drawn = draw(case, number, estimated=False)
    shift_s = float(rng.uniform(-LONGEST_SHIFT_S, LONGEST_SHIFT_S)) * float(rng.integers(2))
    turn = np.exp(2j * np.pi * shift_s * drawn.response.frequency_hz)
    response = replace(drawn.response, response=drawn.response.response * turn)
    settings = Settings(priors=drawn.priors, stability="ignored")
    return identify(case.structure, response, rng=np.random.default_rng(number), settings=settings)


def _drawn_case(name: str, rng: np.random.Generator) -> Case:
    made_of = structure(name)
    truth = {p.name: STRUCTURES[name].get(p.name, p.value) for p in made_of.free}
    bounds = {p.name: (p.lower, p.upper) for p in made_of.free}
    moved = {
        key: float(np.clip(value * np.exp(rng.normal(0.0, TRUTH_SPREAD)), *bounds[key])) for key, value in truth.items()
    }
    usual: Noise = (TUG, THESIS)[int(rng.integers(2))]
    quieter = float(rng.uniform(*NOISE_DB))
    noise = replace(usual, speed_db=usual.speed_db + quieter, torque_db=usual.torque_db + quieter)
    known = {key: std for key, std in KNOWN.items() if key in truth}
    return Case(name=name, structure=made_of, truth=moved, noise=noise, known=known)


def compared(number: int, count: int) -> Iterator[Compared]:
    """Compare some numbers of a case with their scans; none where the case has no fit."""
    try:
        fit = fitted(number)
    except ShaftprintError:
        return
    found = profile(fit)
    intervals = found.intervals
    finite = [name for name, interval in intervals.items() if np.isfinite([interval.lower, interval.upper]).all()]
    rng = np.random.default_rng([SEED, number, 1])
    for name in rng.permutation(finite)[:count].tolist():
        interval = intervals[name]
        if interval.upper > interval.lower:
            lower, upper = scanned(fit, interval, found.points[:, list(fit.objective.free)], rng)
            yield Compared(case=number, structure=fit.structure.name, interval=interval, lower=lower, upper=upper)


def scanned(
    fit: Identification, interval: Interval, named: FloatArray, rng: np.random.Generator
) -> tuple[float, float]:
    """Return the smallest and the largest value that the data allow, by brute force.

    Parameters
    ----------
    named
        Parameter sets that the program says the data allow, shape (sets, free): the scan looks at their values too, so
        that it does not step over an island.
    """
    objective = fit.objective
    place = all_numbers(objective).index(interval.name)
    best = fit.values[list(objective.free)]
    width = interval.upper - interval.lower
    near = np.linspace(interval.lower - NEAR * width, interval.upper + NEAR * width, FINE)
    far = np.linspace(interval.lower - FAR * width, interval.upper + FAR * width, COARSE)
    numbers = Numbers(objective, objective.combinations, np.full(len(named), place))
    held = np.sort(np.concatenate([near, far, numbers.values(named)]))
    held = held[np.isfinite(held)]
    spread = rng.normal(size=(DRAWN, best.size)) * np.array(
        [e.std if np.isfinite(e.std) else 1.0 for e in fit.parameters]
    )
    uniform = rng.uniform(objective.lower, objective.upper, size=(UNIFORM, best.size))
    searched = np.array([cluster.values[list(objective.free)] for cluster in fit.clusters[:3]])
    starts = np.clip(np.concatenate([searched, best + spread, uniform]), objective.lower, objective.upper)
    theta, total = _held(fit, place, np.repeat(held, len(starts)), np.tile(starts, (held.size, 1)), STIFF * width)
    theta, total = _lowest(theta, total, held.size)
    nearest = named[np.argmin(np.abs(numbers.values(named)[None, :] - held[:, None]), axis=1)]
    for _ in range(ROUNDS):
        beside = np.stack([np.roll(theta, 1, axis=0), np.roll(theta, -1, axis=0), theta, nearest], axis=1)
        again, costs = _held(fit, place, np.repeat(held, 4), beside.reshape(-1, best.size), STIFF * width)
        again, costs = _lowest(again, costs, held.size)
        settled = bool(np.all(costs >= total - 1e-3))
        theta, total = np.where((costs < total)[:, None], again, theta), np.minimum(costs, total)
        if settled:
            break
    value = Numbers(objective, objective.combinations, np.full(held.size, place)).values(theta)
    rise = np.maximum(0.5 * np.sum(objective.residuals(theta)[0] ** 2, axis=1) - fit.cost, 0.0)
    return _ends(value, np.sqrt(rise / RISE))


def _held(
    fit: Identification, place: int, held: FloatArray, start: FloatArray, spring: float
) -> tuple[FloatArray, FloatArray]:
    """Fit with a number held near each value; return parameters and costs with the spring, shape (rows,)."""
    objective = fit.objective

    def residuals(theta: FloatArray, rows: IntArray) -> tuple[FloatArray, FloatArray]:
        r, jacobian = objective.residuals(theta)
        numbers = Numbers(objective, objective.combinations, np.full(theta.shape[0], place))
        away = (numbers.values(theta) - held[rows]) / spring
        slopes = numbers.slopes(theta, np.sum(jacobian**2, axis=2)) / spring
        # a quotient by zero holds nothing
        away, slopes = np.nan_to_num(away, nan=1e6, posinf=1e6, neginf=-1e6), np.nan_to_num(slopes, posinf=0, neginf=0)
        return np.concatenate([r, away[:, None]], axis=1), np.concatenate([jacobian, slopes[:, :, None]], axis=2)

    found = descend(residuals, start, objective.lower, objective.upper, tolerance=1e-7, max_iterations=400)
    return found.theta, found.cost


def _lowest(theta: FloatArray, cost: FloatArray, count: int) -> tuple[FloatArray, FloatArray]:
    """Return the best of the rows of each point of the grid."""
    table = cost.reshape(count, -1)
    best = np.argmin(table, axis=1)
    return theta.reshape(count, -1, theta.shape[1])[np.arange(count), best], table[np.arange(count), best]


def _ends(value: FloatArray, root: FloatArray) -> tuple[float, float]:
    """Return where the root of the rise over that of the limit passes 1, outermost; between points it is straight."""
    order = np.argsort(value)
    value, root = value[order], root[order]
    inside = np.flatnonzero(root <= 1.0)
    ends = []
    for last, beyond in ((inside[0], inside[0] - 1), (inside[-1], inside[-1] + 1)):
        if not 0 <= beyond < value.size:
            ends.append(float(value[last]))
            continue
        share = (1.0 - root[last]) / (root[beyond] - root[last])
        ends.append(float(value[last] + share * (value[beyond] - value[last])))
    return ends[0], ends[1]


def main() -> None:
    """Compare and print what differs."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", type=int, default=200, help="number of random cases")
    parser.add_argument("--first", type=int, default=0, help="first case")
    parser.add_argument("--numbers", type=int, default=2, help="numbers of each case that are scanned")
    options = parser.parse_args()
    every = [
        one
        for number in range(options.first, options.first + options.cases)
        for one in compared(number, options.numbers)
    ]
    for one in every:
        if one.difference > SAME_END:
            print(
                f"case {one.case}, {one.structure}, {one.interval.name}: [{one.interval.lower:.6g}, "
                f"{one.interval.upper:.6g}], scan [{one.lower:.6g}, {one.upper:.6g}]: {100.0 * one.difference:.1f} %"
            )
    differences = np.array([one.difference for one in every])
    print(
        f"{len({one.case for one in every})} cases, {differences.size} intervals: "
        f"{np.sum(differences <= SAME_END)} within {100.0 * SAME_END:g} % of the width; median "
        f"{100.0 * np.median(differences):.2f} %, largest {100.0 * differences.max():.1f} %"
    )


if __name__ == "__main__":
    main()
