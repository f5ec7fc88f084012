"""Levenberg-Marquardt with bounds, for many starts at once.

Each step solves ``(A + lambda D) delta = -J^T r`` with ``A = J^T J`` and ``D`` its largest diagonal so far (Marquardt's
scaling). Bounds are an active set: a parameter at a bound whose gradient points outside is held; if a step leaves the
box, the parameters that leave are put on their bound and the others are solved again with them there; one whose slope
then points back inside is let go. Clipping the step instead stops early, and so does a set that can only grow. The
damping follows Nielsen (Damping parameter in Marquardt's method, 1999).

All starts go through the same array operations; those that have converged are left out of the next step.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray, IntArray

Residuals = Callable[[FloatArray, IntArray], tuple[FloatArray, FloatArray]]

FIRST_DAMPING = 0.1
FIRST_GROWTH = 2.0
LARGEST_DAMPING = 1e12
BOUND_PASSES = 12
# 64 ulp of the cost: below it a gain cannot be told from rounding.
ROUNDING = 1.5e-14


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Descent:
    """Where each start ended."""

    theta: FloatArray
    """Parameters, shape (starts, free)."""
    cost: FloatArray
    """Half the sum of squared residuals, shape (starts,)."""
    iterations: IntArray
    """Number of steps taken or tried, shape (starts,)."""
    converged: BoolArray
    """Whether the tolerance was reached before the limit of iterations, shape (starts,)."""


def descend(
    residuals: Residuals,
    start: FloatArray,
    lower: FloatArray,
    upper: FloatArray,
    *,
    tolerance: float,
    max_iterations: int,
) -> Descent:
    """Minimise half the sum of squared residuals from every start.

    Parameters
    ----------
    residuals
        Gives residuals, shape (starts, rows), and Jacobian, shape (starts, free, rows), for parameters of shape
        (starts, free).
    start
        Start values, shape (starts, free).
    lower, upper
        Bounds, shape (free,).
    tolerance
        A start has converged when a step is expected to lower its cost by less than this share of it.
    max_iterations
        Limit of steps for each start.
    """
    theta = np.clip(start, lower, upper)
    alive = np.arange(theta.shape[0])
    r, jacobian = residuals(theta, alive)
    cost = 0.5 * np.einsum("sr,sr->s", r, r)
    gradient = np.einsum("spr,sr->sp", jacobian, r)
    hessian = jacobian @ jacobian.swapaxes(1, 2)
    scale = np.maximum(np.einsum("spp->sp", hessian), 1e-300)
    damping = np.full(cost.size, FIRST_DAMPING)
    growth = np.full(cost.size, FIRST_GROWTH)
    iterations = np.zeros(cost.size, dtype=np.int64)
    converged = np.zeros(cost.size, dtype=bool)
    for _ in range(max_iterations):
        step, settled = _bounded_step(
            hessian[alive],
            gradient[alive],
            damping[alive],
            scale[alive],
            theta[alive],
            lower,
            upper,
        )
        predicted = -np.einsum("sp,sp->s", step, gradient[alive]) - 0.5 * np.einsum(
            "sp,spq,sq->s", step, hessian[alive], step
        )
        iterations[alive] += 1
        # A step cut short, by a refusal or by bounds that found no peace, promises little without an optimum near.
        trusted = ((growth[alive] == FIRST_GROWTH) & settled) | (damping[alive] > LARGEST_DAMPING)
        flat = trusted & (predicted <= max(tolerance, ROUNDING) * cost[alive])
        converged[alive[flat]] = True
        moving = ~flat
        alive, step, predicted = alive[moving], step[moving], predicted[moving]
        if alive.size == 0:
            break
        trial = np.clip(theta[alive] + step, lower, upper)
        r, jacobian = residuals(trial, alive)
        trial_cost = 0.5 * np.einsum("sr,sr->s", r, r)
        good = (trial_cost < cost[alive]) & (predicted > 0.0)
        gain = np.divide(cost[alive] - trial_cost, predicted, out=np.zeros_like(cost[alive]), where=good)
        taken, kept = alive[good], alive[~good]
        theta[taken], cost[taken] = trial[good], trial_cost[good]
        gradient[taken] = np.einsum("spr,sr->sp", jacobian[good], r[good])
        hessian[taken] = jacobian[good] @ jacobian[good].swapaxes(1, 2)
        scale[taken] = np.maximum(scale[taken], np.einsum("spp->sp", hessian[taken]))
        damping[taken] *= np.clip(1.0 - (2.0 * gain[good] - 1.0) ** 3, 1.0 / 3.0, 2.0)
        growth[taken] = FIRST_GROWTH
        damping[kept] *= growth[kept]
        growth[kept] *= 2.0
    return Descent(theta=theta, cost=cost, iterations=iterations, converged=converged)


def _bounded_step(
    hessian: FloatArray,
    gradient: FloatArray,
    damping: FloatArray,
    scale: FloatArray,
    theta: FloatArray,
    lower: FloatArray,
    upper: FloatArray,
) -> tuple[FloatArray, BoolArray]:
    """Return the damped step of every start that stays inside the box, and whether it is the best such step."""
    to_lower, to_upper = lower - theta, upper - theta
    on_lower = (to_lower >= 0.0) & (gradient > 0.0)
    on_upper = (to_upper <= 0.0) & (gradient < 0.0)
    step = np.zeros_like(theta)
    settled = np.zeros(theta.shape[0], dtype=np.bool_)
    diagonal = np.arange(theta.shape[1])
    damped = hessian.copy()
    damped[:, diagonal, diagonal] += damping[:, None] * scale
    left: IntArray | slice = slice(None)
    for _ in range(BOUND_PASSES):
        low, high, matrix = on_lower[left], on_upper[left], damped[left]
        found = _step_beside(matrix, gradient[left], low, high, to_lower[left], to_upper[left])
        below, above = found < to_lower[left], found > to_upper[left]
        if low.any() or high.any():
            slope = gradient[left] + (matrix @ found[:, :, None])[:, :, 0]
            below |= low & (slope >= 0.0)
            above |= high & (slope <= 0.0)
        settled[left] = ((below == low) & (above == high)).all(axis=1)
        step[left], on_lower[left], on_upper[left] = found, below, above
        left = np.flatnonzero(~settled)
        if left.size == 0:
            break
    return np.clip(step, to_lower, to_upper), settled


def _step_beside(
    damped: FloatArray,
    gradient: FloatArray,
    low: BoolArray,
    high: BoolArray,
    to_lower: FloatArray,
    to_upper: FloatArray,
) -> FloatArray:
    """Return the damped step with some parameters put on their lower and upper bounds."""
    free = ~(low | high)
    if free.all():
        return np.asarray(np.linalg.solve(damped, -gradient[:, :, None])[:, :, 0])
    diagonal = np.arange(gradient.shape[1])
    system = np.where(free[:, :, None] & free[:, None, :], damped, 0.0)
    system[:, diagonal, diagonal] = np.where(free, damped[:, diagonal, diagonal], 1.0)
    put = np.where(low, to_lower, np.where(high, to_upper, 0.0))
    right = np.where(free, -gradient - (damped @ put[:, :, None])[:, :, 0], put)
    return np.asarray(np.linalg.solve(system, right[:, :, None])[:, :, 0])
