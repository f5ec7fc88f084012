"""Missing and doubled pulses, found from the intervals between pulses.

A missing pulse makes one interval about twice as long as its neighbours on both sides; a real change
of speed never does: after a step the neighbours on one side are as long. A doubled pulse makes two
short intervals that add up to an ordinary one.
"""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray, IntArray
from shaftprint.errors import SignalError

# Neighbours on each side whose median is compared with: five survive two faults close together.
_NEIGHBOURS = 5
_LONG, _SHORT = 1.5, 0.65

# Two short intervals are one pulse too many when their sum is this near to an ordinary one.
_SUM_TOLERANCE = 0.3

_LARGEST_SHARE = 0.05
_FEWEST_PULSES = 4 * _NEIGHBOURS


@dataclass(frozen=True, kw_only=True, slots=True)
class PulseFault:
    """One place where the pick-up missed a pulse or gave one too many."""

    kind: str
    """``"missing pulse"`` or ``"doubled pulse"``."""
    position: float
    """Where the pulse should have begun, or where the one too many begins [samples]."""
    count: int
    """Number of pulses missing or too many."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class PulseTrain:
    """The pulses that belong to strips, each with its number."""

    position: FloatArray
    """When each pulse begins [samples], shape (pulses,), ascending."""
    number: IntArray
    """Number of the pulse since the first, shape (pulses,); it jumps where pulses are missing."""
    faults: tuple[PulseFault, ...]
    """What was wrong, in order of time."""


def number_pulses(position: FloatArray, *, channel: str) -> PulseTrain:
    """Return the pulses without the doubled ones, numbered as if none were missing.

    Parameters
    ----------
    position
        Where the edges are [samples], shape (edges,), ascending.
    channel
        Name of the channel, for messages.

    Raises
    ------
    SignalError
        If there are fewer than 20 pulses, or more than one in twenty is faulty.
    """
    if position.size < _FEWEST_PULSES:
        raise SignalError(
            f"channel {channel}: expected at least {_FEWEST_PULSES} pulses, "
            f"found {position.size}; check the pick-up and the strips."
        )
    kept, faults = _without_doubled(position)
    interval = np.diff(kept)
    before, after = _neighbours(interval)
    missing = np.zeros(interval.size, dtype=np.int64)
    long = interval > _LONG * np.maximum(before, after)
    expected = 0.5 * (before + after)
    missing[long] = np.rint(interval[long] / expected[long]).astype(np.int64) - 1
    faults += [
        PulseFault(
            kind="missing pulse",
            position=float(kept[k] + interval[k] / (missing[k] + 1)),
            count=int(missing[k]),
        )
        for k in np.flatnonzero(missing)
    ]
    faults.sort(key=lambda fault: fault.position)
    if len(faults) > _LARGEST_SHARE * position.size:
        raise SignalError(
            f"channel {channel}: expected regular pulses, found {len(faults)} missing or doubled "
            f"among {position.size}; check the pick-up, its distance and its cable."
        )
    number = np.concatenate([[0], np.cumsum(1 + missing)])
    return PulseTrain(position=kept, number=number, faults=tuple(faults))


def _without_doubled(position: FloatArray) -> tuple[FloatArray, list[PulseFault]]:
    """Drop edges until no interval is short against its neighbours on both sides."""
    faults: list[PulseFault] = []
    while position.size > 2 * _NEIGHBOURS:
        interval = np.diff(position)
        before, after = _neighbours(interval)
        short = np.flatnonzero(interval < _SHORT * np.minimum(before, after))
        dropped: list[int] = []
        for k in short:
            edge = _edge_too_many(interval, int(k), 0.5 * float(before[k] + after[k]))
            # intervals beside a dropped edge are no longer what they were: next round
            if edge is not None and (not dropped or edge > dropped[-1] + 1):
                dropped.append(edge)
        if not dropped:
            break
        faults += [PulseFault(kind="doubled pulse", position=float(position[edge]), count=1) for edge in dropped]
        position = np.delete(position, dropped)
    return position, faults


def _edge_too_many(interval: FloatArray, k: int, expected: float) -> int | None:
    """Return which end of the short interval ``k`` does not belong, or nothing if both do."""
    before = interval[k - 1] + interval[k] if k > 0 else np.inf
    after = interval[k] + interval[k + 1] if k + 1 < interval.size else np.inf
    error_before, error_after = abs(before - expected), abs(after - expected)
    if min(error_before, error_after) > _SUM_TOLERANCE * expected:
        return None
    return k if error_before < error_after else k + 1


def _neighbours(interval: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the median of the intervals before and after each one, shape of ``interval``."""
    padded = np.pad(interval, _NEIGHBOURS, mode="reflect")
    windows = np.lib.stride_tricks.sliding_window_view(padded, _NEIGHBOURS)
    medians = np.partition(windows, _NEIGHBOURS // 2, axis=1)[:, _NEIGHBOURS // 2]
    return medians[: interval.size], medians[_NEIGHBOURS + 1 :]
