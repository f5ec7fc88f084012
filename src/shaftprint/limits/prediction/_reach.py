"""What a test itself reached: a limit that it passed is impossible, whatever a fit makes of it.

Means of the measured torque of the engine over windows are held against those of the limit, the boost worked out from
the same torque. Noise of the engine comes on top of a limit and is averaged; how much of it stays is seen in how far
each window is from the middle of its two neighbours. A rate is passed where the speed, or the torque, rises faster than
any loop makes of it: the speed moves at most by the variation of the loop's step response times what the demand moves.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray, in_blocks
from shaftprint.catalogue._limited_governor import GovernorSymbol
from shaftprint.kernels._compiled import compiled
from shaftprint.limits._candidates import Kind
from shaftprint.limits.prediction._governor_test import LEAST_SPEED, GovernorTest

# Windows of torque and speed [s], and samples of their grid a second [Hz].
TORQUE_WINDOWS_S, RATE_WINDOWS_S, RACK_WINDOWS_S = (0.5, 2.0), (0.5, 1.0, 2.0), (0.3, 0.6)
GRID_HZ = 20.0
# Standard deviations by which a window must pass a limit. A quarter of an hour has 2000 windows that are independent,
# and noise passes by so much in one of 150 of them, as tests without a limit do that stay below it everywhere.
CERTAIN = 4.5
# Share by which the inertia upstream of the gauge may be wrong.
INERTIA = 0.15
# Variation of the step response of a loop or an actuation that is hardly damped (0.2): 1 + 2 x / (1 - x), overshoot x.
SWING = 3.0
# A median of moduli over the standard deviation of normal noise.
MEDIAN = 0.6745


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Reach:
    """What a test reached."""

    torque: FloatArray
    """Torque of the engine over that of the working point on the grid, shape (samples,)."""
    curve: FloatArray
    """Full-load torque over that at the working-point speed, shape (samples,)."""
    load: FloatArray
    """Square of the speed over that of the working point, shape (samples,)."""
    accelerating: FloatArray
    """Torque that accelerates what lies upstream of the gauge, shape (samples,)."""
    lost: BoolArray
    """Where nothing is known, shape (samples,)."""
    noise: Mapping[float, float]
    """For each window of the torque [s] the standard deviation of its mean over the load."""
    set_point_rate_per_s: float
    """No slower limit of the set point's rate is possible [1/s]."""
    rack_rate_per_s: float
    """No slower limit of the rack's rate is possible [1/s]."""

    @classmethod
    def of(cls, test: GovernorTest) -> "Reach":
        """Return what a test reached."""
        every = max(round(1.0 / (GRID_HZ * test.step_s)), 1)
        speed, torque = (in_blocks(one, every).mean(axis=1) for one in (test.speed, test.engine_torque()))
        inside = (test.time_s >= test.begin_s) & (test.time_s <= test.end_s)
        lost = np.any(in_blocks(test.lost | ~inside, every), axis=1)
        step_s = every * test.step_s
        load = np.maximum(1.0 + speed, LEAST_SPEED) ** 2
        return cls(
            torque=1.0 + torque,
            curve=np.interp(speed, test.curve_speed, test.curve_shape),
            load=load,
            accelerating=np.abs(test.upstream_s * np.gradient(speed, step_s)),
            lost=lost,
            noise={w: _noise_of_mean((1.0 + torque) / load, lost, round(w / step_s)) for w in TORQUE_WINDOWS_S},
            set_point_rate_per_s=max(_rate(speed, lost, w, step_s) for w in RATE_WINDOWS_S),
            rack_rate_per_s=max(_rate(torque, lost, w, step_s) for w in RACK_WINDOWS_S),
        )

    @property
    def highest(self) -> float:
        """Highest torque over the curve, mean of half a second, over the torque of the working point."""
        return float(np.max(self._windows(self.torque / self.curve, TORQUE_WINDOWS_S[0])))

    @property
    def lowest(self) -> float:
        """Lowest torque, mean of half a second, over the torque of the working point."""
        return float(np.min(self._windows(self.torque, TORQUE_WINDOWS_S[0])))

    def passes(self, kind: Kind, values: Mapping[str, float]) -> bool:
        """Return whether the test passed a limit, the parameters of the governor as they are."""
        match kind:
            case Kind.RAMP:
                return values[GovernorSymbol.SET_POINT_RATE] < self.set_point_rate_per_s
            case Kind.RATE:
                return values[GovernorSymbol.RACK_RATE] < self.rack_rate_per_s
            case Kind.MOTORING:
                return self._is_beyond(values[GovernorSymbol.MOTORING_LIMIT] - self.torque)
            case Kind.TORQUE | Kind.SMOKE:
                full = values[GovernorSymbol.TORQUE_LIMIT] * self.curve
                share, lag_s = values[GovernorSymbol.UNBOOSTED_TORQUE], values[GovernorSymbol.TURBOCHARGER_LAG]
                boost = _late(self.torque / full, 1.0 / (GRID_HZ * lag_s)) if share < 1.0 else 1.0
                return self._is_beyond(self.torque - full * (share + (1.0 - share) * boost))
            case _:
                return False

    def _is_beyond(self, beyond: FloatArray) -> bool:
        """Return whether the mean of a window is beyond what noise and inertia explain."""
        for window_s, noise in self.noise.items():
            mean, load, accelerating = (self._windows(one, window_s) for one in (beyond, self.load, self.accelerating))
            if np.any(mean > CERTAIN * noise * load + INERTIA * accelerating):
                return True
        return False

    def _windows(self, values: FloatArray, window_s: float) -> FloatArray:
        """Return the means of all windows in which everything is known."""
        return _means(values, self.lost, round(window_s * GRID_HZ))


