"""Dates, times of day and milliseconds beside them, as seconds from the first row on."""

from collections.abc import Mapping, Sequence
from datetime import UTC, datetime, time, timedelta
from pathlib import Path
from typing import cast

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import RecordingError
from shaftprint.recording.readers._epoch import seconds_from
from shaftprint.recording.readers.csv._dates import dates, has_offset, is_date
from shaftprint.recording.readers.csv._day_times import (
    AMBIGUOUS_DAY,
    ambiguous_date,
    day_times_s,
    is_day_time,
    is_span,
    may_follow,
    over_midnight,
    told_date,
)
from shaftprint.recording.readers.csv._header import Header

_DAY_S = 86_400.0


def is_stamp(field: str) -> bool:
    """Return whether a field is a date or a time of day."""
    return is_date(field) or is_day_time(field) or AMBIGUOUS_DAY.fullmatch(field) is not None


class Stamps:
    """The stamps of a file, one block of rows after the other."""

    def __init__(self, path: Path, header: Header, *, lead: "Stamps | None" = None, places: Sequence[int] = ()) -> None:
        """``lead``, ``places``: for further dates, the stamps whose first they count from, and their columns."""
        self._path, self._lead = path, lead
        self._texts = header.stamp_texts if lead is None else tuple(places)
        self._milliseconds = header.milliseconds if lead is None else None
        self._may_end = bool(header.more_times)
        self._first: np.datetime64 | None = None
        self._in_utc = False
        self._first_s: float | None = None
        self._last_s: float | None = None
        self.ambiguous_date = ""
        """Date of the first row of which day and month cannot be told apart; empty where there is none."""
        self._last_date = ""
        self._has_spans = False

    @property
    def began(self) -> datetime | None:
        """Date of the first row; None where there are times of day alone."""
        day = told_date(self.ambiguous_date) if self.ambiguous_date else None
        if day is not None:
            return datetime.combine(day, time()) + timedelta(seconds=round(self._first_s or 0.0, 6))
        date = None if self._first is None else cast("datetime", self._first.item())
        return date.replace(tzinfo=UTC) if date is not None and self._in_utc else date

    @property
    def day_time_s(self) -> float | None:
        """Seconds since midnight of the first row where there are times of day without a date that can be told."""
        return self._first_s if self.began is None and not self._has_spans else None

    def seconds(self, columns: Mapping[int, FloatArray | Sequence[str]]) -> FloatArray:
        """Return the seconds of rows since the first of the file; not a number where columns have ended.

        Raises RecordingError if a stamp is no date or no time of day.
        """
        parts = (columns[place] for place in self._texts)
        texts = [" ".join(of_row).strip().strip('"') for of_row in zip(*parts, strict=True)]
        if self._may_end and not all(texts):
            seconds = np.full(len(texts), np.nan)
            filled = [row for row, text in enumerate(texts) if text]
            if filled:
                seconds[filled] = self.seconds(
                    {place: [columns[place][row] for row in filled] for place in self._texts}
                )
            return seconds
        if self._lead is not None:
            self._first, self._in_utc = self._lead._first, self._lead._in_utc
        milliseconds = 0.0 if self._milliseconds is None else np.asarray(columns[self._milliseconds], dtype=np.float64)
        if self._first is None and (self._first_s is not None or not is_date(texts[0])):
            return self._of_day(texts, 1e-3 * milliseconds)
        when = dates(self._path, texts) + np.rint(1e3 * np.nan_to_num(milliseconds)).astype("timedelta64[us]")
        if self._first is None:
            self._first, self._in_utc = when[0], has_offset(texts[0])
        return seconds_from(self._first, when)

    def _of_day(self, texts: Sequence[str], more_s: "FloatArray | float") -> FloatArray:
        seconds = day_times_s(texts) + more_s
        wrong = np.flatnonzero(~np.isfinite(seconds))
        if wrong.size:
            raise RecordingError(
                f'{self._path}: expected times of day such as 09:00:00.010, found "{texts[int(wrong[0])][:40]}".'
            )
        self._has_spans = self._has_spans or (self._first_s is None and is_span(texts[0]))
        if self._has_spans:
            self._first_s = 0.0
            return seconds
        before_s = self._last_s
        seconds = over_midnight(seconds, before_s)
        self._expect_day_after_day(texts, np.diff(seconds // _DAY_S, prepend=(before_s or 0.0) // _DAY_S))
        self._last_s = float(seconds[-1])
        if self._first_s is None:
            self._first_s = float(seconds[0]) if self._lead is None else self._lead._first_s or 0.0
        return seconds - self._first_s

    def _expect_day_after_day(self, texts: Sequence[str], midnights: FloatArray) -> None:
        """Refuse ambiguous dates that do not go on by one at midnight: how far they are apart nobody can tell.

        Raises RecordingError if one does not.
        """
        if self._first_s is None:
            self.ambiguous_date = self._last_date = ambiguous_date(texts[0])
            if self._lead is not None and self.ambiguous_date != self._lead.ambiguous_date:
                raise RecordingError(
                    f"{self._path}: expected columns that begin on one day, found {self._lead.ambiguous_date} and "
                    f"{self.ambiguous_date}, of which day and month cannot be told apart; write the dates as in ISO "
                    "8601."
                )
        if not self.ambiguous_date:
            return
        for text, midnight in zip(texts, midnights.tolist(), strict=True):
            before = self._last_date
            if not midnight and text.startswith(before):
                continue
            date = ambiguous_date(text)
            if date == before or not midnight or not may_follow(date, before):
                raise RecordingError(
                    f'{self._path}: expected dates that go on by a day at midnight, found "{text[:40]}" behind '
                    f"{before}, of which day and month cannot be told apart; write the dates as in ISO 8601."
                )
            self._last_date = date
