"""How far a number can be moved before the cost has risen by a given amount: the ends of profile-likelihood intervals.

The largest value of a number ``c(theta)`` on the contour where the cost reaches ``T`` is the end of its profile: there
no change of the other parameters lowers the cost (Venzon and Moolgavkar, A method for computing profile-likelihood-
based confidence intervals, 1988). With the slope ``a`` of the number, the gradient ``g = J r`` and the matrix
``A = J J^T`` of the cost, the parabola at ``theta`` has its largest ``a^T delta`` on the contour at

    delta = t A^-1 a - A^-1 g,    t^2 = 2 (T - cost + g^T A^-1 g / 2) / (a^T A^-1 a).

Bounds are an active set for ``delta``. The step is repeated until it promises no more; where it makes matters worse,
``A`` is damped as in Levenberg-Marquardt. Worse is what lowers ``c`` less twice the excess of the cost over ``T``,
expressed in units of ``c`` by the multiplier ``1 / t`` (an exact penalty). All numbers and sides go in one batch.
"""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray, IntArray
from shaftprint.identify.search._levenberg_marquardt import SMALLEST_SCALE, TINY, Residuals, diagonals, quadratic, times
from shaftprint.identify.uncertainty._numbers import Numbers

ROUNDS = 200
# Units of the number that one unit of excess cost outweighs, over those that the multiplier says.
PENALTY = 2.0
# An end is good when the next step would move it by less than this share of its distance from the estimate, ...
PRECISION = 2e-3
# A row climbs again from where its number is further by more than this share of the distance.
FURTHER = 5e-3
RESTARTS = 10
# ... and the root of the rise of the cost, in standard deviations, is right to this share.
SHARP = 5e-3
BOUND_PASSES = 24
# In the last passes one parameter changes at a time, as in the search for the optimum.
SINGLE_PASSES = 16
LEAST_DAMPING = 1e-12
FIRST_DAMPING = 1e-2
MOST_DAMPING = 1e10
# Where the cost is rough, as with dry friction, no step leads to the contour itself. From this share of the way on the
# rest is taken to be like the way so far.
NEAR = 0.8
# With more damping than this a small step says nothing.
TRUSTED_DAMPING = 1e-5
# A step that was good leaves this share of the damping.
RELIEF = 0.1


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Ends:
    """The furthest points that were found, one row a number and side."""

    theta: FloatArray
    """Free parameters, shape (rows, free)."""
    value: FloatArray
    """The number there, shape (rows,)."""
    is_open: BoolArray
    """Whether bounds of the search stopped the number before the cost had risen far enough, shape (rows,)."""
    failed: BoolArray
    """Whether the search came to no end, and no bound stands there: the data may have set one, shape (rows,)."""


def furthest(
    numbers: Numbers, start: FloatArray, side: FloatArray, distance: FloatArray, *, optima: FloatArray | None = None
) -> Ends:
    """Return where each number is furthest from its estimate while the cost rises no more than allowed.

    A row may stop at an end that is the furthest of its surroundings only. It therefore climbs from every optimum that
    the data allow. The ends of the other rows are such sets too: a row whose number lies further at one of them climbs
    again from there, until there is none.

    ``numbers``: the number of each row. ``start``: free parameters of the estimate, shape (free,). ``side``: -1 for the
    smallest, 1 for the largest value, shape (rows,). ``distance``: root of twice the rise of the cost that is allowed:
    standard deviations of a normal estimate, shape (rows,). ``optima``: free parameters of other optima of the search,
    shape (optima, free); those that cost too much are passed over.
    """
    lowest = float(quadratic(*numbers.objective.residuals(start[None, :]))[0][0])
    climb = _Climb(numbers=numbers, start=start, side=side, distance=distance, limit=lowest + 0.5 * distance**2)
    every = np.arange(side.size)
    first = climb.ends_from(every, start)
    ends = first
    for optimum in np.empty((0, start.size)) if optima is None else optima:
        rows = climb.allowing(optimum)
        if rows.size:
            ends = climb.better(ends, rows, optimum)
    ends = _climbed_further(climb, ends)
    if np.array_equal(ends.value, first.value):
        return ends
    # Where there is more than one furthest point there may be more than two: once more from afar.
    return _climbed_further(climb, climb.better(ends, every, climb.farthest_starts(ends)))


