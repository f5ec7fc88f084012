"""Columns with a value in some of the rows only: those of a slower clock, or of messages of their own."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from shaftprint.arrays import FloatArray, IntArray
from shaftprint.errors import RecordingError
from shaftprint.recording._channel import Source, Times
from shaftprint.recording.readers._clock import SampleClock, clock_of_times

# A column with more of its values has lost the others.
_MOST = 0.99
# Of a slower clock the values are apart by the same number of rows, nearly everywhere.
_ALIKE, _FEWEST = 0.9, 10
_BLOCK = 1 << 20


def may_have_own_rows(filled: int, count: int) -> bool:
    """Return whether so many values in so many rows may be those of a clock of their own."""
    return _FEWEST <= filled <= _MOST * count


def own_rows(read: Source, count: int, *, is_uneven: bool) -> IntArray | None:
    """Return the rows in which a column has a value; nothing where the others are values that are missing.

    ``read``: gives the column. ``count``: number of rows. ``is_uneven``: whether the rows lie on no clock, so that each
    may be a message of another sender.
    """
    blocks = range(0, count, _BLOCK)
    filled = [start + np.flatnonzero(np.isfinite(read(start, min(start + _BLOCK, count)))) for start in blocks]
    rows: IntArray = np.concatenate(filled)
    if rows.size < _FEWEST:
        return None
    apart = np.diff(rows)
    usual = int(np.median(apart))
    if is_uneven or (usual > 1 and np.count_nonzero(apart == usual) >= _ALIKE * apart.size):
        return rows
    return None


def rows_with_values(reads: Sequence[Source], count: int) -> IntArray:
    """Return the rows in which any of some columns has a value."""
    blocks = ((start, min(start + _BLOCK, count)) for start in range(0, count, _BLOCK))
    rows: IntArray = np.concatenate(
        [
            start + np.flatnonzero(np.any([np.isfinite(read(start, stop)) for read in reads], axis=0))
            for start, stop in blocks
        ]
    )
    return rows


def only(read: Source, rows: IntArray) -> Times:
    """Return what gives some rows of a column."""

    def of_rows(start: int, stop: int) -> FloatArray:
        chosen = rows[start:stop]
        if not chosen.size:
            return np.empty(0)
        values: FloatArray = np.asarray(read(int(chosen[0]), int(chosen[-1]) + 1), dtype=np.float64)[chosen - chosen[0]]
        return values

    return of_rows


def clock_of_rows(path: Path, name: str, rows: IntArray, times: Times) -> SampleClock | RecordingError:
    """Return the clock of some rows, or why they have none.

    ``path``, ``name``: file and column, for messages. ``times``: gives the times of all rows [s].
    """
    try:
        return clock_of_times(path, f"column {name}", rows.size, only(times, rows))
    except RecordingError as error:
        return error
