"""Whether a ship drifts: steps and ramps along causes in all tests of a line, with false alarms counted over years.

A step is a change that stays, a ramp one that grows. For every cause, every test at which it may have begun and both
shapes the size follows by generalised least squares, with the level of each number free, and another level free after
what was done to the ship (a generalised likelihood ratio; cumulative sums come four tests later, measured in
``benchmarks/histories.py``).

Who looks after each test looks often: a score counts where an unchanged ship reaches it in fewer than one of twenty
cases *in all tests up to a horizon*, so that five years of quarterly tests give one false alarm in twenty ships, not in
twenty tests. That probability is drawn, with the covariance that the tests state.
"""

import itertools
from dataclasses import dataclass, replace
from datetime import timedelta
from typing import Literal, TypeAlias

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.distributions import normal_cdf
from shaftprint.drift._along import whitened
from shaftprint.drift._causes import Cause
from shaftprint.drift._differ import LOAD_REPEATABILITY, MOST_CHANGES, NOT_DETERMINED, NOT_TOLD, UNLIKELY
from shaftprint.drift._finding import SizedCause, odds_against
from shaftprint.drift._history import SECONDS_PER_YEAR, History
from shaftprint.drift._series import Series, series_of

Shape: TypeAlias = Literal["step", "ramp"]

FEWEST_TESTS = 2
HORIZON = 20
"""Tests over which false alarms are counted: five years of quarterly tests."""
DRAWS = 2000
QUARTER_A = 0.25
# What is left of a column that lies in others is rounding.
_ROUNDING = 1e-6
# Scores that differ by less are the same.
_DIGITS = 9


