"""All tests of a history as one vector of numbers with its covariance: what ``watch`` looks for changes in."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray
from shaftprint.catalogue._roles import ShipRole
from shaftprint.drift._causes import GAUGE_SCALE
from shaftprint.drift._dated import EVENTS, PROGRAM_CHANGED, Event
from shaftprint.drift._doubts import judged_in
from shaftprint.drift._history import SECONDS_PER_YEAR, History
from shaftprint.drift._pair import Judged, directions_of, not_judged, weighing
from shaftprint.drift._shared_errors import is_common
from shaftprint.drift._single_test import SingleTest, single_test
from shaftprint.drift._straight import straightened

if TYPE_CHECKING:
    from shaftprint.fingerprint._line_fingerprint import LineFingerprint
    from shaftprint.models._role import Role

ADMIRALTY: Final = 2.0 / 3.0
"""Power of the displacement with which the power of a ship goes in the Admiralty coefficient: the torque at one shaft
speed may go with the draught by as much, up or down, one standard deviation."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Series(Judged):
    """Numbers of all tests; times in years since the first test."""

    roles: "dict[str, Role | None]"
    """What each of them is in the line."""
    time_a: FloatArray
    """When each test was made [years since the first], shape (tests,)."""
    values: FloatArray
    """Logarithms, and times [s]; shape (tests, numbers)."""
    covariance: FloatArray
    """Covariance of all numbers of all tests, those of one test together, shape (tests * numbers,) squared."""
    baseline: FloatArray
    """What may be another after an event, and the level of all; shape (tests * numbers, columns)."""


def series_of(history: History, *, made: int, load_repeatability: float, moved: FloatArray | None = None) -> Series:
    """Return the numbers that all tests of a history have, with their covariance.

    ``history``: the tests, with copies of the last one for those that are still to come. ``made``: number of tests that
    were made. ``load_repeatability``: standard deviation of the torque that a propeller takes at one speed from day to
    day, as a share. ``moved``: what a change of the ship has done to the numbers of the tests that were made, shape
    (made, numbers); nothing when not given. What events have done is seen here.
    """
    fingerprints = [test.fingerprint for test in history.tests]
    judged = judged_in(history.tests[:made])
    names = judged.names
    roles = {name: fingerprints[0].quantity(name).role for name in names}
    units = {name: fingerprints[0].quantity(name).unit for name in names}
    made_tests = fingerprints[:made]
    raw = judged.told([single_test(one, names) for one in made_tests])
    baseline = _baseline(history, roles)
    moved = _moved(np.array([one.values for one in raw]), baseline[: made * len(names)], moved)
    singles = list(straightened(made_tests, raw, names, moved))
    # tests that are still to come are like the last one
    singles += singles[-1:] * (len(fingerprints) - made)
    start = history.tests[0].at
    time_a = np.array([(test.at - start).total_seconds() / SECONDS_PER_YEAR for test in history.tests])
    torque = np.array([float(role == ShipRole.TORQUE) for role in roles.values()])
    known = load_repeatability * torque, np.kron(_with_draught(fingerprints, made), torque)
    causes, directions = directions_of(roles, singles[0].loadings.get(GAUGE_SCALE), units)
    return Series(
        names=names,
        roles=roles,
        left_out=judged.left_out,
        time_a=time_a,
        values=np.array([one.values for one in singles]),
        covariance=_covariance(history, singles, judged.whole, _padded(judged.unknown, len(singles)), known),
        baseline=baseline,
        causes=causes,
        directions=directions,
        not_judged=not_judged(causes, judged.doubts, fingerprints),
    )


def _padded(unknown: FloatArray, tests: int) -> FloatArray:
    """Return variances of the tests that were made, with none for those to come, shape (tests * numbers,)."""
    padded = np.zeros((tests, unknown.shape[1]))
    padded[: len(unknown)] = unknown
    return padded.reshape(-1)


def _moved(values: FloatArray, baseline: FloatArray, moved: FloatArray | None) -> FloatArray:
    """Return what a change and what events have done to the numbers of tests, shape (tests, numbers)."""
    course = np.zeros(values.shape) if moved is None else moved
    rest = (values - course).reshape(-1)
    levels = (baseline @ np.linalg.lstsq(baseline, rest)[0]).reshape(values.shape)
    by_all: FloatArray = course + levels - levels.mean(axis=0)
    return by_all


def _with_draught(tests: "Sequence[LineFingerprint]", made: int) -> FloatArray:
    """Return by how much the torque of a propeller may go with the draught of each test, a deviation, shape (tests,).

    One where nobody stated it counts as one of the mean draught of those that were made.
    """
    stated = [test.tested.of_ship_and_water().get("draught_m") for test in tests]
    depths = np.array([np.nan if one is None or one <= 0.0 else one for one in stated])
    known = np.isfinite(depths)
    if not known[:made].any():
        return np.zeros(len(tests))
    logarithms = np.log(np.where(known, depths, 1.0))
    mean = logarithms[:made][known[:made]].mean()
    return np.where(known, ADMIRALTY * (logarithms - mean), 0.0)


