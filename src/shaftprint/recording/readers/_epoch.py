"""Clocks that count from 1970, brought to the beginning of the recording."""

import re
from collections.abc import Mapping
from datetime import UTC, datetime, timedelta, timezone

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray
from shaftprint.recording._channel import Channel

LATER_THAN_ANY_TEST_S = 1e8
"""Three years: a test that begins so long after the zero of its clock begins at a date [s]."""
_LATEST_S = 4e9
_REFERENCE = re.compile(
    r"(\d{1,4})-(\d\d?)-(\d\d?)(?:[T ]+(\d\d?):(\d\d?)(?::(\d\d?(?:\.\d*)?))?)?\s*(?:Z|UTC|GMT|([+-])(\d\d?):?(\d\d)?)?"
)
UNDATED_YEAR = 1970
"""The year that programs write which know no date; earlier ones are none either."""


def from_second_zero(
    channels: Mapping[str, Channel], *, has_zone: bool = True, reference_s: float | None = None
) -> tuple[dict[str, Channel], datetime | None]:
    """Return channels with times from the first of them on, where they count seconds since 1970, and that date.

    ``channels``: channels as the file has them; those that begin within three years of their zero are left as they are.
    ``has_zone``: whether 1970 is that of UTC; else it is that of the place, and the date has no offset.
    ``reference_s``: date of the zero of those that are left as they are, in seconds since 1970.
    """
    starts = [channel.start_s for channel in channels.values() if channel.start_s > LATER_THAN_ANY_TEST_S]
    zero = datetime(1970, 1, 1, tzinfo=UTC if has_zone else None)
    if not starts:
        return dict(channels), None if reference_s is None else zero + timedelta(seconds=reference_s)
    first = min(starts)
    began = zero + timedelta(seconds=first) if first < _LATEST_S else None
    moved = {
        name: channel.on_other_clock(start_s=channel.start_s - first, rate_hz=channel.rate_hz)
        if channel.start_s >= first
        else channel
        for name, channel in channels.items()
    }
    return moved, began


def seconds_from(first: np.datetime64, times: "np.datetime64 | NDArray[np.datetime64]") -> FloatArray:
    """Return seconds since a first date, shape as the dates."""
    return np.asarray((times - first) / np.timedelta64(1, "us") * 1e-6, dtype=np.float64)


def reference_s(text: str) -> float | None:
    """Return the seconds since 1970 of the date behind ``seconds since``; None where it is none.

    Without an offset it is in UTC, as the CF conventions have it.
    """
    match = _REFERENCE.fullmatch(text.strip())
    if match is None:
        return None
    year, month, day, hour, minute = (int(part or 0) for part in match.groups()[:5])
    sign, hours, minutes = match.groups()[6:]
    offset = timedelta(hours=int(hours or 0), minutes=int(minutes or 0)) * (-1 if sign == "-" else 1)
    try:
        date = datetime(year, month, day, hour, minute, tzinfo=timezone(offset))
    except ValueError:
        return None
    return (date - datetime(1970, 1, 1, tzinfo=UTC)).total_seconds() + float(match[6] or 0.0)


def from_its_zero(
    channels: Mapping[str, Channel], began: datetime | None
) -> tuple[dict[str, Channel], datetime | None]:
    """Return channels with times from the first of them on, where the file's date is no beginning of theirs.

    That of a file which was converted from another is when that was done: all samples then lie before it.

    ``channels``: channels as the file has them; what begins at its date, or somewhat before it, is left as it is.
    ``began``: the date of second zero.
    """
    starts = [channel.start_s for channel in channels.values()]
    first, last = min(starts), max(channel.start_s + channel.duration_s for channel in channels.values())
    if first > LATER_THAN_ANY_TEST_S:
        return from_second_zero(channels)
    if last > 0.0:
        return dict(channels), began
    moved = {
        name: channel.on_other_clock(start_s=channel.start_s - first, rate_hz=channel.rate_hz)
        for name, channel in channels.items()
    }
    return moved, None if began is None else _date_of(began, first)


def _date_of(began: datetime, first_s: float) -> datetime | None:
    try:
        date = began + timedelta(seconds=first_s)
    except OverflowError:
        return None
    # times that begin at zero, put before a date, come to 1970: a date that nobody knows
    return date if date.year > UNDATED_YEAR else None
