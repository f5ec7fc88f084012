"""Which periods of a leg the generator has put out: it may have stopped, or begun late, while the recorder went on."""

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.signals.levels._leg_periods import FEWEST_PERIODS, LegPeriods

if TYPE_CHECKING:
    from shaftprint.arrays import FloatArray

# Two periods are alike where no piece of them, one of so many, differs by this share of the swing of the set point.
_PIECES, _SHARE = 32, 0.6


def repeated_periods(periods: LegPeriods, set_point: "FloatArray", *, rate_hz: float, start_s: float) -> LegPeriods:
    """Return the periods from the first to the last that is like its neighbour.

    A period in the middle that is disturbed stays, with a remark on its lines. Where the set point begins late, one
    more period is left for the ship to settle. Where no period is like its neighbour, all stay: that is no generator
    which stopped.

    ``periods``: whole periods of a leg that the recording holds. ``set_point``: the set point on the grid, shape
    (samples,). ``rate_hz``, ``start_s``: the grid.
    """
    alike = np.flatnonzero(_alike(periods, set_point, rate_hz=rate_hz, start_s=start_s))
    if not alike.size:
        return periods
    first, last = int(alike[0]), int(alike[-1]) + 1
    if first and last - first >= FEWEST_PERIODS:
        first += 1
    return replace(periods, start_s=periods.start_s + first * periods.period_s, periods=last + 1 - first)


def _alike(
    periods: LegPeriods, set_point: "FloatArray", *, rate_hz: float, start_s: float
) -> "np.ndarray[tuple[int, ...], np.dtype[np.bool_]]":
    """Return whether each period is like the next, shape (periods - 1,)."""
    length = periods.period_s * rate_hz
    count = _PIECES * int(np.ceil(length / _PIECES))
    first = (periods.start_s - start_s) * rate_hz
    places = first + length * (np.arange(periods.periods)[:, np.newaxis] + np.arange(count) / count)
    begin = max(int(first) - 1, 0)
    stretch = set_point[begin : begin + int(length * periods.periods) + 3]
    values = np.interp(places, begin + np.arange(stretch.size), stretch)
    swing = values.std(axis=1)
    pieces = np.diff(values, axis=0).reshape(periods.periods - 1, _PIECES, -1)
    worst = np.sqrt((pieces**2).mean(axis=2)).max(axis=1)
    return np.asarray(worst < _SHARE * np.minimum(swing[:-1], swing[1:]))
