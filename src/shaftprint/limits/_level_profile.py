"""The profile of the level of a limit: one that acts for seconds bends its likelihood."""

from collections.abc import Callable, Mapping

import numpy as np

from shaftprint.distributions import NORMAL_95
from shaftprint.identify.uncertainty._profile import Interval
from shaftprint.limits._governor_fit import Fitted, fitted, scaled_information
from shaftprint.limits._uncertainty import LevelScatter

# Steps towards the end of a profile, and how near the end they must come, as a share of the threshold.
MOST_STEPS, NEAR = 4, 0.1
PROFILE_ITERATIONS = 12


def profile_interval(fit: Fitted, spread: LevelScatter, name: str) -> Interval:
    """Return the profile-likelihood interval of one parameter, widened by scatter and by what was taken for granted."""
    row = spread.names.index(name)
    parameter = next(p for p in fit.term.structure.free if p.name == name)
    # the likelihood is that of the noise model: its ends are further out by as much as the scatter is larger
    reach = NORMAL_95 * float(spread.noise[row] / spread.model[row])
    value = fit.values[name]
    ends, is_open = [], []
    for side, bound in ((-1.0, parameter.lower), (1.0, parameter.upper)):
        end, free = _end(fit, name, value, side * spread.model[row], reach, bound)
        noise = end - value
        ends.append(value + side * float(np.hypot(noise, NORMAL_95 * spread.systematic[row])))
        is_open.append(free)
    return Interval(name=name, lower=ends[0], upper=ends[1], lower_open=is_open[0], upper_open=is_open[1])


def _end(fit: Fitted, name: str, value: float, std: float, reach: float, bound: float) -> tuple[float, bool]:
    """Return where the root of twice the rise of the cost is ``reach``, and whether the bound comes first."""
    distance: Callable[[float], float] = _distance(fit, name)
    far = reach * std
    for _ in range(MOST_STEPS):
        at = value + far
        beyond = (at - bound) * np.sign(std) >= 0.0
        at = bound if beyond else at
        far = at - value
        there = distance(at)
        if beyond and there < reach:
            return bound, True
        if abs(there - reach) <= NEAR * reach:
            break
        # the root of a parabola's rise is a straight line through the estimate
        step = far * float(np.clip(reach / max(there, 1e-3), 0.3, 3.0))
        far = step
    return value + far, False


def _distance(fit: Fitted, name: str) -> Callable[[float], float]:
    base = fit.log_squares
    slopes = _followers(fit, name).items()
    bounds = {p.name: (p.lower, p.upper) for p in fit.term.structure.free}

    def distance(at: float) -> float:
        moved = at - fit.values[name]
        others = {other: float(np.clip(fit.values[other] + slope * moved, *bounds[other])) for other, slope in slopes}
        values = _better_start(fit, {**fit.values, name: at}, {**fit.values, **others, name: at})
        there = fitted(
            fit.term.whole,
            fit.term.record,
            values,
            fit.kinds,
            priors=fit.priors,
            iterations=PROFILE_ITERATIONS,
            held=(name,),
            messages=fit.messages,
            near=fit,
            recent=fit.term.recent,
            # so near the optimum its derivatives do
            checked=False,
        )
        return float(np.sqrt(max(there.log_squares - base, 0.0)))

    return distance


def _better_start(fit: Fitted, *starts: Mapping[str, float]) -> Mapping[str, float]:
    """Return the values with the smallest innovations; one of which the simulation runs away is the worst."""

    def squares(values: Mapping[str, float]) -> float:
        there = fit.term.innovations(np.array([values[name] for name in fit.term.whole.names]))
        return np.inf if there is None else there.squares

    return min(starts, key=squares)


def _followers(fit: Fitted, name: str) -> Mapping[str, float]:
    """Return how the other free parameters follow one along its profile, to first order: where its fits begin."""
    rows = fit.term.rows(fit.own)
    if rows is None:
        return {}
    names = [p.name for p in fit.term.structure.free]
    scaled, size = scaled_information(rows[1:], fit.known)
    row = names.index(name)
    others = [place for place in range(len(names)) if place != row]
    slopes = -np.linalg.pinv(scaled[np.ix_(others, others)], hermitian=True) @ scaled[others, row]
    return {names[place]: float(slope * size[row] / size[place]) for place, slope in zip(others, slopes, strict=True)}
