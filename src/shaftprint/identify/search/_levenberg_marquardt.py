"""Levenberg-Marquardt with bounds, for many starts at once.

Each step solves ``(A + lambda D) delta = -J^T r`` with ``A = J^T J`` and ``D`` its largest diagonal so far (Marquardt's
scaling). Bounds are an active set: a parameter at a bound whose gradient points outside is held; if a step leaves the
box, the parameters that leave are put on their bound and the others are solved again with them there; one whose slope
then points back inside is let go. Clipping the step instead stops early, and so does a set that can only grow. The
damping follows Nielsen (Damping parameter in Marquardt's method, 1999).

Where a step gains much more than ``A`` predicts, the cost is flatter than ``A`` says: the next step is stretched, each
time four times as far, until one gains less than predicted. Without it a model that cannot follow the data creeps, such
as a pure delay between two wraps of the fast lines' phase.

Where derivatives cost many times as much as residuals, those of earlier steps may be carried along: they are found anew
where a step gained less than they promise, and before a descent ends.

All starts go through the same array operations; those that have converged are left out of the next step. A step to
where the parameters are not allowed to be is refused as one that raises the cost is.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray, IntArray

Residuals = Callable[[FloatArray, IntArray], tuple[FloatArray, FloatArray]]
Allowed = Callable[[FloatArray], BoolArray]

FIRST_DAMPING = 0.1
FIRST_GROWTH = 2.0
LARGEST_DAMPING = 1e12
SMALLEST_DAMPING = 1e-12
STRETCH_ABOVE_GAIN = 1.5
UNSTRETCH_BELOW_GAIN = 1.0
# Derivatives that promise so much more than a step gained, or were carried over so many steps, are found anew.
RENEW_BELOW_GAIN, MOST_CARRIED = 0.25, 20
# Where those that were found anew promise less than so many tolerances, the rest is done with them.
LAST_TOLERANCES = 25.0
LARGEST_STRETCH = 256.0
# Curvature of a parameter without influence: the system stays solvable and its step stays zero.
SMALLEST_SCALE = 1e-100
BOUND_PASSES = 16
# In the last passes one parameter changes at a time, the first that must: that cannot run in a circle (Murty, Note on a
# Bard-type scheme for solving the complementarity problem, 1974).
SINGLE_PASSES = 13
# 64 ulp of the cost: below it a gain cannot be told from rounding.
ROUNDING = 1.5e-14
TINY = 1e-300
# A gain is compared with no less than this share of the cost, lest the quotient overflow.
LEAST_SHARE = 1e-30


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
    refused: BoolArray
    """Whether a step to a lower cost led to where the parameters are not allowed to be, shape (starts,)."""
    information: FloatArray
    """Product of the derivatives of the residuals at the end of each, ``J J^T``, shape (starts, free, free)."""


def descend(
    residuals: Residuals,
    start: FloatArray,
    lower: FloatArray,
    upper: FloatArray,
    *,
    tolerance: float,
    max_iterations: int,
    leader_tolerance: float | None = None,
    allowed: Allowed | None = None,
    anew: Residuals | None = None,
    checked: bool = True,
) -> Descent:
    """Minimise half the sum of squared residuals from every start.

    ``residuals``: gives residuals, shape (starts, rows), and Jacobian, shape (starts, free, rows), for parameters of
    shape (starts, free). ``start``: start values, shape (starts, free). ``lower``, ``upper``: bounds, shape (free,).
    ``tolerance``: a start has converged when a step is expected to lower its cost by less than this share of it.
    ``max_iterations``: limit of steps for each start. ``leader_tolerance``: the same for the start of lowest cost,
    which polishes its optimum while others are still on their way. ``allowed``: tells where parameters, shape (rows,
    free), may be, shape (rows,); everywhere within the bounds when not given. The starts must be there. ``anew``: the
    same as ``residuals``, where these give derivatives that are carried along; such a renewal counts as an iteration.
    ``checked``: whether derivatives are found anew before a descent ends, too.
    """
    theta = np.clip(start, lower, upper)
    starts = np.arange(theta.shape[0])
    iterations = np.full(starts.size, max_iterations)
    cost = np.empty(starts.size)
    converged, refused = np.zeros((2, starts.size), dtype=np.bool_)
    information = np.empty((*theta.shape, theta.shape[1]))
    # The old Jacobian lives until the new one is there: freed before, its memory would go back and be faulted in again.
    r, jacobian = residuals(theta, starts)
    at, lowest, carried = _Position.at_start(theta, r, jacobian), np.inf, int(anew is not None)
    last = not checked
    for iteration in range(1, max_iterations + 1):
        step, settled = _bounded_step(at, lower, upper)
        predicted = -np.vecdot(step, at.gradient + 0.5 * times(at.hessian, step))
        # A step cut short, by a refusal or by bounds that found no peace, promises little without an optimum near.
        trusted = ((at.growth == FIRST_GROWTH) & settled) | (at.damping > LARGEST_DAMPING)
        small = max(tolerance, ROUNDING) * at.cost
        leader = np.argmin(at.cost)
        if leader_tolerance is not None and at.cost[leader] <= lowest:
            small[leader] = max(leader_tolerance, ROUNDING) * at.cost[leader]
        flat = trusted & (predicted <= small)
        last |= carried == 0 and bool(np.all(trusted & (predicted <= LAST_TOLERANCES * small)))
        over = at.doubted.any() or carried > MOST_CARRIED
        if anew is not None and carried and (over or (flat.any() and not last)):
            at.renew(*anew(at.theta, at.starts))
            carried = 0
            continue
        if flat.any():
            lowest = min(lowest, at.cost[flat].min())
            done, moving = at.starts[flat], ~flat
            theta[done], cost[done], information[done] = at.theta[flat], at.cost[flat], at.hessian[flat]
            iterations[done], converged[done], refused[done] = iteration, True, at.refused[flat]
            at, step, predicted = at.chosen(moving), step[moving], predicted[moving]
            if at.starts.size == 0:
                break
        trial = np.minimum(np.maximum(at.theta + at.stretch[:, None] * step, lower), upper)
        r, jacobian = residuals(trial, at.starts)
        carried += at.advance(trial, r, jacobian, predicted, allowed)
    theta[at.starts], cost[at.starts], refused[at.starts] = at.theta, at.cost, at.refused
    information[at.starts] = at.hessian
    return Descent(
        theta=theta,
        cost=cost,
        iterations=iterations,
        converged=converged,
        refused=refused,
        information=information,
    )


@dataclass(slots=True, eq=False)
class _Position:
    """Where the starts stand that still move, one row each."""

    starts: IntArray
    theta: FloatArray
    cost: FloatArray
    gradient: FloatArray
    hessian: FloatArray
    scale: FloatArray
    damping: FloatArray
    growth: FloatArray
    stretch: FloatArray
    refused: BoolArray
    doubted: BoolArray

    @classmethod
    def at_start(cls, theta: FloatArray, r: FloatArray, jacobian: FloatArray) -> "_Position":
        """Return the position of every start before its first step."""
        cost, gradient, hessian = quadratic(r, jacobian)
        return cls(
            starts=np.arange(cost.size),
            theta=theta.copy(),
            cost=cost,
            gradient=gradient,
            hessian=hessian,
            scale=np.maximum(diagonals(hessian), SMALLEST_SCALE),
            damping=np.full(cost.size, FIRST_DAMPING),
            growth=np.full(cost.size, FIRST_GROWTH),
            stretch=np.ones(cost.size),
            refused=np.zeros(cost.size, dtype=np.bool_),
            doubted=np.zeros(cost.size, dtype=np.bool_),
        )

    def renew(self, r: FloatArray, jacobian: FloatArray) -> None:
        """Take derivatives that were found anew; a step that failed says nothing against them."""
        _, self.gradient, self.hessian = quadratic(r, jacobian)
        self.scale = np.maximum(self.scale, diagonals(self.hessian))
        self.growth, self.doubted = np.full_like(self.growth, FIRST_GROWTH), np.zeros_like(self.doubted)

    def chosen(self, rows: BoolArray) -> "_Position":
        """Return some of the rows."""
        return _Position(*(getattr(self, name)[rows] for name in self.__slots__))

    def advance(
        self, trial: FloatArray, r: FloatArray, jacobian: FloatArray, predicted: FloatArray, allowed: Allowed | None
    ) -> bool:
        """Take the trials that lower the cost; change damping and stretch by how well their gain was predicted.

        Returns whether there were any.
        """
        cost, gradient, hessian = quadratic(r, jacobian)
        good = (cost < self.cost) & (predicted > 0.0)
        if allowed is not None:
            lower = good.copy()
            good[lower] = allowed(trial[lower])
            self.refused = self.refused | (lower & ~good)
        least_gain = np.maximum(predicted * self.stretch, LEAST_SHARE * self.cost + TINY)
        gain = np.where(good, (self.cost - cost) / least_gain, 0.0)
        # A stretched step that fails says nothing against the step itself.
        failed = ~good & (self.stretch == 1.0)
        surplus = 2.0 * gain - 1.0
        fitting = np.where(good, np.minimum(np.maximum(1.0 - surplus * surplus * surplus, 1.0 / 3.0), 2.0), 1.0)
        self.damping = np.maximum(self.damping * np.where(failed, self.growth, fitting), SMALLEST_DAMPING)
        self.growth = np.where(failed, 2.0 * self.growth, FIRST_GROWTH)
        longer = np.where(gain > STRETCH_ABOVE_GAIN, np.minimum(4.0 * self.stretch, LARGEST_STRETCH), self.stretch)
        self.stretch = np.where(gain < UNSTRETCH_BELOW_GAIN, 1.0, longer)
        self.doubted = gain < RENEW_BELOW_GAIN
        if good.all():
            self.theta, self.cost, self.gradient, self.hessian = trial, cost, gradient, hessian
        else:
            row = good[:, None]
            self.theta, self.cost = np.where(row, trial, self.theta), np.where(good, cost, self.cost)
            self.gradient = np.where(row, gradient, self.gradient)
            self.hessian = np.where(row[:, :, None], hessian, self.hessian)
        self.scale = np.maximum(self.scale, diagonals(self.hessian))
        return bool(good.any())


def quadratic(residuals: FloatArray, jacobian: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return cost, gradient and Gauss-Newton matrix of every row."""
    hessian = jacobian @ jacobian.swapaxes(1, 2)
    return 0.5 * np.vecdot(residuals, residuals), times(jacobian, residuals), hessian