def _covariance(
    history: History,
    singles: list[SingleTest],
    whole: BoolArray,
    unknown: FloatArray,
    known: tuple[FloatArray, FloatArray],
) -> FloatArray:
    """Return the covariance of all numbers of all tests.

    ``unknown``: variances of what was not told, shape (tests * numbers,). ``known``: deviations of the load, from day
    to day, shape (numbers,), and with the draught, which is one error of all tests, shape (tests * numbers,).
    """
    load, along_draught = np.diag(known[0] ** 2), known[1]
    size, count = len(load), len(singles)
    covariance = np.zeros((count * size, count * size))
    tests = [test.fingerprint for test in history.tests]
    for at, own in enumerate(own_covariances(tests, singles, whole)):
        place = slice(at * size, (at + 1) * size)
        covariance[place, place] = own + load

    def shared(source: str, one: int, other: int) -> bool:
        return is_common(source, tests[one], tests[other])

    for stated in stated_errors(tests, singles, shared, whole):
        along = stated.reshape(-1)
        covariance += np.outer(along, along)
    covariance += np.outer(along_draught, along_draught)
    covariance[np.diag_indices(count * size)] += unknown
    return covariance


def own_covariances(
    tests: "Sequence[LineFingerprint]", singles: Sequence[SingleTest], whole: BoolArray
) -> Iterator[FloatArray]:
    """Yield what each test left open, of the mean shape of all tests with the same lines and structure.

    In its tightest directions a covariance holds at its own estimates alone: each test's turns a little as these move
    along the valley of delay and gains. Taken as they are, many of them would cut each other's ellipsoids to a point.

    ``tests``, ``singles``: the tests; those behind the last of ``whole`` are still to come and like the last one.
    ``whole``: whether a test says something of every number, shape (made,): else its shape is that of the others.
    """
    variances = np.array([np.diag(one.own) for one in singles])
    kinds = [weighing(test) for test in tests]
    for at in range(len(tests)):
        one = min(at, len(whole) - 1)
        kin = _kin(one, range(len(whole)), kinds, whole)
        # how noisy a test is beside its kin, as the geometric mean over its numbers; where none is judged none is noisy
        logarithms = np.log(variances / variances[kin].mean(axis=0))
        noisy = np.exp(logarithms.sum(axis=1) / max(logarithms.shape[1], 1))
        shape = np.mean([singles[other].own / noisy[other] for other in kin], axis=0)
        yield noisy[one] * shape


def _kin(one: int, of: Iterable[int], kinds: Sequence[object], whole: BoolArray) -> list[int]:
    """Return those tests of some with the same lines and structure that say something of every number."""
    alike_to = [other for other in of if kinds[one] == kinds[other]]
    return [other for other in alike_to if whole[min(other, len(whole) - 1)]] or alike_to


def stated_errors(
    tests: "Sequence[LineFingerprint]",
    singles: Sequence[SingleTest],
    shared: Callable[[str, int, int], bool],
    whole: BoolArray,
) -> Iterator[FloatArray]:
    """Yield what each error that was stated beforehand does to the tests that share it, shape (tests, numbers)."""
    kinds = [weighing(test) for test in tests]
    for source in dict.fromkeys(name for one in singles for name in one.loadings):
        left = [at for at, one in enumerate(singles) if source in one.loadings]
        while left:
            first = left[0]
            sharing = [at for at in left if at == first or shared(source, first, at)]
            left = [at for at in left if at not in sharing]
            moved = np.zeros((len(singles), len(singles[0].values)))
            for at in sharing:
                # of tests alike it is the same: what it differs by is noise of the estimates, see ``pair_of``
                kin = _kin(at, sharing, kinds, whole)
                moved[at] = np.mean([singles[other].loadings[source] for other in kin], axis=0)
            yield moved


def _baseline(history: History, roles: "dict[str, Role | None]") -> FloatArray:
    """Return the columns that are free: a level of each number, and another one after what was done to it."""
    count, size = len(history.tests), len(roles)
    columns = [np.kron(np.ones(count), unit) for unit in np.eye(size)]
    for event in history.events:
        columns += freed_by(history, event, roles).values()
    return np.array(columns).reshape(len(columns), count * size).T


def freed_by(history: History, event: Event, roles: "dict[str, Role | None]") -> dict[int, FloatArray]:
    """Return a column for each number that may be another after an event, by its place; shape (tests * numbers,).

    ``history``: the tests. ``event``: what was done; nothing is free where no test is before or after it. ``roles``:
    role of each number.
    """
    after = np.array([float(test.at >= event.at) for test in history.tests])
    if not 0.0 < after.sum() < after.size:
        return {}
    units = np.eye(len(roles))
    return {
        at: np.kron(after, units[at])
        for at, (name, role) in enumerate(roles.items())
        if role in EVENTS[event.kind]
        or name in event.numbers
        # another program may find any number of a drive otherwise
        or (role is None and event.kind == PROGRAM_CHANGED)
    }
