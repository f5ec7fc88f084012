"""Lines of a text log as python-can is to read them, and those of Vector's ASC files with the times that they count."""

import re
from datetime import datetime, timedelta
from pathlib import Path
from typing import TextIO

from shaftprint.recording.readers._epoch import UNDATED_YEAR

_FIGURES = 3

_MONTHS = {
    name: number
    for number, names in enumerate(
        ("jan", "feb", "mar", "apr", "may mai", "jun", "jul", "aug", "sep", "oct okt", "nov", "dec dez"), start=1
    )
    for name in names.split()
}
_MARCH = re.compile(r"m.{1,2}r[zs]?\.?")
_DATE = re.compile(
    r"\w+\.?\s+(?P<month>\S+)\s+(?P<day>\d+)\s+(?P<time>\d+:\d+:\d+)(?:[.:](?P<part>\d+))?\s*(?P<half>[ap]m)?\s+"
    r"(?P<year>\d{4})",
    re.IGNORECASE,
)
_ASC_DATE = re.compile(r"\s*date\s+(?P<date>.+)", re.IGNORECASE)
_ASC_BASE = re.compile(r"\s*base\s+(?:hex|dec)(?:\s+timestamps\s+(?P<stamps>\w+))?", re.IGNORECASE)
_ASC_TRIGGER = re.compile(r"\s*begin\s+triggerblock\s+(?P<date>.*)", re.IGNORECASE)
# What the library takes for the end of the head; where it is missing, the first frame is taken for it.
_ASC_EVENTS = "internal events logged\n"
_ASC_FRAME = re.compile(r"\s*\d+\.\d+\s+(?:\d+\s+[0-9A-Fa-f]+x?\s+[RT]x|CANFD\s+\d+\s+[RT]x)\s")
_ASC_ROW = re.compile(r"\s*(?P<time>\d+\.\d+)(?P<rest>\s+.*)", re.DOTALL)
_ASC_START = re.compile(r"\s+start of measurement", re.IGNORECASE)


def begins_as_asc(lines: list[str]) -> bool:
    """Return whether the first lines of a file are those of an ASC file: the base, with a date or a frame."""
    return any(_ASC_BASE.match(line) for line in lines) and any(
        _ASC_DATE.match(line) or _ASC_FRAME.match(line) for line in lines
    )


class Lines:
    """Lines of a file for a library that goes through them, and whether the last one has been given."""

    def __init__(self, path: Path, file: TextIO) -> None:
        self._path = path
        self._file = file
        self._next: str | None = None
        self.rows = 0
        self.last = ""
        self.last_is_row = False
        self.has_zone = True
        """Whether dates of the lines say the zone."""

    def __iter__(self) -> "Lines":
        return self

    def __next__(self) -> str:
        line = self._file.readline() if self._next is None else self._next
        if not line:
            raise StopIteration
        self._next = self._file.readline()
        self.last, before = line, self.rows
        line = self.changed(line)
        self.last_is_row = self.rows > before
        return line

    def changed(self, line: str) -> str:
        """Return the line as the library is to read it."""
        return line

    @property
    def is_at_end(self) -> bool:
        """Whether no line is left."""
        return self._next == ""

    @property
    def is_cut(self) -> bool:
        """Whether the last line does not end, as where a file is cut off."""
        return self.is_at_end and not self.last.endswith("\n")

    def close(self) -> None:
        """Leave the file to who has opened it."""


class AscLines(Lines):
    """Lines of an ASC file, with times from the beginning of the measurement on.

    Vector's programs state that beginning in the first line, and with each block when it was triggered; others state
    when they wrote the file, and with the block when it began. Stamps are relative to the beginning ("absolute"), or to
    the row before ("relative").
    """

    def __init__(self, path: Path, file: TextIO) -> None:
        super().__init__(path, file)
        self._header: datetime | None = None
        self._trigger: datetime | None = None
        self._is_new_block = False
        self._shift_s = self._last_s = 0.0
        self._is_relative = False
        self._is_head = True
        self._waiting = ""
        self.began: datetime | None = None

    def __next__(self) -> str:
        """Return the next line, of the head only the one that says the base, and an end of it in any case."""
        if self._waiting:
            line, self._waiting = self._waiting, ""
            return line
        line = super().__next__()
        if not self._is_head:
            return line
        is_base = _ASC_BASE.match(line) is not None
        if not is_base and _ASC_ROW.match(line) is None:
            return f"// {line}"
        self._is_head = False
        first, self._waiting = (line, _ASC_EVENTS) if is_base else (_ASC_EVENTS, line)
        return first

    def changed(self, line: str) -> str:
        """Return the line with its time counted from the beginning of the measurement."""
        row = _ASC_ROW.match(line)
        if row is None:
            self._take_header(line)
            return line
        stamp = float(row["time"])
        if _ASC_START.match(row["rest"]):
            return line
        self.rows += 1
        if self._is_relative:
            self._last_s += stamp
            return f"{self._last_s:.9f}{row['rest']}"
        if self._is_new_block:
            self._place_block(stamp)
        return f"{stamp + self._shift_s:.9f}{row['rest']}" if self._shift_s else line

    def _take_header(self, line: str) -> None:
        base, date, trigger = _ASC_BASE.match(line), _ASC_DATE.match(line), _ASC_TRIGGER.match(line)
        if base is not None:
            self._is_relative = (base["stamps"] or "").lower() == "relative"
        elif date is not None:
            self._header = self.began = _date(date["date"])
        elif trigger is not None:
            self._trigger = _date(trigger["date"])
            self._is_new_block = self._trigger is not None

    def _place_block(self, stamp: float) -> None:
        """Find what the stamps of a block count from: the beginning of the measurement, or that of the block."""
        self._is_new_block = False
        trigger, header = self._trigger, self._header
        if trigger is None:
            return
        if header is None or trigger < header:
            # whoever wrote the first line did so after the measurement
            zero = trigger
        else:
            since_s = (trigger - header).total_seconds()
            zero = trigger if abs(stamp) < abs(stamp - since_s) else header
        if self.rows == 1:
            self.began = self._header = zero
            return
        if self.began is not None:
            self._shift_s = (zero - self.began).total_seconds()


def _date(text: str) -> datetime | None:
    date = _DATE.match(text.strip())
    if date is None:
        return None
    word = date["month"].lower()
    # an umlaut in any encoding
    month = 3 if _MARCH.fullmatch(word) else _MONTHS.get(word[:3])
    if month is None:
        return None
    hour, minute, second = (int(part) for part in date["time"].split(":"))
    if date["half"]:
        hour = hour % 12 + (12 if date["half"].lower() == "pm" else 0)
    if int(date["year"]) <= UNDATED_YEAR:
        return None
    try:
        whole = datetime(int(date["year"]), month, int(date["day"]), hour, minute, second)  # noqa: DTZ001
    except ValueError:
        return None
    part = date["part"] or ""
    # python-can writes milliseconds without leading zeros, 5 for 0.005 s; all others write three figures or more
    return whole + timedelta(seconds=1e-3 * int(part) if 0 < len(part) < _FIGURES else float(f"0.{part or 0}"))