def _climbed_further(climb: "_Climb", ends: Ends) -> Ends:
    """Return the ends after climbing from those of other rows, until there is no further one."""
    for _ in range(RESTARTS):
        rows, theta = climb.further_starts(ends)
        if rows.size == 0:
            break
        ends = climb.better(ends, rows, theta)
    return ends


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Climb:
    """The task: which number each row asks for, to which side, and how far the cost may rise."""

    numbers: Numbers
    start: FloatArray
    side: FloatArray
    distance: FloatArray
    limit: FloatArray

    def ends_from(self, rows: IntArray, theta: FloatArray) -> Ends:
        """Return the ends of some of the rows, found from one parameter set or each from its own."""
        numbers = self.numbers.chosen(rows)
        lower, upper = numbers.objective.lower, numbers.objective.upper
        # states in which a record begins follow those of the row's last place
        residuals = numbers.objective.following(rows.size)
        at = _Position.at_start(self, rows, theta, residuals)
        theta = at.theta.copy()
        is_open, failed, stretch = np.zeros(rows.size, np.bool_), np.zeros(rows.size, np.bool_), np.ones(rows.size)
        for _ in range(ROUNDS):
            step = _model_step(at, lower, upper)
            stopped, lost, done = _judged(at, step)
            if lost.any():
                places = at.rows[lost]
                is_open[places], failed[places], stretch[places] = _short_of(at.chosen(lost), lower, upper)
            if done.any():
                places = at.rows[done]
                theta[places] = self._last_step(at.chosen(done), step.chosen(done))
                is_open[places] |= stopped[done]
                at, step = at.chosen(~done), step.chosen(~done)
                if at.rows.size == 0:
                    break
            trial = np.minimum(np.maximum(at.theta + step.delta, lower), upper)
            at.advance(numbers, trial, step, residuals(trial, at.rows))
        theta[at.rows] = at.theta
        is_open[at.rows], failed[at.rows], stretch[at.rows] = _short_of(at, lower, upper)
        value = numbers.values(theta)
        if np.any(stretch > 1.0):
            centre = numbers.values(np.broadcast_to(self.start, theta.shape))
            value = np.where(stretch > 1.0, centre + stretch * (value - centre), value)
        return Ends(theta=theta, value=value, is_open=is_open, failed=failed)

    def _last_step(self, at: "_Position", step: "_Step") -> FloatArray:
        """Return the ends of rows that are done: a step further, but where that leaves the contour.

        Along a valley of equal cost a step that hardly moves the number may be a long one.
        """
        objective = self.numbers.objective
        trial = np.minimum(np.maximum(at.theta + step.delta, objective.lower), objective.upper)
        residuals, _ = objective.residuals(trial)
        stays = 0.5 * np.vecdot(residuals, residuals) <= np.maximum(at.cost, at.limit) + SHARP * at.distance**2
        return np.where(stays[:, None], trial, at.theta)

    def allowing(self, theta: FloatArray) -> IntArray:
        """Return the rows whose rise of the cost allows a parameter set."""
        return np.flatnonzero(quadratic(*self.numbers.objective.residuals(theta[None, :]))[0][0] < self.limit)

    def further_starts(self, ends: Ends) -> tuple[IntArray, FloatArray]:
        """Return the rows whose number lies further at the end of another row, and the parameters there."""
        count = self.side.size
        interval, candidate = (part.ravel() for part in np.indices((count, count)))
        values = self.numbers.chosen(interval).values(ends.theta[candidate]).reshape(count, count)
        reach = np.where(self._allows(ends) & np.isfinite(values), self.side[:, None] * values, -np.inf)
        best = np.argmax(reach, axis=1)
        gain = reach[np.arange(count), best] - self.side * ends.value
        centre = self.numbers.values(np.broadcast_to(self.start, ends.theta.shape))
        rows = np.flatnonzero(gain > FURTHER * np.abs(ends.value - centre))
        return rows, ends.theta[best[rows]]

    def farthest_starts(self, ends: Ends) -> FloatArray:
        """Return for each row the end of another row that is the farthest from its own, shape (rows, free)."""
        spread = np.ptp(ends.theta, axis=0)
        scaled = ends.theta / np.where(spread > 0.0, spread, 1.0)
        apart = np.linalg.norm(scaled[:, None, :] - scaled[None, :, :], axis=2)
        return np.asarray(ends.theta[np.argmax(np.where(self._allows(ends), apart, -1.0), axis=1)])

    def better(self, ends: Ends, rows: IntArray, theta: FloatArray) -> Ends:
        """Return the ends with those of some rows that lie further when climbed to from other parameters."""
        # at the end of another row a number may be infinite, where what it divides by is 0: nothing climbs from there
        starts = np.broadcast_to(theta, (rows.size, theta.shape[-1]))
        usable = np.isfinite(self.numbers.chosen(rows).values(starts))
        if not usable.any():
            return ends
        rows = rows[usable]
        again = self.ends_from(rows, starts[usable])
        points, value = ends.theta.copy(), ends.value.copy()
        is_open, failed = ends.is_open.copy(), ends.failed.copy()
        further = self.side[rows] * (again.value - value[rows]) > 0.0
        places = rows[further]
        points[places], value[places] = again.theta[further], again.value[further]
        is_open[places], failed[places] = again.is_open[further], again.failed[further]
        return Ends(theta=points, value=value, is_open=is_open, failed=failed)

    def _allows(self, ends: Ends) -> BoolArray:
        """Return whether the rise of the cost of each row allows the end of each, shape (rows, rows)."""
        residuals, _ = self.numbers.objective.residuals(ends.theta)
        cost = 0.5 * np.vecdot(residuals, residuals)
        return np.asarray(cost[None, :] <= (self.limit + SHARP * self.distance**2)[:, None])


