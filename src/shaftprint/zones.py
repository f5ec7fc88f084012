"""Time zones by their names, and instants from what a clock shows in one.

A clock without a stated zone tells no instant: nothing here takes the zone of the computer for it.
"""

import re
from datetime import UTC, datetime, timedelta, timezone, tzinfo
from typing import Final
from zoneinfo import ZoneInfo

EARLIEST: Final = datetime(1950, 1, 1, tzinfo=UTC)
"""Nothing that is kept was recorded or done before."""
AHEAD: Final = timedelta(days=1)
"""So far beyond the present time a stated one may lie: clocks differ, and a time without an offset is up to 14 hours
off."""

_OFFSET = re.compile(r"([+-])(\d{2}):?([0-5]\d)")
_MOST_HOURS = 14
_HOW = "expected UTC, an offset such as +02:00, or a name such as Europe/Amsterdam"


def time_zone(name: str) -> tzinfo:
    """Return the zone of a name: ``UTC``, an offset such as ``+02:00``, or one of the zone database.

    Raises
    ------
    ValueError
        If there is no such zone.
    """
    if name.upper() in {"UTC", "Z"}:
        return UTC
    offset = _OFFSET.fullmatch(name)
    if offset is not None and int(offset[2]) <= _MOST_HOURS:
        minutes = 60 * int(offset[2]) + int(offset[3])
        return timezone(timedelta(minutes=-minutes if offset[1] == "-" else minutes))
    try:
        return ZoneInfo(name)
    except (OSError, ValueError, KeyError):
        # a name with dots, a folder of the database, or no such file: all the same to who typed it
        raise ValueError(f"{_HOW}, found {name!r}") from None


def in_zone(shown: datetime, zone: tzinfo) -> datetime:
    """Return the instant, with its offset, at which a clock of a zone shows a time; one with an offset stays.

    Raises
    ------
    ValueError
        If the clock shows that time twice or never, since it is put back or forward then.
    """
    if shown.tzinfo is not None:
        return shown
    first, second = (shown.replace(tzinfo=zone, fold=fold).utcoffset() or timedelta() for fold in (0, 1))
    if first != second:
        often = "twice" if first > second else "never"
        raise ValueError(f"expected a time with its offset: clocks of {zone} show {shown.isoformat(sep=' ')} {often}")
    return shown.replace(tzinfo=timezone(first))


def possible(moment: datetime, *, now: datetime | None = None) -> datetime:
    """Return a time at which something can have been recorded or done: since 1950, and not after tomorrow.

    Every time that a user states goes through here, so that what is kept can be shown in every zone.

    Parameters
    ----------
    moment
        The time; without an offset it is taken for one in UTC.
    now
        A present time that is later than the clock of this computer shows, such as that of a simulated fleet.

    Raises
    ------
    ValueError
        If it lies outside.
    """
    present = max(datetime.now(UTC), now or EARLIEST)
    since = _since_earliest(moment)
    # as spans: an instant near the ends of the calendar cannot be moved to another zone
    if not timedelta() <= since <= _since_earliest(present) + AHEAD:
        latest = f"{present + AHEAD:%Y-%m-%d}"
        raise ValueError(f"expected a time from {EARLIEST:%Y-%m-%d} to {latest}, found {moment.isoformat(sep=' ')}")
    return moment


def _since_earliest(moment: datetime) -> timedelta:
    return moment.replace(tzinfo=None) - EARLIEST.replace(tzinfo=None) - (moment.utcoffset() or timedelta())


def utc_text(moment: datetime, zone: tzinfo = UTC) -> str:
    """Return an instant as it is printed, to the minute and with its offset: ``2026-03-13 14:05 +00:00``."""
    try:
        shown = moment.astimezone(zone)
    except OverflowError:
        # the first and the last day of the calendar, which an earlier version took, are shown as they are kept
        shown = moment
    offset = shown.strftime("%z")
    return f"{shown:%Y-%m-%d %H:%M} {offset[:3]}:{offset[3:5]}"
