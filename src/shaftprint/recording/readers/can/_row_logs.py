"""Rows of frames as gateways of NMEA 2000 and other programs write them, in the form that candump logs."""

import re
from collections.abc import Iterable, Mapping
from datetime import datetime

# 08:15:07.204 R 09F80115 FF 00 12 34, as Yacht Devices' gateways send it
_YACHT_DEVICES = re.compile(
    r"(?P<time>\d\d:\d\d:\d\d\.\d+)\s+[RT]\s+(?P<id>[0-9A-F]{8})(?P<data>(?:\s+[0-9A-F]{2}){1,8})\s*"
)
# A081507.204 15FF2 1F801 FF001234: sender, receiver, priority, group
_ACTISENSE = re.compile(
    r"A(?P<time>\d{6}\.\d+)\s+(?P<from>[0-9A-F]{2})(?P<to>[0-9A-F]{2})(?P<priority>[0-7])\s+(?P<pgn>[0-9A-F]{5})\s+"
    r"(?P<data>(?:[0-9A-F]{2})+)\s*"
)
# 2026-03-05T08:15:07.204Z,2,129025,21,255,8,ff,00,12,34: priority, group, sender, receiver, length; a server of
# Signal K logs it behind milliseconds since 1970 and a letter
_CANBOAT = re.compile(
    r"(?:\d{13};[\w-]+;)?"
    r"(?P<date>\d{4}-\d\d-\d\d)[-T ](?P<time>\d\d:\d\d:\d\d[.,]\d+)(?P<zone>Z|[+-]\d\d:?\d\d)?,(?P<priority>[0-7]),"
    r"(?P<pgn>\d{1,6}),(?P<from>\d{1,3}),(?P<to>\d{1,3}),(?P<length>\d{1,3})(?P<data>(?:,[0-9A-Fa-f]{2})+)\s*"
)
# 166064000,0000021A,false,Rx,0,8,FE,36,12: microseconds, whether the identifier has 29 bits, bus, length
_SAVVYCAN = re.compile(
    r"(?P<us>\d+),(?P<id>[0-9A-F]{8}),(?P<long>true|false),(?:[RT]x,)?(?P<bus>\d+),(?P<length>\d{1,2})"
    r"(?P<data>(?:,[0-9A-F]{2})*),?\s*",
    re.IGNORECASE,
)
_KINDS = {"Yacht Devices": _YACHT_DEVICES, "Actisense": _ACTISENSE, "canboat": _CANBOAT, "SavvyCAN": _SAVVYCAN}
_DAY_S = 86_400.0
# groups whose second byte is less go to one receiver
_TO_ALL = 0xF0
# bytes of a frame, those of the message in the first frame of a fast packet, and how many packets are counted
_BYTES, _FIRST, _COUNTERS = 8, 6, 8


def row_kind(lines: Iterable[str]) -> str:
    """Return what wrote some lines; empty of others."""
    return next((kind for line in lines for kind, pattern in _KINDS.items() if pattern.fullmatch(line)), "")


class Rows:
    """Rows of one kind on their way into the form of candump; times of day count from the first, over midnight."""

    def __init__(self, kind: str) -> None:
        """Begin a log.

        ``kind``: what `row_kind` said.
        """
        self._pattern = _KINDS[kind]
        self._first_s: float | None = None
        self._last_s = 0.0
        self._packets = 0
        self.has_zone = True

    def lines_of(self, row: str) -> list[str]:
        """Return the lines of candump for a row: several for a message of several frames, none where it is no frame."""
        match = self._pattern.fullmatch(row)
        parts = {} if match is None else match.groupdict()
        data = re.sub(r"[\s,]", "", parts.get("data", "")).upper()
        length = 2 * int(parts.get("length") or len(data) // 2)
        if match is None or len(data) < length:
            return []
        begin = f"({self._time_s(parts):.6f}) CAN{parts.get('bus', '')} {_identifier(parts)}#"
        return [f"{begin}{frame}\n" for frame in self._frames(data[:length])]

    def _time_s(self, parts: Mapping[str, str]) -> float:
        """Return the time of a row, since 1970 where it has a date."""
        if "us" in parts:
            return 1e-6 * float(parts["us"])
        digits = parts["time"].replace(":", "").replace(",", ".")
        seconds = 3600.0 * int(digits[:2]) + 60.0 * int(digits[2:4]) + float(digits[4:])
        if "date" in parts:
            zone = parts["zone"]
            self.has_zone = zone is not None
            return datetime.fromisoformat(f"{parts['date']}T00:00{zone or 'Z'}").timestamp() + seconds
        self._first_s = seconds if self._first_s is None else self._first_s
        seconds -= self._first_s
        seconds += _DAY_S * round((self._last_s - seconds) / _DAY_S)
        self._last_s = seconds
        return seconds

    def _frames(self, data: str) -> list[str]:
        """Return the bytes of each frame of a message, as a fast packet where one does not hold them."""
        if len(data) <= 2 * _BYTES:
            return [data]
        self._packets = (self._packets + 1) % _COUNTERS
        rests = range(2 * _FIRST, len(data), 2 * (_BYTES - 1))
        parts = [f"{len(data) // 2:02X}{data[: 2 * _FIRST]}", *(data[at : at + 2 * (_BYTES - 1)] for at in rests)]
        return [f"{self._packets << 5 | number:02X}{part}" for number, part in enumerate(parts)]


def _identifier(parts: Mapping[str, str]) -> str:
    """Return an identifier as candump writes it, eight figures where it has 29 bits."""
    if "id" in parts:
        return parts["id"] if parts.get("long", "true").lower() == "true" else parts["id"][-3:]
    base = 10 if "length" in parts else 16
    group, sender, receiver = (int(parts[key], base) for key in ("pgn", "from", "to"))
    to_one = group if group >> 8 & 0xFF >= _TO_ALL else group | receiver
    return f"{int(parts['priority']) << 26 | to_one << 8 | sender:08X}"