@dataclass(slots=True, eq=False)
class _Step:
    """What the parabola of the cost says to do next, one row each."""

    delta: FloatArray
    pull: FloatArray
    """``t``: rise of the cost for a unit of the number; 0 where only the cost is to be lowered."""
    stuck: BoolArray
    """Whether bounds hold all parameters that the number depends on."""

    def chosen(self, rows: BoolArray) -> "_Step":
        """Return some of the rows."""
        return _Step(self.delta[rows], self.pull[rows], self.stuck[rows])


@dataclass(slots=True, eq=False)
class _Position:
    """Where the rows stand that still move; ``value`` and ``slope`` are turned so that more is further."""

    rows: IntArray
    side: FloatArray
    distance: FloatArray
    limit: FloatArray
    start: FloatArray
    theta: FloatArray
    cost: FloatArray
    gradient: FloatArray
    hessian: FloatArray
    value: FloatArray
    slope: FloatArray
    damping: FloatArray
    growth: FloatArray

    @classmethod
    def at_start(cls, climb: _Climb, rows: IntArray, theta: FloatArray, residuals: Residuals) -> "_Position":
        """Return the position of some of the rows before their first step, at one parameter set or each at its own."""
        numbers, side = climb.numbers.chosen(rows), climb.side[rows]
        theta = np.array(np.broadcast_to(theta, (rows.size, theta.shape[-1])))
        cost, gradient, hessian = quadratic(*residuals(theta, np.arange(rows.size)))
        estimate = np.broadcast_to(climb.start, theta.shape)
        slope = side[:, None] * numbers.slopes(theta, diagonals(hessian))
        return cls(
            rows=np.arange(rows.size),
            side=side,
            distance=climb.distance[rows],
            limit=climb.limit[rows],
            start=side * numbers.values(estimate),
            theta=theta,
            cost=cost,
            gradient=gradient,
            hessian=hessian,
            value=side * numbers.values(theta),
            # at the end of another row a number may have no slope along one that is 0 there: it is climbed beside it
            slope=np.where(np.isfinite(slope), slope, 0.0),
            damping=np.full(rows.size, LEAST_DAMPING),
            growth=np.ones(rows.size),
        )

    @property
    def root(self) -> FloatArray:
        """Root of twice the rise of the cost, shape (rows,)."""
        return np.sqrt(np.maximum(2.0 * (self.cost - self.limit) + self.distance**2, 0.0))

    def chosen(self, rows: BoolArray) -> "_Position":
        """Return some of the rows."""
        return _Position(*(getattr(self, name)[rows] for name in self.__slots__))

    def advance(self, numbers: Numbers, trial: FloatArray, step: _Step, found: tuple[FloatArray, FloatArray]) -> None:
        """Go to the trials that lie further or nearer to the contour; damp the other rows.

        ``found``: residuals and Jacobian there.
        """
        numbers_of_rows = numbers.chosen(self.rows)
        cost, gradient, hessian = quadratic(*found)
        value = self.side * numbers_of_rows.values(trial)
        excess = np.maximum(cost, self.limit) - np.maximum(self.cost, self.limit)
        slope = self.side[:, None] * numbers_of_rows.slopes(trial, diagonals(hessian))
        finite = np.isfinite(value) & np.isfinite(slope).all(axis=1)
        moved = np.where(finite, value, self.value) - self.value
        # Where the parabola never comes down to the contour, or bounds leave the number no way, the cost decides; a
        # step that takes it to its bound inside the contour is good.
        good = np.where(step.pull > 0.0, step.pull * moved > PENALTY * excess, cost < self.cost)
        good = finite & np.where(step.stuck & (moved > 0.0), cost <= self.limit, good)
        damping = np.where(good, RELIEF * self.damping, np.maximum(self.damping, FIRST_DAMPING) * self.growth)
        self.damping = np.maximum(damping, LEAST_DAMPING)
        self.growth = np.where(good, 1.0, 2.0 * self.growth)
        if good.all():
            self.theta, self.gradient, self.slope, self.hessian = trial, gradient, slope, hessian
            self.cost, self.value = cost, value
            return
        row = good[:, None]
        self.theta, self.gradient = np.where(row, trial, self.theta), np.where(row, gradient, self.gradient)
        self.slope, self.hessian = np.where(row, slope, self.slope), np.where(row[:, :, None], hessian, self.hessian)
        self.cost, self.value = np.where(good, cost, self.cost), np.where(good, value, self.value)


