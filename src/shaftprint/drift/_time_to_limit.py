"""When a ramp reaches a limit: its slope carried on, with the interval that its deviation leaves."""

import math
from dataclasses import dataclass
from datetime import datetime, timedelta

from shaftprint.arguments import refusing_none
from shaftprint.distributions import NORMAL_95
from shaftprint.drift._drift_finding import DatedCause
from shaftprint.drift._history import SECONDS_PER_YEAR, History
from shaftprint.errors import FingerprintError

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