def _means(values: FloatArray, lost: BoolArray, count: int) -> FloatArray:
    """Return the means of all windows of some samples of which none is lost."""
    sums = np.concatenate([[0.0], np.cumsum(values)])
    losses = np.concatenate([[0], np.cumsum(lost)])
    known = losses[count:] == losses[:-count]
    return np.asarray((sums[count:] - sums[:-count])[known] / count)


def _noise(means: FloatArray, lost: BoolArray, count: int) -> float:
    """Return the deviation of means: how far each is from the middle of two so many samples away, the median of all."""
    apart = means[count:-count] - 0.5 * (means[: -2 * count] + means[2 * count :])
    losses = np.concatenate([[0], np.cumsum(lost)])
    apart = apart[losses[2 * count + 1 :] == losses[: -2 * count - 1]]
    return float(np.median(np.abs(apart))) / (MEDIAN * np.sqrt(1.5)) if apart.size else np.inf


def _noise_of_mean(values: FloatArray, lost: BoolArray, count: int) -> float:
    """Return the deviation of the mean of so many samples."""
    return _noise(np.convolve(values, np.full(count, 1.0 / count), "same"), lost, count)


def _rate(values: FloatArray, lost: BoolArray, window_s: float, step_s: float) -> float:
    """Return the rate that a signal passed for certain, whatever overshoots [1/s]; 0 where noise explains all."""
    count = round(window_s / step_s)
    smooth = max(count // 3, 1)
    means = np.convolve(values, np.full(smooth, 1.0 / smooth), "same")
    rise = np.abs(means[count:] - means[:-count])
    losses = np.concatenate([[0], np.cumsum(lost)])
    rise = rise[losses[count + 1 :] == losses[: -count - 1]]
    noise = np.sqrt(2.0) * _noise(means, lost, count)
    return float(max(np.max(rise, initial=0.0) - CERTAIN * noise, 0.0) / (window_s * SWING))


def _late(values: FloatArray, per_lag: float) -> FloatArray:
    """Return a signal behind a first-order lag, from its first value on."""
    late = np.empty(values.size)
    _follow(np.asarray(values), 1.0 - float(np.exp(-per_lag)), late)
    return late


@compiled(nogil=True)
def _follow(values, share, late) -> None:  # type: ignore[no-untyped-def]
    at = values[0]
    for k in range(values.size):
        at += share * (values[k] - at)
        late[k] = at
