"""Whether the torque gauge and the load were the same from the first to the last minute of a test.

In bollard pull the torque is ``M = g (c n^2 + I dn/dt) + z`` with the gain ``g`` and the zero ``z`` of the gauge and
the load ``c``. The test is cut into pieces. In each, what accelerates the shaft tells ``g`` whatever the load does
(``_fast_gain.py``), and the mean over that of ``n^2`` tells ``g c``; that wanders by a per cent or three over 10 to
100 s, a stationary process of first order. A gain that changes changes both alike. A step at any time, a straight
line, and a gauge that warms up with any time constant are held against the same without: twice the gain in
log-likelihood says how much better that is.

What changes the means alone is load or zero. Their means do not belong to one state then, and what is compared across
the lines is in doubt as well. A zero makes the mean torque differ between speeds, and so does a propeller whose torque
does not quite go with the square: what goes with ``1 / n^2`` is therefore no change. The fast torque needs no such
allowance, and compares two speeds by itself.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray, IntArray
from shaftprint.reasons import Reason
from shaftprint.signals._gaps import EVERYTHING, Coverage
from shaftprint.signals.levels._fast_gain import FastGains, fast_gains
from shaftprint.signals.levels._unseen_gain import unseen_gains
from shaftprint.signals.levels._wander import window_covariance
from shaftprint.units import PERCENT

if TYPE_CHECKING:
    from shaftprint.campaign._campaign import Campaign

# Pieces in which the gain is looked at, and of how many a mean load is made: a shorter mean says no more.
_PIECE_S, _MOST_PIECES, _PIECES_A_LOAD = 10.0, 200, 2
# Correlation times of the wander that are tried [s]; what is slower is a drift.
_TIMES_S = np.geomspace(10.0, 100.0, 8)
# Time constants of a gauge that warms up [s], the longest over the length of the test: longer is a straight line.
_SHORTEST_WARM_UP_S, _LONGEST_WARM_UP, _WARM_UPS = 30.0, 0.7, 8
# What mean loads may lose by a change of the gain, twice the log-likelihood, before it is none.
_MOST_AGAINST = 16.0
# Means of the load on either side of a step, and in all.
_FEWEST_BESIDE, _FEWEST = 2, 8
# Twice the gain in log-likelihood that a test without a change exceeds once in several hundred tests, and the least
# change that is worth a word: of the gain, and of the load, of which a tenth stays in the mean torque.
_OF_GAIN, _OF_LOAD_SLOWLY, _OF_LOAD_AT_ONCE = 14.0, 14.0, 20.0
_LEAST_OF_GAIN, _LEAST_OF_LOAD = 0.025, 0.03
# Within so much of twice the best log-likelihood lies the time of a step in 95 of 100.
_AS_GOOD = 3.84
_ROUNDS = 8
# Median of the size of a normal variable of deviation 1, and the least scatter of neighbours that is taken for theirs.
_MEDIAN_OF_NORMAL, _LEAST_SCATTER = 0.6745, 0.8
# A piece whose gain is known worse than this tells nothing of the scatter.
_LARGEST_STD = 0.3

Kind: TypeAlias = Literal["step", "drift", "warm-up"]
"""Course of a change."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Loads:
    """Torque over the square of the speed, window by window in the order of time."""

    start_s: FloatArray
    """When each window begins [s], shape (windows,)."""
    stop_s: FloatArray
    """When it ends [s], shape (windows,)."""
    load: FloatArray
    """Torque over the square of the speed, over its mean [-], shape (windows,)."""
    square: FloatArray
    """Mean of the square of the speed over its mean [-], shape (windows,)."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Change:
    """A change within a test."""

    kind: Kind
    """Its course."""
    of_gain: bool
    """Whether the fast torque changes with the mean torque."""
    likelihood: float
    """Twice the gain in log-likelihood over no change."""
    size: float
    """Relative change from the begin to the end [-]."""
    time_s: float
    """When it steps, or the time constant of a warm-up [s]; 0 for a drift."""
    between_s: tuple[float, float]
    """Where the time of a step lies in 95 of 100 [s]."""
    against: float
    """Twice the log-likelihood that the mean loads alone would lose by it; below 0 where they gain."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Courses:
    """Courses that are tried; each is 0 at the begin, and 1 at the end or far behind it."""

    kinds: tuple[Kind, ...]
    """What each is, steps last, shape (courses,)."""
    time_s: FloatArray
    """When each steps, or its time constant [s], shape (courses,)."""

    def means(self, start_s: FloatArray, stop_s: FloatArray, within_s: tuple[float, float]) -> FloatArray:
        """Return the mean of each course in windows of the test, shape (windows, courses)."""
        # a leg whose file says that it settled before it began is taken from its beginning
        begin, end = (np.maximum(of[:, np.newaxis] - within_s[0], 0.0) for of in (start_s, stop_s))
        time_s = np.maximum(self.time_s, 1e-9)
        step = np.clip((end + within_s[0] - self.time_s) / (end - begin), 0.0, 1.0)
        drift = 0.5 * (begin + end) / (within_s[1] - within_s[0])
        warm = 1.0 - time_s * (np.exp(-begin / time_s) - np.exp(-end / time_s)) / (end - begin)
        kinds = np.array(self.kinds)
        return np.where(kinds == "step", step, np.where(kinds == "drift", drift, warm))


