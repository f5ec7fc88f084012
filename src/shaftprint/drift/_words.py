"""What two tests say about a change of the ship, in sentences: what, by how much, and with which odds."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import TypeVar

from shaftprint.arguments import refusing_none
from shaftprint.digits import p_value_text, plain_letters, stated
from shaftprint.distributions import NORMAL_95
from shaftprint.drift._causes import Cause
from shaftprint.drift._drift_finding import DatedCause, Drift, NotedChange, WatchFinding
from shaftprint.drift._finding import Finding, ShipChange, SizedCause
from shaftprint.drift._history import SECONDS_PER_YEAR, History
from shaftprint.errors import FingerprintError

OneCause = TypeVar("OneCause", bound=SizedCause)
"""A cause with or without its course."""
# Causes whose likelihoods differ by less than this factor are named together.
ALIKE = 3.0
# Odds beyond this are said as such: the model itself is not known that well.
MOST_ODDS = 1000.0
_DONE = {
    "docking": "the docking",
    "propeller-polished": "the polishing of the propeller",
    "propeller-changed": "the change of the propeller",
    "governor-changed": "the change of the governor",
    "injectors-changed": "the change of the injectors",
    "gauge-calibrated": "the calibration of the torque gauge",
}
"""What an event is in a sentence."""
UNEXPLAINED = 0.001
"""Where chance leaves as much in fewer cases than this, something else has changed."""


def finding_sentences(finding: Finding, noun: str = "ship") -> tuple[str, ...]:
    """Return whether the ship has changed and what may have changed, the answer first.

    ``finding``: what ``differ`` has found. ``noun``: what was tested, in a word.
    """
    if finding.because:
        return (f"It cannot be told: {finding.because}.",)
    count = len(finding.names)
    rest = finding.rest_p_value if finding.rest_p_value is not None else 1.0
    unexplained = rest < UNEXPLAINED
    if not finding.changes:
        if unexplained:
            return (
                f"Perhaps: {count} numbers, judged together, differ by more than chance ({_p(rest)}), and by none of "
                "the causes that are known; look at each number, and at the conditions of both tests.",
            )
        return (
            f"No: {count} numbers of the {noun}, judged together, agree within chance.",
            *open_sentences(finding.not_judged),
        )
    sentences = [f"Yes: {_of_change(finding.changes[0])}"]
    sentences += [f"Beside it {_of_change(change)}" for change in finding.changes[1:]]
    if unexplained:
        sentences.append(f"That does not explain all of the difference ({_p(rest)}): look at each number too.")
    return (*sentences, *open_sentences(finding.not_judged))


def open_sentences(causes: Sequence[Cause]) -> tuple[str, ...]:
    """Return what could not be judged, and may be it all the same."""
    names = " and ".join(cause.name for cause in causes)
    return (f"Not excluded, since it could not be judged: {names}.",) if causes else ()


def size_text(one: SizedCause) -> str:
    """Return the size of a change with its standard deviation, without a sign, as sentences have it."""
    return stated(one.cause.in_unit(abs(one.size)), one.cause.in_unit(one.std), one.cause.unit)


def _of_change(change: ShipChange) -> str:
    return alternatives(change.candidates, sized_text, "This pair of tests hardly tells")


def sized_text(one: SizedCause) -> str:
    """Return what has happened and by how much."""
    return f"{one.words}, by {size_text(one)}"


def alternatives(causes: Sequence[OneCause], told: Callable[[OneCause], str], tests: str) -> str:
    """Return causes that are about as likely as the first, the odds against the next, and what tells them apart.

    ``causes``: causes, the most likely first. ``told``: returns what one of them would mean. ``tests``: which tests
    hardly tell them apart, as the beginning of a sentence.
    """
    alike = [one for one in causes if one.odds < ALIKE]
    rest = causes[len(alike) :]
    odds = f" Odds {odds_text(rest[0].odds)} against {rest[0].words}." if rest else ""
    ways = "; ".join(dict.fromkeys(one.cause.told_by for one in alike))
    apart = "" if len(alike) == 1 else f" {tests} them apart: {ways}."
    return f"{', or '.join(map(told, alike))}.{odds}{apart}"


def odds_text(odds: float) -> str:
    """Return odds against one; those that nobody can tell apart are said to be more than the largest."""
    return f"more than {MOST_ODDS:g} : 1" if odds > MOST_ODDS else f"{odds:.0f} : 1"


def _p(p_value: float) -> str:
    return plain_letters(f"p = {p_value_text(p_value)}")


def watch_sentences(finding: WatchFinding, history: History) -> tuple[str, ...]:
    """Return whether a ship drifts, since when and how fast, and what may have changed, the answer first.

    ``finding``: what ``watch`` has found. ``history``: the tests in which it was found.
    """
    if finding.because:
        return (f"It cannot be told: {finding.because}.",)
    days = history.days
    noted = noted_sentences(finding)
    ends = (*noted, *open_sentences(finding.not_judged))
    span = f"{len(days)} tests from {days[0]} to {days[-1]}"
    if not finding.drifts:
        seen = any(one.changes for one in finding.noted)
        unchanged = "No change but what was noted" if seen else "No change beyond chance"
        return (f"{unchanged} in {span}.", *ends)
    first, *others = finding.by_urgency
    begin = "No change but expected wear" if first.best.is_expected else "Yes"
    sentences = [f"{begin}: {_of_drift(first, days, finding)}"]
    for drift in others:
        beside = "As expected, beside it" if drift.best.is_expected else "Beside it"
        sentences.append(f"{beside} {_of_drift(drift, days, finding)}")
    return (*sentences, *ends, _to_do(finding))


def noted_sentences(finding: WatchFinding) -> tuple[str, ...]:
    """Return what the events of a history did, a sentence for each, by how much; or that nothing of it is seen."""
    return tuple(_of_noted(one) for one in finding.noted)


def _of_noted(noted: NotedChange) -> str:
    event = noted.event
    what = f"{_DONE.get(event.kind, 'what was done')} on {event.at:%Y-%m-%d}"
    if not noted.changes:
        return f"After {what}, which was noted, nothing is other than before by more than chance."
    return f"Since {what}, as noted: {', and '.join(map(sized_text, noted.changes))}."


def _to_do(finding: WatchFinding) -> str:
    """Return what to do about the changes, those of one kind once."""
    ways = "; ".join(dict.fromkeys(drift.best.to_do for drift in finding.by_urgency))
    return f"What to do: {ways}."


def limit_sentence(finding: WatchFinding, cause: Cause, limit: float, history: History) -> str:
    """Return when a cause reaches a limit if it goes on as it did, in a sentence.

    ``finding``: what ``watch`` has found. ``cause``, ``limit``: which cause, and the size that it must not pass: a
    share, or a time [s]. ``history``: the tests in which it was found.
    """
    asked = f"{cause.name}, {cause.in_unit(limit):g} {cause.unit}"
    ramps = (drift.best for drift in finding.drifts if drift.best.cause == cause and drift.best.shape == "ramp")
    course = next(ramps, None)
    if course is None:
        return f"{asked}: no ramp of it is seen, so that nothing can be said of the time."
    when = time_to_limit(course, limit, history)
    days = [f"{one:%Y-%m-%d}" if one is not None else "later" for one in (when.at, when.earliest, when.latest)]
    return f"{asked}: reached on {days[0]} if it goes on as it did (95 % interval {days[1]} to {days[2]})."


def _course_text(course: DatedCause, days: Sequence[str]) -> str:
    """Return what a course says: what has happened, by how much, and since when.

    ``days``: when each test was made, in words.
    """
    size = sized_text(course)
    if course.shape == "ramp":
        return f"{size} a year since {days[course.since]}"
    return f"{size}, between {days[course.since - 1]} and {days[course.since]}"


def _by_now_text(course: DatedCause, days: Sequence[str], finding: WatchFinding) -> str:
    """Return how far a ramp has come by the last test; empty for a step, whose size says it."""
    now = finding.by_now.get(course.cause.name)
    if course.shape == "step" or now is None:
        return ""
    cause = course.cause
    sign = "" if now.size * course.size > 0.0 else "-"
    size = stated(cause.in_unit(abs(now.size)), cause.in_unit(now.std), cause.unit)
    return f", {sign}{size} by {days[-1]}"


def drift_sentence(drift: Drift, finding: WatchFinding, history: History) -> str:
    """Return one change of a history with its size, course and odds, in sentences.

    ``drift``: the change. ``finding``, ``history``: where it was found.
    """
    words = _of_drift(drift, history.days, finding)
    return f"{words[:1].upper()}{words[1:]}"


def _of_drift(drift: Drift, days: Sequence[str], finding: WatchFinding) -> str:
    def told(one: DatedCause) -> str:
        return f"{_course_text(one, days)}{_by_now_text(one, days, finding)}"

    return alternatives(drift.courses, told, "These tests hardly tell")


# Later than that nobody plans.
_MOST_YEARS = 100.0


@dataclass(frozen=True, kw_only=True, slots=True)
class TimeToLimit:
    """When a change that goes on reaches a limit."""

    at: datetime | None
    """When, if it goes on as it did; None for later than a hundred years."""
    earliest: datetime | None
    """Beginning of the 95 % interval of that time; None for later than a hundred years."""
    latest: datetime | None
    """Its end; None where the slope may be too small to tell."""


@refusing_none(FingerprintError)
def time_to_limit(course: DatedCause, limit: float, history: History) -> TimeToLimit:
    """Return when a ramp reaches a limit.

    ``course``: the ramp. ``limit``: size of the cause that it must not pass, of either sign: a share, or a time [s].
    ``history``: the tests in which it was found. Raises FingerprintError if it is a step, or the limit is zero or no
    share above -1.
    """
    if course.shape != "ramp":
        raise FingerprintError(f"{course.cause.name}: expected a ramp, found a step; it goes on to no limit.")
    share = course.cause.is_share
    if limit == 0.0 or not math.isfinite(limit) or (share and abs(limit) >= 1.0):
        raise FingerprintError(f"{course.cause.name}: expected a limit above zero and below 100 %, found {limit:g}.")
    wanted = math.copysign(abs(limit), course.size)
    way, slope = (math.log1p(wanted), math.log1p(course.size)) if share else (wanted, course.size)
    std = course.std / (1.0 + course.size) if share else course.std
    begin = history.tests[course.since].at
    slopes = (slope, slope + math.copysign(NORMAL_95 * std, slope), slope - math.copysign(NORMAL_95 * std, slope))
    at, earliest, latest = (_reached(begin, way / one) if one * way > 0.0 else None for one in slopes)
    return TimeToLimit(at=at, earliest=earliest, latest=latest)


def _reached(begin: datetime, years: float) -> datetime | None:
    return begin + timedelta(seconds=years * SECONDS_PER_YEAR) if years < _MOST_YEARS else None
