"""Gauss-Newton for the governor and any of its nonlinear terms, with the noise at its best colour."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.nonlinearity._noise_model import Whitened, whiten
from shaftprint.nonlinearity._record import Record
from shaftprint.nonlinearity._replay import NONE, RING, Terms, actuation_step, replay

GOVERNOR = ("K_p", "K_i", "t_d", "omega_n", "zeta", "t_sp")
"""Parameters that are always free."""

ABSENT: Mapping[str, float] = {
    "r_s": NONE,
    "d_e": 0.0,
    "limit": NONE,
    "m_min": NONE,
    "r_x": NONE,
    "air": 1.0,
    "boost_s": 1.0,
    "windup_s": 0.5,
}
"""Values with which a nonlinear term does nothing; ``limit`` is a factor on the full-load curve."""

BOUNDS: Mapping[str, tuple[float, float]] = {
    "K_p": (0.02, 200.0),
    "K_i": (0.01, 200.0),
    "t_d": (0.005, 0.009 * RING),
    "omega_n": (1.0, 200.0),
    "zeta": (0.1, 5.0),
    "t_sp": (0.001, 2.0),
    "air": (0.02, 1.0),
    "windup_s": (0.02, 200.0),
    "boost_s": (0.05, 60.0),
}

STARTS = (
    {"K_p": 5.0, "K_i": 4.0, "t_d": 0.07, "omega_n": 12.0, "zeta": 0.6, "t_sp": 0.05},
    {"K_p": 2.0, "K_i": 1.0, "t_d": 0.05, "omega_n": 20.0, "zeta": 0.7, "t_sp": 0.05},
    {"K_p": 10.0, "K_i": 12.0, "t_d": 0.04, "omega_n": 25.0, "zeta": 0.7, "t_sp": 0.05},
)
"""Where the search begins when nothing is known of the governor."""

_OBSERVER_PER_S = 0.1
_STEP = 2e-4
_LARGEST_MOVE = 0.4
_SETTLED = 1e-7


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Fit:
    """The governor and its terms at their best."""

    values: Mapping[str, float]
    """All parameters by name."""
    free: tuple[str, ...]
    """Names of those that were fitted."""
    relative_covariance: FloatArray
    """Covariance of the logarithms of the free parameters, shape (free, free)."""
    whitened: Whitened
    """Innovations at the optimum."""
    slopes: FloatArray
    """Change of the innovations with the logarithm of each free parameter, shape (innovations, free)."""

    @property
    def count(self) -> int:
        """Number of innovations."""
        return self.whitened.residual.size

    def std(self, name: str) -> float:
        """Return the standard deviation of a free parameter, in its own unit."""
        place = self.free.index(name)
        return float(self.values[name] * np.sqrt(self.relative_covariance[place, place]))


def residual(record: Record, values: Mapping[str, float]) -> FloatArray:
    """Return measured minus foretold torque of the engine over the load, shape (values,)."""
    engine, _ = foretold(record, values)
    return record.values_of(record.engine_torque - engine) / record.load


def foretold(record: Record, values: Mapping[str, float], *, inertia_s: float = 0.0) -> tuple[FloatArray, FloatArray]:
    """Return the torque of the engine [M_b0] and the speed [-] of the replay, each of shape (steps,).

    With ``inertia_s`` the loop is closed: the speed is that of a propeller of quadratic law and this inertia.
    """
    terms = Terms(
        k_p=values["K_p"],
        k_i=values["K_i"],
        delay_s=values["t_d"],
        set_point_rate=values["r_s"],
        deadband=values["d_e"],
        highest=values["limit"],
        lowest=values["m_min"],
        rack_rate=values["r_x"],
        air=values["air"],
        boost_s=values["boost_s"],
        windup_s=values["windup_s"],
        speed_slope=record.speed_slope,
        observer_per_s=0.0 if inertia_s else _OBSERVER_PER_S,
        inertia_s=inertia_s,
    )
    set_point = np.interp(record.time_s - values["t_sp"], record.time_s, record.set_point)
    engine, speed = np.empty((2, set_point.size))
    actuation = actuation_step(values["omega_n"], values["zeta"], record.step_s)
    curve = (record.curve_speed, record.curve_torque)
    replay(set_point, record.speed, record.engine_torque, terms, actuation, *curve, record.step_s, engine, speed)
    return engine, speed


def fit(record: Record, values: Mapping[str, float], extra: Sequence[str] = (), *, rounds: int = 25) -> Fit:
    """Fit the governor and the named terms from given values on.

    Parameters
    ----------
    record
        What was measured.
    values
        Start values of all parameters; those that are not free stay.
    extra
        Names of the nonlinear terms that are free.
    rounds
        Largest number of Gauss-Newton steps.

    Returns
    -------
    The optimum with the covariance of its parameters.
    """
    free = (*GOVERNOR, *extra)
    here = _limited(dict(values))
    now = residual(record, here)
    white = whiten(now)
    damping = 1e-8
    for _ in range(rounds):
        # one-sided differences will do on the way; the covariance is from central ones
        slopes = white.filtered(_one_sided(record, here, free, now))
        found = _step(record, here, free, white, slopes, damping)
        if found is None:
            break
        here, now, better, damping = found
        settled = better.squares > white.squares * (1.0 - _SETTLED)
        white = better
        if settled:
            break
    slopes = white.filtered(_slopes(record, here, free))
    variance = white.squares / max(white.residual.size - len(free) - white.taps.size + 1, 1)
    covariance: FloatArray = np.asarray(np.linalg.pinv(slopes.T @ slopes, hermitian=True) * variance, dtype=np.float64)
    return Fit(
        values=here,
        free=free,
        relative_covariance=covariance,
        whitened=white,
        slopes=slopes,
    )


def fit_governor(record: Record, start: Mapping[str, float] | None) -> Fit:
    """Fit the linear governor, from what is known of it or from several starts."""
    if start is not None:
        return fit(record, {**ABSENT, **start})
    tries = [fit(record, {**ABSENT, **one}, rounds=6) for one in STARTS]
    best = min(tries, key=lambda one: one.whitened.squares)
    return fit(record, best.values)


def slope_columns(record: Record, found: Fit, names: Sequence[str]) -> FloatArray:
    """Return the change of the residual with the logarithm of the named parameters, shape (values, names)."""
    return _slopes(record, found.values, names)


def _step(
    record: Record, here: dict[str, float], free: Sequence[str], white: Whitened, slopes: FloatArray, damping: float
) -> tuple[dict[str, float], FloatArray, Whitened, float] | None:
    """Return better values, their residual and innovations and the next damping; nothing where there are none."""
    normal, gradient = slopes.T @ slopes, slopes.T @ white.residual
    scale = np.diag(normal.diagonal() + 1e-9 * normal.diagonal().max())
    while damping < 1e5:
        move = np.linalg.solve(normal + damping * scale, -gradient)
        there = _moved(here, free, np.clip(move, -_LARGEST_MOVE, _LARGEST_MOVE))
        left = residual(record, there)
        better = whiten(left)
        if better.squares < white.squares:
            return there, left, better, max(damping / 10.0, 1e-10)
        damping *= 10.0
    return None


def _one_sided(record: Record, here: Mapping[str, float], free: Sequence[str], now: FloatArray) -> FloatArray:
    moves = _STEP * np.eye(len(free))
    ahead = [residual(record, _moved(here, free, move, bounded=False)) for move in moves]
    return (np.stack(ahead, axis=1) - now[:, np.newaxis]) / _STEP


def _slopes(record: Record, here: Mapping[str, float], free: Sequence[str]) -> FloatArray:
    """Return the change of the residual with the logarithm of each free parameter, shape (values, free)."""
    columns = []
    for place in range(len(free)):
        move = np.zeros(len(free))
        move[place] = _STEP
        ahead, behind = (residual(record, _moved(here, free, side * move, bounded=False)) for side in (1.0, -1.0))
        columns.append((ahead - behind) / (2.0 * _STEP))
    return np.stack(columns, axis=1)


def _moved(
    values: Mapping[str, float], free: Sequence[str], move: FloatArray, *, bounded: bool = True
) -> dict[str, float]:
    moved = dict(values)
    for name, by in zip(free, move.tolist(), strict=True):
        moved[name] = values[name] * float(np.exp(by))
    return _limited(moved) if bounded else moved


def _limited(values: dict[str, float]) -> dict[str, float]:
    return {
        name: min(max(value, BOUNDS[name][0]), BOUNDS[name][1]) if name in BOUNDS else value
        for name, value in values.items()
    }
