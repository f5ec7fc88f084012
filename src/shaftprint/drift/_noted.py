"""What was noted did: how much each cause moved at a docking or a change of the governor, beyond chance.

A search for changes lets the level of each number free after what was done to the ship, so that a governor that
somebody set lower is no alarm. Whoever noted it wants to hear by how much. Here the free level gives way to a step of
each cause that such work may move, one after the other as long as chance would not make it; date and causes are known,
so that few looks are counted.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.distributions import normal_cdf
from shaftprint.drift._along import whitened
from shaftprint.drift._causes import Cause
from shaftprint.drift._course_search import growth_of
from shaftprint.drift._dated import PROGRAM_CHANGED
from shaftprint.drift._differ import MOST_CHANGES, UNLIKELY
from shaftprint.drift._drift_finding import Drift, NotedChange, SizeByNow
from shaftprint.drift._finding import SizedCause
from shaftprint.drift._history import History
from shaftprint.drift._series import Series, freed_by

_ROUNDING = 1e-6


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Step:
    """A step of a cause at an event."""

    event: int
    cause: Cause
    column: FloatArray


def noted_changes(
    history: History, series: Series, drifts: Sequence[Drift]
) -> tuple[tuple[NotedChange, ...], dict[str, SizeByNow]]:
    """Return what each event did beyond chance, and how far each cause is by the last test from where it began.

    ``history``: the tests that were made, with the events. ``series``: the numbers of all tests, of which those that
    were made come first. ``drifts``: the changes that were found beside the events.
    """
    made = _made(series, len(history.tests))
    levels = np.kron(np.ones((len(history.tests), 1)), np.eye(len(made.names)))
    freed = [freed_by(history, event, made.roles) for event in history.events]
    found_columns = [_course_column(made, drift) for drift in drifts]
    steps: list[_Step] = []
    changes: dict[int, list[SizedCause]] = {}
    for event, columns in enumerate(freed):
        if not columns or history.events[event].kind == PROGRAM_CHANGED:
            continue
        others = [one for other, of_other in enumerate(freed) if other != event for one in of_other.values()]
        fixed = [levels, *(column[:, None] for column in (*others, *found_columns))]
        changes[event] = []
        for step, sized in _steps(made, np.hstack(fixed), history, event, tuple(columns)):
            steps.append(step)
            changes[event].append(sized)
    explained = {step.event for step in steps}
    left = [one for event, of_event in enumerate(freed) if event not in explained for one in of_event.values()]
    noted = tuple(
        NotedChange(event=history.events[event], changes=tuple(of_event)) for event, of_event in changes.items()
    )
    base = np.hstack([levels, *(column[:, None] for column in left)])
    return noted, _by_now(made, base, drifts, found_columns, steps)


def _made(series: Series, count: int) -> Series:
    """Return the numbers of the tests that were made, without those that are still to come."""
    rows = count * len(series.names)
    return replace(
        series,
        time_a=series.time_a[:count],
        values=series.values[:count],
        covariance=series.covariance[:rows, :rows],
        baseline=series.baseline[:rows],
    )


def _steps(
    series: Series, fixed: FloatArray, history: History, event: int, concerned: Sequence[int]
) -> Iterator[tuple[_Step, SizedCause]]:
    """Yield the steps of causes that an event made beyond chance, the clearest first."""
    after = np.array([float(test.at >= history.events[event].at) for test in history.tests])
    places = [
        place
        for place, direction in enumerate(series.directions.T)
        if set(np.flatnonzero(direction)) <= set(concerned) and direction.any()
    ]
    for _ in range(MOST_CHANGES):
        if not places:
            return
        columns = np.array([np.kron(after, series.directions[:, place]) for place in places]).T
        sizes, lengths = _along(series, fixed, columns)
        scores = np.where(lengths > 0.0, sizes * lengths, 0.0)
        best = int(np.argmax(np.abs(scores)))
        p_value = min(1.0, 2.0 * len(places) * float(normal_cdf(-abs(scores[best]))))
        if p_value > UNLIKELY:
            return
        cause = series.causes[places.pop(best)]
        stated, std = cause.stated(float(sizes[best]), float(1.0 / lengths[best]))
        sized = SizedCause(cause=cause, size=stated, std=std, score=float(scores[best]), odds=1.0)
        yield _Step(event=event, cause=cause, column=columns[:, best]), sized
        fixed = np.column_stack([fixed, columns[:, best]])


def _along(series: Series, fixed: FloatArray, columns: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the size along each column beside what is fixed, and one over its deviation, 0 where it is not told."""
    white = whitened(series.values.reshape(-1), series.covariance, np.hstack([fixed, columns]))
    free, of_columns = white.directions[:, : fixed.shape[1]], white.directions[:, fixed.shape[1] :]
    left = of_columns - free @ np.linalg.lstsq(free, of_columns)[0]
    lengths: FloatArray = np.linalg.norm(left, axis=0)
    lengths = np.where(lengths > _ROUNDING * np.linalg.norm(of_columns, axis=0), lengths, 0.0)
    sizes = (left.T @ white.difference) / np.where(lengths > 0.0, lengths, 1.0) ** 2
    return sizes, lengths


def _course_column(series: Series, drift: Drift) -> FloatArray:
    best = drift.best
    growth = growth_of(best.shape, best.since, series.time_a)
    direction = series.directions[:, series.causes.index(best.cause)]
    return np.asarray(np.kron(growth, direction), dtype=np.float64)


def _by_now(
    series: Series,
    base: FloatArray,
    drifts: Sequence[Drift],
    found: Sequence[FloatArray],
    steps: Sequence[_Step],
) -> dict[str, SizeByNow]:
    """Return the whole size of each cause that drifts at the last test, what events took off or put on counted.

    All courses are fitted together, so that what a ramp and a docking take from each other is in the deviation.
    """
    if not drifts:
        return {}
    columns = [*found, *(step.column for step in steps)]
    causes = [*(drift.best.cause for drift in drifts), *(step.cause for step in steps)]
    growths = [growth_of(one.best.shape, one.best.since, series.time_a)[-1] for one in drifts]
    growths += [1.0] * len(steps)
    white = whitened(series.values.reshape(-1), series.covariance, np.column_stack([base, *columns]))
    inverse = np.linalg.pinv(white.directions)
    sizes, covariance = inverse @ white.difference, inverse @ inverse.T
    place = base.shape[1]
    by_now = {}
    for cause in dict.fromkeys(drift.best.cause for drift in drifts):
        weights = np.zeros(len(sizes))
        weights[place:] = [growth * (one == cause) for one, growth in zip(causes, growths, strict=True)]
        size, std = cause.stated(float(weights @ sizes), float(np.sqrt(weights @ covariance @ weights)))
        by_now[cause.name] = SizeByNow(size=size, std=std)
    return by_now