def expect_steady_gauge(
    campaign: "Campaign",
    *,
    set_point: FloatArray,
    speed_rev_s: FloatArray,
    torque_nm: FloatArray,
    rate_hz: float,
    start_s: float,
    channel: str,
    coverage: Coverage = EVERYTHING,
) -> tuple[tuple[Reason, ...], dict[str, float]]:
    """Return a reason where the gain of the gauge, its zero or the load changes, and what of a gain may be unseen.

    The latter is by how much the gain of each leg may be off that of all, for one standard deviation, by name of leg.

    ``campaign``: what was asked of the ship, in sines, legs or anything else; its first test begins what is looked at.
    ``set_point``, ``speed_rev_s``, ``torque_nm``: signals on the grid, shape (samples,); the set point in any unit.
    ``rate_hz``, ``start_s``: the grid. ``channel``: name of the torque channel. ``coverage``: what the recording
    covers; pieces in a gap are left out.
    """
    tests = campaign.excitations
    if not tests:
        return (), {}
    change, unseen = change_within(
        set_point,
        speed_rev_s,
        torque_nm,
        within_s=(
            max(min(test.start_s for test in tests), start_s),
            min(max(test.stop_s for test in tests), start_s + torque_nm.size / rate_hz),
        ),
        rate_hz=rate_hz,
        start_s=start_s,
        coverage=coverage,
        spans_s=[(leg.settled_s, leg.stop_s) for leg in campaign.legs],
    )
    names = (leg.name for leg in campaign.legs)
    return () if change is None else (_reason(change, channel),), dict(zip(names, unseen, strict=False))


