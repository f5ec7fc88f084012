"""Lists of edges: a row for each change of a level, as logic analysers write them, or the time of each pulse alone."""

from pathlib import Path

import numpy as np

from shaftprint.arrays import FloatArray, IntArray
from shaftprint.errors import RecordingError
from shaftprint.recording._channel import Channel, Times
from shaftprint.recording._spool import Spool
from shaftprint.recording.readers._clock import uniform_clock
from shaftprint.recording.readers._coarse_stamps import coarse_stamps
from shaftprint.recording.readers._edges import pulses_at
from shaftprint.recording.readers.csv._header import Header

PULSES = "pulses"
"""Name of the channel of a file that holds times alone."""

# The first block tells of most columns that they hold more than two values: small blocks are read fast.
_BLOCK = 1 << 16
# With fewer edges a file is a table of another kind.
_FEWEST = 10
# Samples stay on a level for longer than one row; of a list of edges so large a share of the rows changes something.
_CHANGING = 0.9
# A needle may begin and end at one time; where more edges share theirs it is printed too coarsely, and pulses would go.
_MOST_SHARED = 0.05


def edge_channels(
    path: Path, header: Header, spool: Spool, count: int, read: Times | None
) -> dict[str, Channel] | None:
    """Return the channels of a list of edges, named as its columns; nothing where the file is none.

    Columns of a list hold two levels, and the times are not those of a clock, or something changes with every row. A
    column of times alone holds those of rising edges.

    ``path``, ``header``: the file and its titles. ``spool``: its columns. ``count``: number of rows. ``read``: gives
    their times [s], where the file has any. Raises RecordingError if times are missing or descend.
    """
    if header.time_column is None or read is None:
        return None
    columns = [column for column in range(len(header.names)) if column != header.time_column]
    changes = []
    for column in columns:
        rows = _changes(spool, column, count)
        if rows is None:
            return None
        changes.append(rows)
    times_alone = not columns
    if not times_alone and not _are_edges(path, header, read, count, changes):
        return None
    time_s = _times(path, header, read, count)
    many = max(_edges_a_time(time_s[rows]) for rows in changes or [np.arange(count)])
    if many > 1.0:
        raise RecordingError(
            f"{path}, column {header.names[header.time_column]}: expected a time for each edge, found {many:.3g} edges "
            "with each; write the times with more digits."
        )
    if times_alone:
        return {PULSES: _pulses_of(time_s)}
    return {
        header.names[column]: pulses_at(
            header.names[column],
            time_s[rows],
            first_level=_first_level(spool, column, rows),
            start_s=float(time_s[0]),
            stop_s=float(time_s[-1]),
        )
        for column, rows in zip(columns, changes, strict=True)
    }


def _changes(spool: Spool, column: int, count: int) -> IntArray | None:
    """Return the rows that differ from those before them; nothing where a column holds more than two values."""
    read = spool.source(column)
    rows: list[IntArray] = [np.empty(0, dtype=np.int64)]
    levels: set[float] = set()
    for start in range(0, count, _BLOCK):
        values = read(max(start - 1, 0), min(start + _BLOCK, count))
        # not a number is a value of its own each time
        levels |= set(np.unique(values)[:3].tolist())
        if len(levels) > 2 or not np.isfinite(values).all():
            return None
        rows.append(max(start, 1) + np.flatnonzero(np.diff(values)))
    return np.concatenate(rows)


def _are_edges(path: Path, header: Header, read: Times, count: int, changes: list[IntArray]) -> bool:
    """Return whether columns of two levels are a list of edges, not samples."""
    if max(rows.size for rows in changes) < _FEWEST:
        return False
    if np.unique(np.concatenate(changes)).size > _CHANGING * count:
        return True
    time = header.time_column or 0
    try:
        uniform_clock(path, header.names[time], count, read)
    except RecordingError:
        # of samples whose changes share their stamps the rate is asked for
        time_s = read(0, count)
        return coarse_stamps(count, read) is None or not any(_edges_a_time(time_s[rows]) > 1.0 for rows in changes)
    return False


def _edges_a_time(edge_s: FloatArray) -> float:
    """Return how many edges of one column have each time, in the mean; 1 where few share theirs."""
    shared = int(np.count_nonzero(np.diff(edge_s) == 0.0))
    return edge_s.size / (edge_s.size - shared) if shared > _MOST_SHARED * edge_s.size else 1.0


def _times(path: Path, header: Header, read: Times, count: int) -> FloatArray:
    """Return the times of all rows [s]."""
    time = header.time_column or 0
    time_s: FloatArray = read(0, count)
    where = f"{path}, column {header.names[time]}"
    if count < _FEWEST:
        raise RecordingError(f"{where}: expected the times of at least {_FEWEST} edges, found {count}.")
    missing = np.flatnonzero(~np.isfinite(time_s))
    if missing.size:
        raise RecordingError(f"{where}: expected the times of edges, found none in row {missing[0] + 1}.")
    earlier = np.flatnonzero(np.diff(time_s) < 0.0)
    if earlier.size:
        row = int(earlier[0]) + 1
        raise RecordingError(
            f"{where}: expected ascending times of edges, found {time_s[row]:.9g} s behind {time_s[row - 1]:.9g} s in "
            f"row {row + 1}; cut the file there."
        )
    return time_s


def _first_level(spool: Spool, column: int, changes: IntArray) -> int:
    """Return the level of the first row: whether it is the higher one, or, of one that never changes, not zero."""
    read = spool.source(column)
    first = float(read(0, 1)[0])
    other = float(read(int(changes[0]), int(changes[0]) + 1)[0]) if changes.size else 0.0
    return int(first > other)


def _pulses_of(time_s: FloatArray) -> Channel:
    """Return pulses that rise at some times and fall half way to the next, or half of the usual time behind."""
    apart = np.diff(time_s)
    usual = float(np.median(apart))
    high = 0.5 * np.minimum(np.append(apart, usual), usual)
    edge_s: FloatArray = np.column_stack([time_s, time_s + high]).ravel()
    return pulses_at(PULSES, edge_s, first_level=0, start_s=float(time_s[0]), stop_s=float(time_s[-1]))
