"""How far the numbers of a limit can be trusted: scatter of the slopes, what was taken for granted, profile ends.

The noise of the torque is not the same all the time, and a record that ends at 6 Hz lets a little of the future into
what should be new at each sample. The variance of the slope of the likelihood is therefore that of its sums over
blocks much longer than the memory of the loop (White, Maximum likelihood estimation of misspecified models, 1982):
``H^-1 (sum_b g_b g_b^T) H^-1``. What the fit takes for granted is moved by its standard deviation, one after the other,
and the parameters follow to first order. The level of a limit has a profile besides: a limit that acts for seconds
bends its likelihood.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.catalogue import GovernorSymbol
from shaftprint.distributions import NORMAL_95
from shaftprint.errors import IdentificationError
from shaftprint.limits._governor_fit import Fitted, fitted
from shaftprint.limits.prediction import GovernorTest, PredictionError
from shaftprint.signals import Signals
from shaftprint.vessel import Vessel

# Sums of slopes over this time are independent of each other [s]: loop and hunting have forgotten it.
BLOCK_S = 10.0
# Deviation of the slope of the engine's torque with speed that the fit takes to be zero.
SLOPE_STD = 0.1
# Steps towards the end of a profile, and how near the end they must come, as a share of the threshold.
MOST_STEPS, NEAR = 4, 0.1
PROFILE_ITERATIONS = 8


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LevelScatter:
    """Standard deviations of the free parameters of a governor."""

    names: tuple[str, ...]
    """Free parameters."""
    noise: FloatArray
    """From the noise, shape (free,)."""
    model: FloatArray
    """The same if noise were as the noise model has it, shape (free,)."""
    systematic: FloatArray
    """From what was taken for granted, shape (free,)."""

    def std(self, name: str) -> float:
        """Return the standard deviation of a parameter, all of it."""
        row = self.names.index(name)
        return float(np.hypot(self.noise[row], self.systematic[row]))

    def covariance(self, of_model: FloatArray) -> FloatArray:
        """Return a covariance with these deviations and the correlations of another, shape (free, free).

        Parameters
        ----------
        of_model
            Covariance by the noise model, shape (free, free); infinite where the data say nothing.
        """
        std = np.hypot(self.noise, self.systematic)
        of_noise = np.sqrt(np.diag(of_model))
        known = np.isfinite(std) & np.isfinite(of_noise) & (of_noise > 0.0)
        factor = np.zeros(std.size)
        factor[known] = std[known] / of_noise[known]
        both = known[:, None] & known[None, :]
        covariance = np.where(both, of_model, 0.0) * np.outer(factor, factor)
        return frozen_float(covariance + np.diag(np.where(known, 0.0, np.inf)))


def spread_of(fit: Fitted, test: GovernorTest, signals: Signals, vessel: Vessel) -> LevelScatter:
    """Return the standard deviations of a governor's parameters."""
    term, values = fit.term, fit.own
    rows = term.rows(values)
    if rows is None:
        raise IdentificationError(f"{term.name}: the simulation runs away where it was fitted.")
    slopes = rows[1:]
    names = tuple(p.name for p in term.structure.free)
    priors = fit.known
    nothing = np.linalg.norm(slopes, axis=1) == 0.0
    size = np.where(nothing, 1.0, np.linalg.norm(slopes, axis=1))
    information = (slopes @ slopes.T + np.diag(priors**2)) / np.outer(size, size)
    inverse = np.linalg.pinv(information, hermitian=True) / np.outer(size, size)
    block = max(round(BLOCK_S * term.record.rate_hz), 1)
    sums = np.add.reduceat(slopes * rows[0], np.arange(0, rows.shape[1], block), axis=1)
    scatter = np.sqrt(np.maximum(np.diag(inverse @ (sums @ sums.T + np.diag(priors**2)) @ inverse), 0.0))
    model = np.sqrt(np.maximum(np.diag(inverse), 0.0))
    follows = np.array([inverse @ (slopes @ change) for change in _taken_for_granted(fit, test, signals, vessel)])
    return LevelScatter(
        names=names,
        noise=np.where(nothing, np.inf, np.maximum(scatter, model)),
        model=np.where(nothing, np.inf, model),
        systematic=np.linalg.norm(follows, axis=0),
    )


def _taken_for_granted(fit: Fitted, test: GovernorTest, signals: Signals, vessel: Vessel) -> Sequence[FloatArray]:
    """Return the change of the innovations with each thing that the fit takes for granted, at its deviation."""
    term, values = fit.term, fit.own
    now = term.innovations(values)
    if now is None:
        return []
    point = signals.working_point
    drive_hz = term.record.drive_rate_hz
    inertia = 1.0 + vessel.inertia_upstream_std_kg_m2 / vessel.inertia_upstream_kg_m2
    torque = 1.0 + point.shaft_torque_std_nm / point.shaft_torque_nm
    residuals = term.residuals(values)
    moved = [test.with_inertia(inertia), test.with_torque(torque)]
    changes = [_with_record(term, one, drive_hz).residuals(values) - residuals for one in moved]
    sloped = {**fit.values, GovernorSymbol.ENGINE_SPEED_SLOPE: SLOPE_STD}
    changes.append(term.residuals(np.array([sloped[name] for name in term.whole.names])) - residuals)
    # a rate limit turns at whole steps of the simulation: half as long ones move the rate by as much as noise does
    finer = replace(term, record=test.record(drive_hz=2.0 * drive_hz))
    changes.append(term.predicted(values) - finer.predicted(values))
    return [now.filtered(change[None])[0] / term.scale for change in changes]


def _with_record(term: PredictionError, test: GovernorTest, drive_hz: float) -> PredictionError:
    return replace(term, record=test.record(drive_hz=drive_hz))


@dataclass(frozen=True, kw_only=True, slots=True)
class LevelInterval:
    """95 % interval of one number."""

    lower: float
    """Lower end."""
    upper: float
    """Upper end."""
    lower_open: bool
    """Whether the data set no lower end."""
    upper_open: bool
    """Whether the data set no upper end."""


def profile_interval(fit: Fitted, spread: LevelScatter, name: str) -> LevelInterval:
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
    return LevelInterval(lower=ends[0], upper=ends[1], lower_open=is_open[0], upper_open=is_open[1])


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

    def distance(at: float) -> float:
        values: Mapping[str, float] = {**fit.values, name: at}
        there = fitted(
            fit.term.whole,
            fit.term.record,
            values,
            fit.kinds,
            priors=fit.priors,
            iterations=PROFILE_ITERATIONS,
            held=(name,),
            messages=fit.messages,
        )
        return float(np.sqrt(max(there.log_squares - base, 0.0)))

    return distance
