"""How far the numbers of a limit can be trusted: scatter of the slopes, and what was taken for granted.

The noise of the torque is not the same all the time, and a record that ends at 6 Hz lets a little of the future into
what should be new at each sample. The variance of the slope of the likelihood is therefore that of its sums over
blocks much longer than the memory of the loop (White, Maximum likelihood estimation of misspecified models, 1982):
``H^-1 (sum_b g_b g_b^T) H^-1``. What the fit takes for granted is moved by its standard deviation, one after the other,
and the parameters follow to first order.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.catalogue._limited_governor import GovernorSymbol
from shaftprint.errors import IdentificationError
from shaftprint.limits._governor_fit import Fitted
from shaftprint.limits.prediction._governor_test import GovernorTest
from shaftprint.limits.prediction._prediction_error import PredictionError
from shaftprint.signals._signals import Signals
from shaftprint.vessel._vessel import Vessel

# Sums of slopes over this time are independent of each other [s]: loop and hunting have forgotten it.
BLOCK_S = 10.0
# Deviation of the slope of the engine's torque with speed that the fit takes to be zero.
SLOPE_STD = 0.1


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

        ``of_model``: covariance by the noise model, shape (free, free); infinite where the data say nothing.
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