def _short_of(at: _Position, lower: FloatArray, upper: FloatArray) -> tuple[BoolArray, BoolArray, FloatArray]:
    """Return of rows that go no further which are open, which failed, and how much further the contour of each is."""
    share = at.root / at.distance
    short, held = share < 1.0 - SHARP, np.any((at.theta <= lower) | (at.theta >= upper), axis=1)
    near = share >= NEAR
    return short & held, short & ~held & ~near, np.where(short & ~held & near, 1.0 / np.maximum(share, NEAR), 1.0)


def _judged(at: _Position, step: _Step) -> tuple[BoolArray, BoolArray, BoolArray]:
    """Return which rows bounds have stopped, which no step leads further, and which are done, those included."""
    gain = np.vecdot(at.slope, step.delta)
    small = np.abs(gain) <= PRECISION * np.abs(at.value + gain - at.start)
    small &= at.damping <= TRUSTED_DAMPING
    reached = small & (np.abs(at.root - at.distance) <= SHARP * at.distance)
    fall = -np.vecdot(at.gradient, step.delta)
    stopped = small & step.stuck & (fall <= SHARP * at.distance**2) & (at.cost < at.limit)
    lost = ~reached & (at.damping > MOST_DAMPING)
    return stopped, lost & ~stopped, reached | stopped | lost


def _model_step(at: _Position, lower: FloatArray, upper: FloatArray) -> _Step:
    """Return the step to the furthest point of the parabola's contour that is inside the box."""
    to_lower, to_upper = lower - at.theta, upper - at.theta
    damped = at.hessian.copy()
    diagonal = diagonals(damped)
    diagonal += at.damping[:, None] * np.maximum(diagonal, SMALLEST_SCALE)
    low = (to_lower >= 0.0) & (at.slope < 0.0)
    high = (to_upper <= 0.0) & (at.slope > 0.0)
    for turn in range(BOUND_PASSES):
        step = _step_beside(at, damped, low, high, to_lower, to_upper)
        below, above = step.delta < to_lower, step.delta > to_upper
        tilt = at.gradient + times(damped, step.delta) - step.pull[:, None] * at.slope
        # No rise of the cost buys a row more that is stuck: its parameters stay where the number wants them.
        tilt = np.where(step.stuck[:, None] & (at.slope != 0.0), -at.slope, tilt)
        back_up, back_down = low & (tilt < 0.0), high & (tilt > 0.0)
        below, above = below & ~low, above & ~high
        change = below | above | back_up | back_down
        if not change.any():
            return step
        if turn >= BOUND_PASSES - SINGLE_PASSES:
            change &= np.cumsum(change, axis=1) == 1
        low = (low & ~(back_up & change)) | (below & change)
        high = (high & ~(back_down & change)) | (above & change)
    step.delta = np.minimum(np.maximum(step.delta, to_lower), to_upper)
    return step


def _step_beside(
    at: _Position,
    damped: FloatArray,
    low: BoolArray,
    high: BoolArray,
    to_lower: FloatArray,
    to_upper: FloatArray,
) -> _Step:
    """Return the step with some parameters put on their bounds."""
    held = low | high
    slope, gradient, system, base = at.slope, at.gradient, damped, at.cost
    free_gradient = gradient
    if held.any():
        put = np.where(low, to_lower, np.where(high, to_upper, 0.0))
        moved = times(damped, put)
        base = base + np.vecdot(gradient, put) + 0.5 * np.vecdot(put, moved)
        slope = np.where(held, 0.0, slope)
        free_gradient = np.where(held, 0.0, gradient + moved)
        gradient = np.where(held, -put, free_gradient)
        system = np.where(held[:, :, None] | held[:, None, :], 0.0, damped)
        diagonals(system)[held] = 1.0
    solution = np.linalg.solve(system, np.concatenate([slope[:, :, None], gradient[:, :, None]], axis=2))
    along, down = solution[:, :, 0], solution[:, :, 1]
    reach = np.vecdot(slope, along)
    fall = np.vecdot(free_gradient, down)
    room = at.limit - base + 0.5 * fall
    stuck = reach <= TINY
    pull = np.sqrt(2.0 * np.maximum(room, 0.0) / np.where(stuck, 1.0, reach))
    pull = np.where(stuck, 0.0, pull)
    return _Step(delta=pull[:, None] * along - down, pull=pull, stuck=stuck)