def times(matrix: FloatArray, vector: FloatArray) -> FloatArray:
    """Return the product of every row's matrix and vector."""
    return np.asarray((matrix @ vector[:, :, None])[:, :, 0])


def diagonals(matrix: FloatArray) -> FloatArray:
    """Return a view of the diagonal of every row's matrix."""
    rows, size, _ = matrix.shape
    return matrix.reshape(rows, -1)[:, :: size + 1]


def _bounded_step(at: _Position, lower: FloatArray, upper: FloatArray) -> tuple[FloatArray, BoolArray]:
    """Return the damped step of every start that stays inside the box, and whether it is the best such step.

    Parameters are scaled until every element of ``D`` is near one: derivatives of a start far from the data can differ
    by 28 decades, and the elimination, which exchanges rows alone, would call such a system singular. The factors are
    powers of two, so that nothing is rounded and a bound is still met exactly.
    """
    unit = np.ldexp(1.0, -(np.frexp(at.scale)[1] // 2))
    to_lower, to_upper = (lower - at.theta) / unit, (upper - at.theta) / unit
    gradient = at.gradient * unit
    damped = at.hessian.copy()
    diagonals(damped)[...] += at.damping[:, None] * at.scale
    damped *= unit[:, :, None] * unit[:, None, :]
    low, high = to_lower >= 0.0, to_upper <= 0.0
    if low.any() or high.any():
        low, high = low & (gradient > 0.0), high & (gradient < 0.0)
    step, settled = _held_step(damped, gradient, to_lower, to_upper, low, high, BOUND_PASSES)
    return step * unit, settled


def _held_step(
    damped: FloatArray,
    gradient: FloatArray,
    to_lower: FloatArray,
    to_upper: FloatArray,
    low: BoolArray,
    high: BoolArray,
    passes: int,
) -> tuple[FloatArray, BoolArray]:
    """Return the step with some parameters put on their bounds; the rows that chose them wrong go again."""
    step = _step_beside(damped, gradient, low, high, to_lower, to_upper)
    below, above = step < to_lower, step > to_upper
    change = below | above
    back_up, back_down = low, high
    if low.any() or high.any():
        slope = gradient + times(damped, step)
        back_up, back_down = low & (slope < 0.0), high & (slope > 0.0)
        change |= back_up | back_down
    settled: BoolArray = np.logical_not(change.any(axis=1))
    if settled.all():
        return step, settled
    if passes == 1:
        return np.minimum(np.maximum(step, to_lower), to_upper), settled
    if passes <= SINGLE_PASSES:
        change &= np.cumsum(change, axis=1) == 1
    low, high = (low & ~(back_up & change)) | (below & change), (high & ~(back_down & change)) | (above & change)
    open_rows = ~settled
    step[open_rows], settled[open_rows] = _held_step(
        damped[open_rows],
        gradient[open_rows],
        to_lower[open_rows],
        to_upper[open_rows],
        low[open_rows],
        high[open_rows],
        passes - 1,
    )
    return step, settled


def _step_beside(
    damped: FloatArray,
    gradient: FloatArray,
    low: BoolArray,
    high: BoolArray,
    to_lower: FloatArray,
    to_upper: FloatArray,
) -> FloatArray:
    """Return the damped step with some parameters put on their lower and upper bounds."""
    held = low | high
    if not held.any():
        return np.asarray(np.linalg.solve(damped, -gradient[:, :, None])[:, :, 0])
    put = np.where(low, to_lower, np.where(high, to_upper, 0.0))
    right = np.where(held, put, -gradient - times(damped, put))
    system = np.where(held[:, :, None] | held[:, None, :], 0.0, damped)
    diagonals(system)[held] = 1.0
    return np.asarray(np.linalg.solve(system, right[:, :, None])[:, :, 0])
