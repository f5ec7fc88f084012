"""Time zones by their names, and instants from what a clock shows in one.

A clock without a stated zone tells no instant: nothing here takes the zone of the computer for it.
"""

import re
from datetime import UTC, datetime, timedelta, timezone, tzinfo
from zoneinfo import ZoneInfo

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


def utc_text(moment: datetime, zone: tzinfo = UTC) -> str:
    """Return an instant as it is printed, to the minute and with its offset: ``2026-03-13 14:05 +00:00``."""
    shown = moment.astimezone(zone)
    offset = shown.strftime("%z")
    return f"{shown:%Y-%m-%d %H:%M} {offset[:3]}:{offset[3:5]}"
