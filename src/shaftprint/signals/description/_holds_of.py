"""Levels one after the other: which of them are staircases, which binary sequences."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from shaftprint.signals.description._parse import Unexplained
from shaftprint.signals.description._pieces import Piece, Stairs, Straight
from shaftprint.signals.description._register import Hold

SHORTEST_DWELL_S = 2.0
"""Levels for a shorter time are no staircase, of which each has to be measured [s]."""

# Intervals are multiples of a dwell to this [s]; a dwell is the shortest interval over one of these.
_SAME_S = 0.03
_PARTS = (1, 2, 3)
# A level at the offset belongs to a staircase where it is no longer than so many times the longest of the others.
_LONGEST_REST = 1.5


def is_level(piece: "Piece | Unexplained") -> bool:
    """Return whether a piece only stands, or stands and jumps."""
    return isinstance(piece, Stairs) or (isinstance(piece, Straight) and piece.slope_v_per_s == 0.0)


def holds_of(pieces: Sequence[Piece], *, same_v: float) -> list[Hold]:
    """Return the levels of pieces that stand and jump; neighbours at one level are one."""
    holds: list[Hold] = []
    for piece in pieces:
        if isinstance(piece, Stairs):
            edges = (piece.begin_s, *piece.jumps_s, piece.end_s)
            parts = list(zip(piece.levels_v, pairwise(edges), strict=True))
        elif isinstance(piece, Straight):
            parts = [(piece.middle_v, (piece.begin_s, piece.end_s))]
        for level_v, (begin_s, end_s) in parts:
            if holds and abs(holds[-1].level_v - level_v) <= same_v:
                longer = max((holds[-1].length_s, holds[-1].level_v), (end_s - begin_s, level_v))
                holds[-1] = Hold(level_v=longer[1], begin_s=holds[-1].begin_s, end_s=end_s)
            else:
                holds.append(Hold(level_v=level_v, begin_s=begin_s, end_s=end_s))
    return holds


def stairs_of(holds: Sequence[Hold], *, offset_v: float, same_v: float) -> list[list[Hold]]:
    """Return the staircases in a list of holds: levels off the offset, and those at it between them as long as they."""
    groups: list[list[Hold]] = []
    between: Hold | None = None
    for hold in holds:
        if abs(hold.level_v - offset_v) <= same_v:
            between = hold
            continue
        if groups and between is None:
            groups[-1].append(hold)
        elif groups and between is not None and _belongs(groups[-1], between, hold):
            groups[-1] += [between, hold]
        else:
            groups.append([hold])
        between = None
    return groups


def _belongs(group: Sequence[Hold], between: Hold, after: Hold) -> bool:
    lengths = [hold.length_s for hold in (*group, after)]
    if between.length_s > _LONGEST_REST * max(lengths):
        return False
    return dwell_of([*group, between, after]) is not None


def with_one_dwell(holds: Sequence[Hold]) -> list[list[Hold]]:
    """Return holds in groups of which each has one dwell, from the first on as long as they go."""
    groups, first = [], 0
    while first < len(holds):
        stop = max(k for k in range(first + 1, len(holds) + 1) if k == first + 1 or dwell_of(holds[first:k]))
        groups.append(list(holds[first:stop]))
        first = stop
    return groups


def dwell_of(holds: Sequence[Hold]) -> tuple[float, list[int]] | None:
    """Return the dwell [s] of holds, and how many of it each lasts; None where there is none."""
    lengths = np.array([hold.length_s for hold in holds])
    for parts in _PARTS:
        dwell_s = float(lengths.min()) / parts
        counts = np.rint(lengths / dwell_s)
        if len(holds) > 1:
            dwell_s = float(lengths @ counts / (counts @ counts))
            counts = np.rint(lengths / dwell_s)
        edges = np.concatenate([[0.0], np.cumsum(counts)])
        starts = np.array([holds[0].begin_s, *(hold.end_s for hold in holds)])
        slope, first = np.polyfit(edges, starts, 1)
        if len(holds) > 1 and slope < SHORTEST_DWELL_S:
            return None
        if np.max(np.abs(starts - first - slope * edges)) <= _SAME_S:
            return float(slope), [int(count) for count in counts]
    return None
