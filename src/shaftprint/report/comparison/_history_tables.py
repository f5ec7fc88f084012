"""Tables of a history: courses of what may have changed, and the size of each cause test by test."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from shaftprint.digits import p_value_text, plain
from shaftprint.drift._words import ALIKE
from shaftprint.plain_table import Column, Table, numbers, texts
from shaftprint.report.comparison._cause_table import odds_text, sized

if TYPE_CHECKING:
    from shaftprint.drift._drift_finding import DatedCause, Drift, WatchFinding
    from shaftprint.drift._finding import SizedCause
    from shaftprint.drift._history import History

MOST_CAUSES = 4
NOT_THERE = "–"


def course_table(finding: "WatchFinding", history: "History") -> Table:
    """Return what was seen, wear that is expected last; of what is as likely, each; else what comes nearest.

    ``finding``: what was found. ``history``: the tests in which it was found.
    """
    drifts = finding.by_urgency or (() if finding.nearest is None else (finding.nearest,))
    rows = [
        (*cells, "" if place else p_value_text(drift.p_value))
        for drift in drifts
        for place, cells in enumerate(_courses(drift, history, seen=True))
    ]
    return Table(
        title="What has changed" if finding.drifts else "No change beyond chance; what comes nearest",
        columns=(
            *texts("what may have changed"),
            *numbers("by"),
            *texts("course"),
            *numbers("size / deviation", "odds against it", "p"),
        ),
        rows=tuple(rows),
        note=f"Judged together: {', '.join(finding.names)}.",
    )


def other_course_table(finding: "WatchFinding", history: "History") -> Table:
    """Return what else could stand for each change that was seen, with the odds against it.

    ``finding``, ``history``: as for ``course_table``.
    """
    rows = [
        (drift.best.cause.name if place == 0 else "", *cells)
        for drift in finding.by_urgency
        for place, cells in enumerate(_courses(drift, history, seen=False))
    ]
    return Table(
        title="Other explanations, each instead of what was seen",
        columns=(
            *texts("seen", "instead"),
            *numbers("by"),
            *texts("course"),
            *numbers("size / deviation", "odds against it"),
        ),
        rows=tuple(rows),
    )


def _courses(drift: "Drift", history: "History", *, seen: bool) -> list[tuple[str, ...]]:
    """Return the cells of the courses of a change: of those that are as likely as the best one, or of the others."""
    days = history.days
    return [
        (
            one.words,
            _size(one),
            f"ramp since {days[one.since]}" if one.shape == "ramp" else f"step by {days[one.since]}",
            plain(one.score, 1),
            odds_text(one) if place else NOT_THERE,
        )
        for place, one in enumerate(drift.courses)
        if (one.odds < ALIKE) == seen
    ]


def _size(one: "DatedCause") -> str:
    return f"{sized(one)}/year" if one.shape == "ramp" else sized(one)


def history_table(history: "History", sizes: "Mapping[str, Sequence[SizedCause | None]]") -> Table:
    """Return every test with the size of the causes that vary most, and what was done to the ship, in order of time.

    ``history``: the tests, and what was done to the ship. ``sizes``: size of each cause against the first test, by the
    name of the cause, in the order of the tests.
    """
    largest = {name: max((abs(one.score) for one in column if one), default=0.0) for name, column in sizes.items()}
    chosen = sorted(largest, key=lambda name: -largest[name])[:MOST_CAUSES]
    rows = [
        (test.at, (f"{test.at:%Y-%m-%d}", test.name, *(_cell(sizes[name][place]) for name in chosen)))
        for place, test in enumerate(history.tests)
    ]
    rows += [
        (
            event.at,
            (f"{event.at:%Y-%m-%d}", f"{event.kind}{f': {event.note}' if event.note else ''}", *("" for _ in chosen)),
        )
        for event in history.events
    ]
    return Table(
        title="Change of each test against the first, by cause",
        columns=(*texts("date", "test or event"), *(Column(name, number=True) for name in chosen)),
        rows=tuple(row for _, row in sorted(rows, key=lambda one: one[0])),
        note="Each column as if it were this cause alone.",
    )


def _cell(one: "SizedCause | None") -> str:
    return NOT_THERE if one is None else sized(one)