def change_within(
    set_point: FloatArray,
    speed_rev_s: FloatArray,
    torque_nm: FloatArray,
    *,
    within_s: tuple[float, float],
    rate_hz: float,
    start_s: float = 0.0,
    coverage: Coverage = EVERYTHING,
    spans_s: Sequence[tuple[float, float]] = (),
) -> tuple[Change | None, list[float]]:
    """Return the change that explains the torque best, None where there is none, and what may be unseen.

    ``set_point``, ``speed_rev_s``, ``torque_nm``: signals on the grid, shape (samples,). ``within_s``: begin and end of
    what is looked at [s]. ``rate_hz``, ``start_s``: the grid. ``coverage``: what the recording covers. ``spans_s``:
    begin and end of each leg [s], whose gain may differ from that of the others without being seen
    (``_unseen_gain.py``).
    """
    begin_s, end_s = within_s
    count = min(int((end_s - begin_s) / _PIECE_S), _MOST_PIECES) // _PIECES_A_LOAD * _PIECES_A_LOAD
    if count < _FEWEST * _PIECES_A_LOAD:
        return None, []
    border_s = np.linspace(begin_s, end_s, count + 1)
    grid = {"rate_hz": rate_hz, "start_s": start_s}
    fast = fast_gains(set_point, speed_rev_s, torque_nm, **grid, border_s=border_s, whole=_whole(border_s, coverage))
    wide_s = border_s[::_PIECES_A_LOAD]
    whole = _whole(wide_s, coverage)
    loads = loads_of(
        wide_s[:-1][whole],
        wide_s[1:][whole],
        speed_rev_s=speed_rev_s,
        torque_nm=torque_nm,
        inertia_s=fast.inertia_s,
        **grid,
    )
    if loads.load.size < _FEWEST:
        return None, []
    courses = _courses(border_s)
    along, power = fast.of_courses(courses.means(fast.start_s, fast.stop_s, within_s))
    by_fast = along / _scatter(fast) ** 2, power / _scatter(fast) ** 2
    nothing = np.zeros(courses.time_s.size), np.zeros(courses.time_s.size)
    by_load = _by_load(loads, courses.means(loads.start_s, loads.stop_s, within_s))
    gains, loads_alone = _tried(by_load, by_fast), _tried(by_load, nothing)
    change = _change(_best(courses, by_load, gains, within_s), _best(courses, by_load, loads_alone, within_s))
    begins, ends = (np.array([span[side] for span in spans_s]) for side in (0, 1))
    means = courses.means(begins, ends, within_s) if spans_s else np.empty((0, courses.time_s.size))
    return change, unseen_gains(means, courses.kinds, size=gains.size, power=gains.power, twice=gains.twice).tolist()


def _change(of_gain: Change, of_load: Change) -> Change | None:
    """Return what has changed, gain or load; None where neither has."""
    if of_gain.likelihood >= of_load.likelihood:
        # a torque that comes late, now more and now less, loses fast motion and keeps its means
        is_change = (
            of_gain.likelihood > _OF_GAIN and abs(of_gain.size) > _LEAST_OF_GAIN and of_gain.against < _MOST_AGAINST
        )
        return replace(of_gain, of_gain=True) if is_change else None
    least = _OF_LOAD_AT_ONCE if of_load.kind == "step" else _OF_LOAD_SLOWLY
    return of_load if of_load.likelihood > least and abs(of_load.size) > _LEAST_OF_LOAD else None


def _whole(border_s: FloatArray, coverage: Coverage) -> BoolArray:
    """Return which pieces hold no gap, shape (pieces,)."""
    pieces = zip(border_s[:-1].tolist(), border_s[1:].tolist(), strict=True)
    return np.array([not coverage.missing(*piece) for piece in pieces], dtype=np.bool_)


def loads_of(
    begin_s: FloatArray,
    end_s: FloatArray,
    *,
    speed_rev_s: FloatArray,
    torque_nm: FloatArray,
    inertia_s: float,
    rate_hz: float,
    start_s: float,
) -> Loads:
    """Return the load in windows.

    ``begin_s``, ``end_s``: when they begin and end [s], shape (windows,). ``speed_rev_s``, ``torque_nm``: signals on
    the grid, shape (samples,). ``inertia_s``: inertia behind the gauge, a time, at the mean speed and torque: what
    accelerates it is no load. ``rate_hz``, ``start_s``: the grid.
    """
    first, stop = (np.round((of - start_s) * rate_hz).astype(int) for of in (begin_s, end_s))
    length = np.maximum(stop - first, 1)
    mean = _sums(torque_nm / torque_nm.mean(), first, stop) / length
    speed = speed_rev_s / speed_rev_s.mean()
    square = _sums(speed**2, first, stop) / length
    at_first, at_stop = (
        0.5 * (speed[np.minimum(place, speed.size - 1)] + speed[np.maximum(place - 1, 0)]) for place in (first, stop)
    )
    load = (mean - inertia_s * (at_stop - at_first) * rate_hz / length) / square
    return Loads(start_s=begin_s, stop_s=end_s, load=load / load.mean(), square=square / square.mean())


