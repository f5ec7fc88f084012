"""Dates, times of day and milliseconds beside them, as seconds from the first row on."""

from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import cast

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import RecordingError
from shaftprint.recording.readers._epoch import seconds_from
from shaftprint.recording.readers.csv._dates import dates, has_offset, is_date
from shaftprint.recording.readers.csv._day_times import day_times_s, is_day_time, over_midnight
from shaftprint.recording.readers.csv._header import Header


def is_stamp(field: str) -> bool:
    """Return whether a field is a date or a time of day."""
    return is_date(field) or is_day_time(field)


class Stamps:
    """The stamps of a file, one block of rows after the other."""

    def __init__(self, path: Path, header: Header) -> None:
        self._path, self._header = path, header
        self._first: np.datetime64 | None = None
        self._in_utc = False
        self._first_s: float | None = None
        self._last_s: float | None = None

    @property
    def began(self) -> datetime | None:
        """Date of the first row; None where there are times of day alone."""
        date = None if self._first is None else cast("datetime", self._first.item())
        return date.replace(tzinfo=UTC) if date is not None and self._in_utc else date

    @property
    def day_time_s(self) -> float | None:
        """Seconds since midnight of the first row where there are times of day alone."""
        return self._first_s

    def seconds(self, columns: Mapping[int, FloatArray | Sequence[str]]) -> FloatArray:
        """Return the seconds of rows since the first of the file.

        Raises RecordingError if a stamp is no date or no time of day.
        """
        header = self._header
        parts = (columns[place] for place in header.stamp_texts)
        texts = [" ".join(of_row).strip().strip('"') for of_row in zip(*parts, strict=True)]
        milliseconds = (
            0.0 if header.milliseconds is None else np.asarray(columns[header.milliseconds], dtype=np.float64)
        )
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
        seconds = over_midnight(seconds, self._last_s)
        self._last_s = float(seconds[-1])
        if self._first_s is None:
            self._first_s = float(seconds[0])
        return seconds - self._first_s