@dataclass(frozen=True, kw_only=True, slots=True)
class DatedCause(SizedCause):
    """A cause, when it began to act and how: the size of a ramp is that in a year."""

    shape: Shape
    """Whether it changed once or goes on."""
    since: int
    """Place of the first test with the changed ship (step), or of the last one before it began (ramp)."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Drift:
    """One change of a ship in its history, with the best course of each cause."""

    courses: tuple[DatedCause, ...]
    """The best course of each cause, the most likely first."""
    p_value: float
    """Probability that an unchanged ship reaches such a score in any test up to the horizon."""

    @property
    def best(self) -> DatedCause:
        """The most likely course."""
        return self.courses[0]


@dataclass(frozen=True, kw_only=True, slots=True)
class WatchFinding:
    """What the history of a line says."""

    drifts: tuple[Drift, ...]
    """Changes beyond chance, the clearest first; empty where none is seen."""
    nearest: Drift | None
    """What comes next, within chance."""
    names: tuple[str, ...]
    """Numbers that were judged together."""
    left_out: dict[str, str]
    """Why others were not, by name."""
    not_judged: tuple[Cause, ...] = ()
    """Causes of numbers that were left out: they are not excluded."""
    because: str = ""
    """Why nothing could be judged; empty where something was."""


def watch(
    history: History,
    *,
    rng: np.random.Generator,
    load_repeatability: float = LOAD_REPEATABILITY,
    horizon: int = HORIZON,
    draws: int = DRAWS,
) -> WatchFinding:
    """Return whether a ship has changed in its history, when that began, by how much, and what may have changed.

    Parameters
    ----------
    history
        The tests of one line, and what was done to the ship.
    rng
        Draws the histories of an unchanged ship.
    load_repeatability
        Standard deviation of the torque that a propeller takes at one speed from day to day, as a share.
    horizon
        Number of tests over which false alarms are counted; that of the history where it has more.
    draws
        Number of drawn histories.
    """
    count = len(history.tests)
    if count < FEWEST_TESTS:
        return _nothing(f"expected {FEWEST_TESTS} tests that can be judged or more, found {count}", {})
    series = series_of(_extended(history, horizon), made=count, load_repeatability=load_repeatability)
    if not series.causes:
        return _nothing(NOT_TOLD, series.left_out)
    try:
        search = _Search.of(series, count)
    except np.linalg.LinAlgError:
        return _nothing(NOT_DETERMINED, series.left_out)
    noise = rng.standard_normal((series.values.size, draws))
    drifts: list[Drift] = []
    nearest = search.nearest(noise)
    while nearest is not None and nearest.p_value <= UNLIKELY and len(drifts) < MOST_CHANGES:
        drifts.append(nearest)
        search = search.beside(nearest.best)
        nearest = search.nearest(noise)
    return WatchFinding(
        drifts=tuple(drifts),
        nearest=nearest,
        names=series.names,
        left_out=series.left_out,
        not_judged=series.not_judged,
    )


def _nothing(because: str, left_out: dict[str, str]) -> WatchFinding:
    return WatchFinding(drifts=(), nearest=None, names=(), left_out=left_out, because=because)


def _extended(history: History, horizon: int) -> History:
    """Return a history that goes on with tests like its last one, for the tests that are still to come."""
    tests = list(history.tests)
    times = [test.at for test in tests]
    apart = float(np.median([(b - a).total_seconds() for a, b in itertools.pairwise(times)]))
    apart = apart or QUARTER_A * SECONDS_PER_YEAR
    while len(tests) < horizon:
        tests.append(replace(tests[-1], at=tests[-1].at + timedelta(seconds=apart)))
    return replace(history, tests=tuple(tests))


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Search:
    """All courses that are looked for, in coordinates in which the noise is white."""

    series: Series
    tests: int
    """Number of tests that were made; those behind are to come."""
    values: FloatArray
    """Shape (rows,): numbers of all tests."""
    free: FloatArray
    """Columns that are free, shape (rows, columns)."""
    columns: FloatArray
    """A course of size 1 each, shape (rows, courses)."""
    courses: tuple[tuple[int, Shape, int], ...]
    """Cause, shape and test of each course."""

    @classmethod
    def of(cls, series: Series, tests: int) -> "_Search":
        courses: list[tuple[int, Shape, int]] = []
        columns: list[FloatArray] = []
        steps = [(np.arange(series.time_a.size) >= at).astype(np.float64) for at in range(series.time_a.size)]
        ramps = [np.maximum(series.time_a - begun, 0.0) for begun in series.time_a]
        # steps first: between two tests a ramp is none other
        shapes: tuple[tuple[Shape, list[FloatArray]], ...] = (("step", steps), ("ramp", ramps))
        for shape, growths in shapes:
            for cause, direction in enumerate(series.directions.T):
                courses += [(cause, shape, at) for at in range(len(growths))]
                columns += [np.kron(growth, direction) for growth in growths]
        stacked = np.column_stack([series.baseline, np.array(columns).T])
        white = whitened(series.values.reshape(-1), series.covariance, stacked)
        free = series.baseline.shape[1]
        return cls(
            series=series,
            tests=tests,
            values=white.difference,
            free=white.directions[:, :free],
            columns=white.directions[:, free:],
            courses=tuple(courses),
        )

    def beside(self, course: DatedCause) -> "_Search":
        """Return the search for a further change beside one that was found."""
        found = self.courses.index((self.series.causes.index(course.cause), course.shape, course.since))
        return replace(self, free=np.column_stack([self.free, self.columns[:, found]]))

    def nearest(self, noise: FloatArray) -> Drift | None:
        """Return the clearest further change with its probability; None where no course can be told."""
        directions, length = self._directions(self.tests)
        rows = len(directions)
        scores = directions.T @ self.values[:rows]
        if not np.any(length > 0.0):
            return None
        # sizes: a course whose length is short is known badly
        with np.errstate(divide="ignore", invalid="ignore"):
            sizes = np.where(length > 0.0, scores / length, 0.0)
            stds = np.where(length > 0.0, 1.0 / length, np.inf)
        best: dict[int, int] = {}
        for at in np.argsort(-np.round(np.abs(scores), _DIGITS), kind="stable").tolist():
            if length[at] > 0.0:
                best.setdefault(self.courses[at][0], at)
        top = float(np.abs(scores).max())
        courses = tuple(self._course(at, float(sizes[at]), float(stds[at]), scores, top) for at in best.values())
        return Drift(courses=courses, p_value=self._p_value(top, noise))

    def _course(self, at: int, size: float, std: float, scores: FloatArray, top: float) -> DatedCause:
        number, shape, since = self.courses[at]
        cause, score = self.series.causes[number], float(scores[at])
        size, std = cause.stated(size, std)
        return DatedCause(
            cause=cause, shape=shape, since=since, size=size, std=std, score=score, odds=odds_against(score, top)
        )

    def _directions(self, tests: int) -> tuple[FloatArray, FloatArray]:
        """Return the unit vector of each course in the first tests beside what is free, and its length before that."""
        rows = tests * len(self.series.names)
        basis = _basis(self.free[:rows])
        columns = self.columns[:rows]
        left = columns - basis @ (basis.T @ columns)
        length = np.linalg.norm(left, axis=0)
        length = np.where(length > _ROUNDING * np.linalg.norm(columns, axis=0), length, 0.0)
        return np.where(length > 0.0, left / np.where(length > 0.0, length, 1.0), 0.0), length

    def _p_value(self, top: float, noise: FloatArray) -> float:
        largest = np.zeros(noise.shape[1])
        looks = 0
        for tests in range(FEWEST_TESTS, self.series.time_a.size + 1):
            directions, length = self._directions(tests)
            looks += int(np.count_nonzero(length))
            largest = np.maximum(largest, np.abs(directions.T @ noise[: len(directions)]).max(axis=0))
        drawn = (1.0 + np.count_nonzero(largest >= top)) / (1.0 + largest.size)
        # what is too rare to be drawn is bounded by the sum over all looks
        return min(drawn, looks * 2.0 * float(normal_cdf(-top)))


def _basis(columns: FloatArray) -> FloatArray:
    """Return an orthonormal basis of columns, some of which may lie in the others; shape (rows, rank)."""
    left, size, _ = np.linalg.svd(columns / np.maximum(np.linalg.norm(columns, axis=0), 1e-300), full_matrices=False)
    basis: FloatArray = left[:, size > _ROUNDING]
    return basis
