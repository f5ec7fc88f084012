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
from dataclasses import replace
from datetime import timedelta

import numpy as np

from shaftprint.choices import LOAD_REPEATABILITY
from shaftprint.drift._course_search import FEWEST_TESTS, CourseSearch
from shaftprint.drift._differ import MOST_CHANGES, NOT_DETERMINED, NOT_TOLD, ROUNDS, UNLIKELY
from shaftprint.drift._drift_finding import Drift, WatchFinding
from shaftprint.drift._history import SECONDS_PER_YEAR, History
from shaftprint.drift._noted import noted_changes
from shaftprint.drift._series import series_of
from shaftprint.fingerprint._design import another_design, in_short

HORIZON = 20
"""Tests over which false alarms are counted: five years of quarterly tests."""
DRAWS = 2000
QUARTER_A = 0.25


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
    place, designs = another_design([test.fingerprint.stated_fields for test in history.tests])
    if designs:
        return _nothing(f"{history.tests[0].name} and {history.tests[place].name}: {in_short(designs)}", {})
    extended = _extended(history, horizon)
    series = series_of(extended, made=count, load_repeatability=load_repeatability)
    left_out = series.left_out
    if not series.causes:
        return _nothing(NOT_TOLD, left_out)
    try:
        search = CourseSearch.of(series, count)
        noise = rng.standard_normal((series.values.size, draws))
        nearest = search.nearest(noise)
        if nearest is not None and nearest.p_value <= UNLIKELY:
            for _ in range(ROUNDS):
                moved = search.effect(search.likeliest()[0])
                # of a hundred tests each takes thirty megabytes: what is found anew has their room
                del search, series
                series = series_of(extended, made=count, load_repeatability=load_repeatability, moved=moved)
                search = CourseSearch.of(series, count)
            nearest = search.nearest(noise)
    except np.linalg.LinAlgError:
        return _nothing(NOT_DETERMINED, left_out)
    drifts: list[Drift] = []
    while nearest is not None and nearest.p_value <= UNLIKELY and len(drifts) < MOST_CHANGES:
        drifts.append(nearest)
        search = search.beside(nearest.best)
        nearest = search.nearest(noise)
    noted, by_now = noted_changes(history, series, drifts)
    return WatchFinding(
        drifts=tuple(drifts),
        nearest=nearest,
        names=series.names,
        left_out=series.left_out,
        not_judged=series.not_judged,
        noted=noted,
        by_now=by_now,
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