def _sums(values: FloatArray, first: IntArray, stop: IntArray) -> FloatArray:
    """Return the sums of values from some places to others, shape (places,); the values are used up."""
    total = np.cumsum(values, out=values)
    before, last = (np.where(place > 0, total[place - 1], 0.0) for place in (first, stop))
    return np.asarray(last - before)


def _courses(border_s: FloatArray) -> _Courses:
    """Return the courses that are tried in a test cut into pieces: steps at every half of one."""
    length_s, half_s = border_s[-1] - border_s[0], 0.5 * (border_s[1] - border_s[0])
    beside = _FEWEST_BESIDE * _PIECES_A_LOAD
    steps_s = np.arange(border_s[beside], border_s[-1 - beside] + 1e-6, half_s)
    warm_ups_s = np.geomspace(_SHORTEST_WARM_UP_S, max(_LONGEST_WARM_UP * length_s, _SHORTEST_WARM_UP_S), _WARM_UPS)
    kinds: list[Kind] = ["drift"]
    kinds += ["warm-up"] * _WARM_UPS
    kinds += ["step"] * steps_s.size
    return _Courses(kinds=tuple(kinds), time_s=np.concatenate([[0.0], warm_ups_s, steps_s]))


def _scatter(fast: FastGains) -> float:
    """Return by how much neighbours differ over what their deviations let expect.

    The median does not see the one pair between which a gain steps.
    """
    told = fast.std < _LARGEST_STD
    if np.count_nonzero(told) < _FEWEST:
        return 1.0
    apart = np.abs(np.diff(fast.gain[told])) / np.hypot(fast.std[told][1:], fast.std[told][:-1])
    return max(_LEAST_SCATTER, float(np.median(apart)) / _MEDIAN_OF_NORMAL)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _ByLoad:
    """What the mean loads say of the size of each course, for each correlation time of their wander."""

    count: int
    """Number of windows."""
    log: FloatArray
    """Logarithm of what the white residual is divided by, shape (times, 1)."""
    square: FloatArray
    """Sum of its squares without a change, shape (times, 1)."""
    along: FloatArray
    """Sum of its products with each course, shape (times, courses)."""
    power: FloatArray
    """Sum of the squares of each course, shape (times, courses)."""

    def likelihood(self, size: FloatArray | float) -> FloatArray:
        """Return the log-likelihood of sizes, shape (times, courses)."""
        return np.asarray(self.log - 0.5 * self.count * np.log(self.left(size)))

    def left(self, size: FloatArray | float) -> FloatArray:
        """Return the sum of squares that sizes leave, shape (times, courses)."""
        least = np.finfo(np.float64).tiny
        return np.asarray(np.maximum(self.square - 2.0 * size * self.along + size**2 * self.power, least))


def _by_load(loads: Loads, courses: FloatArray) -> _ByLoad:
    common = np.stack([np.ones(loads.load.size), 1.0 / loads.square - 1.0], axis=1)
    rows = []
    for time_s in _TIMES_S.tolist():
        lower = np.linalg.cholesky(window_covariance(loads.start_s, loads.stop_s, time_s))
        white = np.linalg.solve(lower, np.column_stack([common, loads.load, courses]))
        basis = np.linalg.qr(white[:, :2]).Q
        rest = white[:, 2:] - basis @ (basis.T @ white[:, 2:])
        load, changed = rest[:, 0], rest[:, 1:]
        rows.append((-np.log(np.diag(lower)).sum(), load @ load, changed.T @ load, np.sum(changed**2, axis=0)))
    log, square, along, power = (np.array(of) for of in zip(*rows, strict=True))
    return _ByLoad(
        count=loads.load.size, log=log[:, np.newaxis], square=square[:, np.newaxis], along=along, power=power
    )


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Tried:
    """Each course with the size and the wander that explain mean loads and fast gains best."""

    size: FloatArray
    """Its size [-], shape (courses,)."""
    power: FloatArray
    """One over its variance, shape (courses,)."""
    twice: FloatArray
    """Twice the gain in log-likelihood over no change, shape (courses,)."""


