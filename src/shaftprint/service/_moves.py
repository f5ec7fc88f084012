"""Moves of the lever in a block, and the segments around them.

A segment begins two seconds before the lever moves, when it has stood still for a while, and ends 25 s after it has
stopped, or where it moves again: so short that load and noise are one, and every move counts. Moves that follow on each
other sooner are one.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray, runs_of
from shaftprint.service._log import Block

BEFORE_S = 2.0
"""What a segment has of the time before a move [s]."""
AFTER_S = 25.0
"""What it has of the time after it [s]."""
APART_S = 8.0
"""Moves that are closer are one, and before a move the lever has stood still for so long [s]."""
SHORTEST_S, LONGEST_S = 10.0, 60.0
"""Shortest and longest segment [s]."""
MARGIN_S = 1.0
"""What a filter needs beyond both ends [s]."""
KEEP_S = APART_S + BEFORE_S + LONGEST_S + AFTER_S + 2.0 * MARGIN_S
"""What of a block has to come again with the next, so that no segment is lost between them [s]."""
# The lever moves where it goes on by more than this share of the range of speeds within so many seconds, and by more
# than so many standard deviations of its noise.
_LEAST_SHARE, _WITHIN_S, _NOISE = 0.002, 0.25, 6.0


@dataclass(frozen=True, kw_only=True, slots=True)
class Move:
    """One move of the lever, with the segment around it; places are samples of the block."""

    first: int
    """Last sample before it."""
    last: int
    """First sample after it."""
    start: int
    """First sample of the segment."""
    stop: int
    """Sample after its last."""
    is_complete: bool
    """Whether the block shows all of it."""


def moving(lever_v: FloatArray, rate_hz: float, *, range_v: float) -> BoolArray:
    """Return where the lever moves, shape (samples,).

    ``lever_v``: set point [V], shape (samples,). ``rate_hz``: samples a second [Hz]. ``range_v``: change of the set
    point from standing to the speed of the working point [V].
    """
    lag = max(round(_WITHIN_S * rate_hz), 1)
    if lever_v.size <= lag:
        return np.zeros(lever_v.size, dtype=np.bool_)
    change = np.abs(lever_v[lag:] - lever_v[:-lag])
    noise = float(np.median(np.abs(np.diff(lever_v)))) / 0.6745
    beyond = change > max(_LEAST_SHARE * abs(range_v), _NOISE * noise)
    # a change from one sample to another is a move of all between
    edges = np.zeros(lever_v.size + 1, dtype=np.int64)
    begins = np.flatnonzero(beyond)
    np.add.at(edges, begins, 1)
    np.add.at(edges, begins + lag + 1, -1)
    return np.cumsum(edges[:-1]) > 0


def moves_of(block: Block, *, range_v: float) -> Iterator[Move]:
    """Yield the moves of a block in order of time, those that follow on each other as one."""
    rate, size = block.rate_hz, block.lever_v.size
    begins, ends = np.array(runs_of(moving(block.lever_v, rate, range_v=range_v)), dtype=np.int64).reshape(-1, 2).T
    apart = np.flatnonzero(begins[1:] - ends[:-1] > APART_S * rate)
    groups = np.split(np.arange(begins.size), apart + 1) if begins.size else []
    slack = round(_WITHIN_S * rate) - 1
    for number, group in enumerate(groups):
        # the difference over a lag sees a move early and late by that lag
        first, last = int(begins[group[0]]) + slack, int(ends[group[-1]]) - slack
        first = min(first, last)
        following = int(begins[groups[number + 1][0]]) + slack if number + 1 < len(groups) else size
        stop = min(last + round(AFTER_S * rate), following)
        is_complete = stop + MARGIN_S * rate < size
        yield Move(
            first=first, last=last, start=first - round(BEFORE_S * rate), stop=stop, is_complete=bool(is_complete)
        )
