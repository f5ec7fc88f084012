"""Numbers that are written for no value: as -9999 in some rows, as 0 in the first before anything was computed."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.recording._channel import Channel

_SIZES = (
    99, 99.99, 888, 999, 999.25, 999.9, 999.99, 6999, 7999, 8888, 9999, 9999.9, 9999.99, 32767, 99999, 999999, 1000000,
    9999999, 2147483647, 1e30,
)  # fmt: skip
_MARKS = np.array([*_SIZES, *(-size for size in _SIZES), -32768.0, -2147483648.0, 65535.0])
_KNOWN = frozenset(_MARKS.tolist())
_FEWEST, _APART = 2, 3.0
# One that alone stands in a column is as low as this.
_ALONE = -999.0
# So many rows show what a column is about.
_ROWS = 100


@dataclass(slots=True)
class Marks:
    """What has been seen of a column so far."""

    low: float = np.inf
    high: float = -np.inf
    """Lowest and highest of the numbers that are no marks."""
    counts: dict[float, int] = field(default_factory=dict)
    """How often each mark came."""

    def take(self, values: FloatArray) -> None:
        """Look at further numbers of the column."""
        low, high = float(np.fmin.reduce(values)), float(np.fmax.reduce(values))
        if low in _KNOWN or high in _KNOWN:
            is_mark = np.isin(values, _MARKS)
            for mark, count in zip(*np.unique(values[is_mark], return_counts=True), strict=True):
                self.counts[float(mark)] = self.counts.get(float(mark), 0) + int(count)
            values = values[~is_mark]
            if not np.isfinite(values).any():
                return
            low, high = float(np.fmin.reduce(values)), float(np.fmax.reduce(values))
        self.low, self.high = min(self.low, low), max(self.high, high)

    def sentence(self, name: str) -> str:
        """Return what has to be said of a column; empty where nothing has."""
        span = self.high - self.low
        if len(self.counts) == 1 and not np.isfinite(span):
            ((mark, count),) = self.counts.items()
            is_alone = count >= _FEWEST and mark <= _ALONE
            return f"{name}: {mark:.10g} stands in every row; no sensor may have been there." if is_alone else ""
        for mark, count in self.counts.items():
            apart = max(self.low - mark, mark - self.high)
            # beside a constant a positive number may be the other level
            is_apart = apart >= _APART * span and (span > 0.0 or mark < 0.0)
            if count >= _FEWEST and np.isfinite(span) and is_apart:
                return (
                    f"{name}: {mark:.10g} stands in {count} rows, far from all other values ({self.low:.6g} to "
                    f"{self.high:.6g}); where it stands for no value, leave these fields empty."
                )
        return ""


def first_row_of_zeros(channels: Sequence[Channel]) -> str:
    """Return that the first row is 0 in every column and far from what follows; empty where it is not.

    A co-simulation may write one before its first step.
    """
    one_clock = len({(one.start_s, one.rate_hz) for one in channels}) == 1
    if len(channels) < 2 or not one_clock or any(one.count < 2 for one in channels):
        return ""
    begins = [one.values(0, min(one.count, _ROWS)) for one in channels]
    if any(begin[0] != 0.0 for begin in begins) or not any(_is_apart(begin[1:]) for begin in begins):
        return ""
    second_s = channels[0].start_s + 1.0 / channels[0].rate_hz
    return (
        "The first row is 0 in every column, far from what follows, as a co-simulation may write before its first "
        f"step; leave it out (--from {second_s:.9g})."
    )


def _is_apart(values: FloatArray) -> bool:
    """Return whether 0 is far from all of some values."""
    low, high = float(np.fmin.reduce(values)), float(np.fmax.reduce(values))
    return max(low, -high) > _APART * (high - low)