def _tried(by_load: _ByLoad, by_fast: tuple[FloatArray, FloatArray]) -> _Tried:
    """Return how well each course explains mean loads and fast gains."""
    along, power = by_fast
    size, least = np.zeros_like(by_load.along), np.finfo(np.float64).tiny
    for _ in range(_ROUNDS):
        weight = by_load.count / by_load.left(size)
        size = (along + weight * by_load.along) / np.maximum(power + weight * by_load.power, least)
    by_time = by_load.likelihood(size) + size * along - 0.5 * size**2 * power
    best = np.argmax(by_time, axis=0), np.arange(by_time.shape[1])
    return _Tried(
        size=size[best],
        power=(power + by_load.count / by_load.left(size) * by_load.power)[best],
        twice=2.0 * (by_time[best] - by_load.likelihood(0.0).max()),
    )


def _best(courses: _Courses, by_load: _ByLoad, tried: _Tried, within_s: tuple[float, float]) -> Change:
    """Return the course and size that explain mean loads and fast gains best."""
    best = tried.twice
    place = int(np.argmax(best))
    kind, of_steps = courses.kinds[place], courses.time_s[np.array(courses.kinds) == "step"]
    # steps are tried at halves of a piece
    half_s = float(np.min(np.diff(of_steps), initial=0.5 * _PIECE_S))
    alike = of_steps[best[-of_steps.size :] > best[place] - _AS_GOOD] if kind == "step" else np.zeros(1)
    end = float(courses.means(np.array([within_s[1] - 1e-3]), np.array([within_s[1]]), within_s)[0, place])
    return Change(
        kind=kind,
        of_gain=False,
        likelihood=float(best[place]),
        size=float(tried.size[place]) * end,
        time_s=float(courses.time_s[place]),
        between_s=(float(alike.min()) - half_s, float(alike.max()) + half_s),
        against=2.0 * float(by_load.likelihood(0.0).max() - by_load.likelihood(tried.size)[:, place].max()),
    )


def _reason(change: Change, channel: str) -> Reason:
    percent = PERCENT * change.size
    if not change.of_gain:
        how = f"jumps at about {change.time_s:.0f} s" if change.kind == "step" else "drifts"
        sentence = (
            f"The torque over the square of the speed {how} by {percent:+.1f} %, more than a load wanders: zero of the "
            f"torque gauge in channel {channel} changed within the test, or the ship did; check the telemetry, or use "
            "a part of the test."
        )
        return Reason(kind="gauge steadiness", where=channel, sentence=sentence)
    first_s, last_s = change.between_s
    course = {
        "step": f"is {abs(percent):.1f} % {'higher' if percent > 0.0 else 'lower'} from {change.time_s:.0f} s on "
        f"(between {first_s:.0f} and {last_s:.0f} s)",
        "drift": f"drifts by {percent:+.1f} % from the first test to the last",
        "warm-up": f"changes by {percent:+.1f} % as it warms up, with a time constant of about {change.time_s:.0f} s",
    }[change.kind]
    instead = "before or after it" if change.kind == "step" else "in which it stands"
    return Reason(
        kind="gauge steadiness",
        where=channel,
        sentence=(
            f"The gain of the torque gauge in channel {channel} {course}, by the torque that accelerates the shaft as "
            "well, which no load changes; check gauge and telemetry, and whether the gauge is linear, and identify "
            f"the tests {instead} alone, with a campaign file that names no others."
        ),
    )
