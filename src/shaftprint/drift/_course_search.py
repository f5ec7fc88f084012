"""The courses that a history is searched for, their likelihood, and how often an unchanged ship shows as much.

Courses are not alike beforehand. Injection wears, propellers foul, and both go one way from the first test on; that one
of nine causes steps at one of twenty tests up or down is one of hundreds of ways. So the *evidence* of a course is
``z^2``, twice what the logarithm of the likelihood gains by it, and twice the logarithm of ``WEAR_ODDS`` more for wear:
a generalised likelihood ratio with weights, whose false alarms are drawn as they are (C. R. Genovese, K. Roeder,
L. Wasserman, "False discovery control with p-value weighting", Biometrika 93, 2006, on why weights cost little where
they are wrong and gain much where they are right). Draws end where the rest can no longer make a course unlikely
(J. Besag, P. Clifford, "Sequential Monte Carlo p-values", Biometrika 78, 1991): an unchanged ship takes few of them.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from shaftprint.arrays import FloatArray, IntArray
from shaftprint.distributions import normal_cdf
from shaftprint.drift._along import whitened
from shaftprint.drift._differ import UNLIKELY
from shaftprint.drift._drift_finding import DatedCause, Drift, Shape
from shaftprint.drift._finding import odds_against
from shaftprint.drift._series import Series

FEWEST_TESTS = 2
WEAR_ODDS: Final = 50.0
"""How much more likely beforehand wear since the first test is than any one other course."""
_BONUS = 2.0 * math.log(WEAR_ODDS)
# What is left of a column that lies in others is rounding.
_ROUNDING = 1e-6
# Histories that are drawn at once.
_PIECE = 250
# Evidence that differs by less is the same.
_DIGITS = 9


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class CourseSearch:
    """All courses that are looked for, in coordinates in which the noise is white."""

    series: Series
    """The numbers of all tests."""
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
    wear: FloatArray
    """Sign of a course that is wear, 0 of others; shape (courses,)."""

    @classmethod
    def of(cls, series: Series, tests: int) -> "CourseSearch":
        """Return the search in a series of which a number of tests was made.

        Raises numpy.linalg.LinAlgError if the covariance is not positive definite.
        """
        every, causes = series.time_a.size, len(series.causes)
        # steps first: between two tests a ramp is none other
        shapes: tuple[Shape, ...] = ("step", "ramp")
        courses = [(cause, shape, at) for shape in shapes for cause in range(causes) for at in range(every)]
        # a course is the sum of what its cause did to each test
        each = np.kron(np.eye(every), series.directions)
        white = whitened(series.values.reshape(-1), series.covariance, np.column_stack([series.baseline, each]))
        free = series.baseline.shape[1]
        of_each = white.directions[:, free:].reshape(-1, every, causes).transpose(0, 2, 1)
        columns = np.empty((len(of_each), len(shapes), causes, every))
        for place, shape in enumerate(shapes):
            growths = np.column_stack([growth_of(shape, at, series.time_a) for at in range(every)])
            np.matmul(of_each, growths, out=columns[:, place])
        wear = [series.causes[cause].wears * (shape == "ramp" and at == 0) for cause, shape, at in courses]
        return cls(
            series=series,
            tests=tests,
            values=white.difference,
            free=white.directions[:, :free],
            columns=columns.reshape(len(columns), -1),
            courses=tuple(courses),
            wear=np.array(wear, dtype=np.float64),
        )

    def beside(self, course: DatedCause) -> "CourseSearch":
        """Return the search for a further change beside one that was found."""
        found = self.columns[:, self._place(course)]
        return replace(self, free=np.column_stack([self.free, found]))

    def effect(self, course: DatedCause) -> FloatArray:
        """Return what a course has done to the numbers of each test, shape (tests, numbers)."""
        at = self._place(course)
        directions, length = self._directions(self.tests)
        size = float(directions[:, at] @ self.values[: len(directions)]) / length[at]
        cause, shape, since = self.courses[at]
        time_a = self.series.time_a[: self.tests]
        growth = growth_of(shape, since, time_a)
        moved: FloatArray = size * np.outer(growth, self.series.directions[:, cause])
        return moved

    def _place(self, course: DatedCause) -> int:
        return self.courses.index((self.series.causes.index(course.cause), course.shape, course.since))

    def likeliest(self) -> tuple[DatedCause, ...]:
        """Return the best course of each cause, the most likely cause first; none where no course can be told.

        What counts beforehand counts between causes. Of one cause the course that explains the tests best stands for
        it: whether it is wear or a step is seen in them.
        """
        directions, length = self._directions(self.tests)
        scores = directions.T @ self.values[: len(directions)]
        evidence = np.round(np.where(length > 0.0, _evidence(scores, self.wear), 0.0), _DIGITS)
        of_cause = np.array([cause for cause, _shape, _at in self.courses])
        found = []
        for cause in range(len(self.series.causes)):
            places = np.flatnonzero((of_cause == cause) & (length > 0.0))
            if places.size:
                best = places[np.argmax(np.round(np.abs(scores[places]), _DIGITS))]
                found.append((float(evidence[places].max()), int(best)))
        found.sort(key=lambda one: -one[0])
        top = math.sqrt(found[0][0]) if found else 0.0
        return tuple(
            self._course(at, float(scores[at]), float(length[at]), odds_against(math.sqrt(one), top))
            for one, at in found
        )

    def _course(self, at: int, score: float, length: float, odds: float) -> DatedCause:
        number, shape, since = self.courses[at]
        cause = self.series.causes[number]
        # a course whose length is short is known badly
        size, std = cause.stated(score / length, 1.0 / length)
        return DatedCause(cause=cause, shape=shape, since=since, size=size, std=std, score=score, odds=odds)

    def nearest(self, noise: FloatArray) -> Drift | None:
        """Return the clearest further change with its probability; None where no course can be told."""
        courses = self.likeliest()
        return Drift(courses=courses, p_value=self._p_value(noise)) if courses else None

    def _directions(self, tests: int) -> tuple[FloatArray, FloatArray]:
        """Return the unit vector of each course in the first tests beside what is free, and its length before that."""
        rows = tests * len(self.series.names)
        basis = _basis(self.free[:rows])
        columns = self.columns[:rows]
        left = columns - basis @ (basis.T @ columns)
        length = np.linalg.norm(left, axis=0)
        # beside the whole course: of one that begins later there is rounding alone
        length = np.where(length > _ROUNDING * np.linalg.norm(self.columns, axis=0), length, 0.0)
        left /= np.where(length > 0.0, length, np.inf)
        return left, length

    def _top(self) -> float:
        """Return the largest evidence of any course."""
        directions, length = self._directions(self.tests)
        return float(_evidence(directions.T @ self.values[: len(directions)], self.wear)[length > 0.0].max())

    def _p_value(self, noise: FloatArray) -> float:
        """Return the probability that an unchanged ship shows as much evidence in any test up to the horizon."""
        top = self._top()
        beyond = float(normal_cdf(-math.sqrt(top)))
        beyond_as_wear = float(normal_cdf(-math.sqrt(max(top - _BONUS, 0.0))))
        looks = list(self._looks())
        bound = 0.0
        for look in looks[FEWEST_TESTS - 1 :]:
            wear = self.wear[look.told]
            bound += 2.0 * wear.size * beyond + np.count_nonzero(wear) * (beyond_as_wear - beyond)
        if bound < 1.0 / (1.0 + noise.shape[1]):
            # what is too rare to be drawn is bounded by the sum over all looks
            return float(bound)
        drawn = reached = 0
        # in pieces that stay in the cache of a processor
        for piece in np.split(noise, range(_PIECE, noise.shape[1], _PIECE), axis=1):
            drawn += piece.shape[1]
            reached += int(np.count_nonzero(self._largest_of(looks, piece) >= top))
            if 1.0 + reached > UNLIKELY * (1.0 + noise.shape[1]):
                # whatever the others show, it is not unlikely any more
                break
        return float(min((1.0 + reached) / (1.0 + drawn), bound))

    def _looks(self) -> Iterator["_Look"]:
        """Yield what the first test tells, the first two, and so on; each goes on from the one before.

        An orthonormal basis of what is free is kept for the tests so far, and turned by each further one.
        """
        size = len(self.series.names)
        free, along = np.zeros((0, self.free.shape[1])), np.zeros((0, self.columns.shape[1]))
        squares, whole = np.zeros(self.columns.shape[1]), np.linalg.norm(self.columns, axis=0)
        for first in range(0, len(self.columns), size):
            rows = slice(first, first + size)
            stacked = np.vstack([free, self.free[rows]])
            turn = _basis(stacked)
            free, along = turn.T @ stacked, turn.T @ np.vstack([along, self.columns[rows]])
            squares = squares + (self.columns[rows] ** 2).sum(axis=0)
            length = np.sqrt(np.maximum(squares - (along**2).sum(axis=0), 0.0))
            told = np.flatnonzero(length > _ROUNDING * whole)
            yield _Look(rows=rows, turn=turn, told=told, along=along[:, told] / length[told], length=length[told])

    def _largest_of(self, looks: Sequence["_Look"], noise: FloatArray) -> FloatArray:
        """Return the largest evidence of each drawn history of an unchanged ship in any look, shape (draws,)."""
        largest = np.zeros(noise.shape[1])
        inner, free = np.zeros((self.columns.shape[1], noise.shape[1])), np.zeros((0, noise.shape[1]))
        for tests, look in enumerate(looks, start=1):
            inner += self.columns[look.rows].T @ noise[look.rows]
            free = look.turn.T @ np.vstack([free, noise[look.rows]])
            if tests < FEWEST_TESTS:
                continue
            scores = inner[look.told] / look.length[:, None] - look.along.T @ free
            wear = self.wear[look.told]
            extreme = np.maximum(scores.max(axis=0, initial=0.0), -scores.min(axis=0, initial=0.0))
            largest = np.maximum(largest, extreme**2)
            largest = np.maximum(largest, _evidence(scores[wear != 0.0], wear[wear != 0.0]).max(axis=0, initial=0.0))
        return largest


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Look:
    """What the tests up to one tell of the courses."""

    rows: slice
    """Rows of the last of these tests."""
    turn: FloatArray
    """From the basis of the tests before, with the rows of this one, to that of all of them."""
    told: IntArray
    """Courses that can be told."""
    along: FloatArray
    """How far the unit vector of each of them lies along the basis, shape (basis, told)."""
    length: FloatArray
    """Length of each of them beside what is free, shape (told,)."""


def growth_of(shape: Shape, since: int, time_a: FloatArray) -> FloatArray:
    """Return how far a course of size 1 has come at each test, shape (tests,).

    ``shape``, ``since``: the course. ``time_a``: when each test was made [years].
    """
    if shape == "step":
        return (np.arange(time_a.size) >= since).astype(np.float64)
    growth: FloatArray = np.maximum(time_a - time_a[since], 0.0)
    return growth


def _evidence(scores: FloatArray, wear: FloatArray) -> FloatArray:
    """Return the evidence of courses from their scores, shape (courses, ...), and which way each wears."""
    which_way = wear.reshape(-1, *[1] * (scores.ndim - 1))
    evidence: FloatArray = scores**2 + _BONUS * (scores * which_way > 0.0)
    return evidence


def _basis(columns: FloatArray) -> FloatArray:
    """Return an orthonormal basis of columns, some of which may lie in the others; shape (rows, rank)."""
    left, size, _ = np.linalg.svd(columns / np.maximum(np.linalg.norm(columns, axis=0), 1e-300), full_matrices=False)
    basis: FloatArray = left[:, size > _ROUNDING]
    return basis
