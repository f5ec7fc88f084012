"""Whether a line has changed over the years: what ``shaftprint drift`` says, with each cause test by test."""

import os
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from shaftprint.choices import LOAD_REPEATABILITY
from shaftprint.distributions import NORMAL_95
from shaftprint.drift._history import history_of
from shaftprint.drift._watch import watch
from shaftprint.drift._words import watch_sentences
from shaftprint.report._history_page import sizes_of_tests
from shaftprint.report.comparison._history_tables import course_table
from shaftprint.store._line_history import line_history
from shaftprint.store._nouns import Ship
from shaftprint.store._store import open_store
from shaftprint.web.calculator._tables import table_content

if TYPE_CHECKING:
    from shaftprint.drift._drift_finding import DatedCause, WatchFinding
    from shaftprint.drift._finding import SizedCause
    from shaftprint.drift._history import History
    from shaftprint.fingerprint._line_fingerprint import LineFingerprint

SEED: Final = 1
MOST_TESTS: Final = 40
"""Tests that are judged together; of a longer history the newest. Time grows with the cube of their number."""


def judged_line(ship: dict[str, Any], line: str) -> dict[str, Any]:
    """Return what a history says, for JSON.

    ``ship``: what tells the ship from all others: its IMO number, or its name where it has none. ``line``: which of its
    lines.
    """
    with open_store(os.environ["SHAFTPRINT_STORE"]) as store:
        known = line_history(store, Ship(**ship), line=line)
    newest, earlier = _newest(known.fingerprints)
    history = history_of(newest, known.events)
    finding = watch(history, rng=np.random.default_rng(SEED))
    sizes = sizes_of_tests(history, load_repeatability=LOAD_REPEATABILITY)
    return {
        "word": finding.outcome,
        "causes": [_cause(drift.best, history, finding) for drift in finding.by_urgency],
        "because": finding.because,
        "since": f"{history.tests[0].at:%Y-%m-%d}" if history.tests else None,
        "nearest": None if finding.nearest is None else _cause(finding.nearest.best, history, finding),
        "sentences": list(watch_sentences(finding, history)),
        "left_out": history.left_out | finding.left_out,
        "earlier": earlier,
        "courses": _courses(finding, history),
        "strips": [_strip(name, column, history) for name, column in sizes.items()],
    }


def _newest(fingerprints: "dict[str, LineFingerprint]") -> "tuple[dict[str, LineFingerprint], int]":
    """Return the fingerprints of the newest recordings, and how many earlier recordings there are.

    Of one recording several versions of the program may have made some, of which one counts as a test.
    """
    of_recording: dict[str, dict[str, LineFingerprint]] = {}
    for name, one in fingerprints.items():
        of_recording.setdefault(one.recording_sha256 or name, {})[name] = one
    newest = list(of_recording.values())[-MOST_TESTS:]
    return {name: one for of_test in newest for name, one in of_test.items()}, len(of_recording) - len(newest)


def _cause(course: "DatedCause", history: "History", finding: "WatchFinding") -> dict[str, Any]:
    days = history.days
    now = finding.by_now.get(course.cause.name) if course.shape == "ramp" else None
    # what was noted as taking a part of it off: size by now and slope fit each other with it alone
    off = [
        {
            "at": f"{noted.event.at:%Y-%m-%d}",
            "kind": noted.event.kind,
            "size": course.cause.in_unit(abs(one.size)),
            "std": course.cause.in_unit(one.std),
        }
        for noted in finding.noted
        for one in noted.changes
        if one.cause.name == course.cause.name and one.size * course.size < 0.0
    ]
    return {
        "off": off if course.shape == "ramp" else [],
        "expected": course.is_expected,
        "to_do": course.to_do,
        "now": None if now is None else {"size": course.cause.in_unit(now.size), "std": course.cause.in_unit(now.std)},
        "name": course.cause.name,
        "words": course.words,
        "shape": course.shape,
        "since": days[course.since],
        "size": course.cause.in_unit(course.size),
        "std": course.cause.in_unit(course.std),
        "unit": course.cause.unit,
    }


def _courses(finding: "WatchFinding", history: "History") -> dict[str, Any] | None:
    return None if finding.because else table_content(course_table(finding, history))


def _strip(name: str, column: "list[SizedCause | None]", history: "History") -> dict[str, Any]:
    """Return a cause test by test against the first one, in per cent or milliseconds."""
    first = history.tests[0].at.isoformat()
    there = [(test, one) for test, one in zip(history.tests, column, strict=True) if one is not None]
    cause = there[0][1].cause
    return {
        "name": name,
        "unit": cause.unit,
        "points": [
            # from which all others are counted
            {"at": first, "value": 0.0, "low": None, "high": None},
            *(
                {
                    "at": test.at.isoformat(),
                    "value": cause.in_unit(one.size),
                    "low": cause.in_unit(one.size - NORMAL_95 * one.std),
                    "high": cause.in_unit(one.size + NORMAL_95 * one.std),
                }
                for test, one in there
            ),
        ],
    }
