"""Missing and doubled pulses, found from the intervals between pulses.

A missing pulse makes one interval about twice as long as its neighbours on both sides; a real change
of speed never does: after a step the neighbours on one side are as long. A doubled pulse makes two
short intervals that add up to an ordinary one.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from shaftprint.arrays import FloatArray, IntArray
from shaftprint.errors import SignalError
from shaftprint.signals.pulses._found_wheel import recurring_wheel

# Neighbours on each side whose median is compared with: five survive two faults close together.
_NEIGHBOURS = 5
_LONG, _SHORT = 1.5, 0.65

# Two short intervals are one pulse too many when their sum is this near to an ordinary one.
_SUM_TOLERANCE = 0.3
# Two edges closer than this are one that was seen twice, whatever stands around them.
_BOUNCE = 0.1

_LARGEST_SHARE = 0.05
_FEWEST_PULSES = 4 * _NEIGHBOURS

# A pulse at an end of the recording with a silence of so many pitches beside it is counted with nothing: before a shaft
# starts, the level at which a logger begins may look like one.
_SILENT = 8

# At the ends there are neighbours on one side only. A shaft that starts turns faster by more than this from one pulse
# to the next; then nothing tells a long interval from a missing pulse.
_STARTING = 1.05


@dataclass(frozen=True, kw_only=True, slots=True)
class PulseFault:
    """One place where the pick-up missed a pulse or gave one too many."""

    kind: str
    """``"missing pulse"`` or ``"doubled pulse"``."""
    position: float
    """Where the pulse should have begun, or where the one too many begins [samples]."""
    count: int
    """Number of pulses missing or too many."""


@dataclass(frozen=True, kw_only=True, slots=True)
class LostCount:
    """A stretch behind which the teeth of a wheel come in another order than before."""

    first: float
    """Last pulse before it [samples]."""
    last: float
    """First pulse behind it [samples]."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class PulseTrain:
    """The pulses that belong to strips or teeth, each with its number."""

    position: FloatArray
    """When each pulse begins [samples], shape (pulses,), ascending."""
    number: IntArray
    """Number of the pulse since the first, shape (pulses,); it jumps where pulses are missing."""
    faults: tuple[PulseFault, ...]
    """What was wrong, in order of time."""
    nominal_rev: FloatArray = field(default_factory=lambda: np.ones(1))
    """Angle from each strip or tooth of the turn to the next where it is as the vessel file says [rev], shape (teeth,);
    one turn of a strip where nothing is said."""
    lost: tuple[LostCount, ...] = ()
    """Where the count of a wheel's teeth breaks off, in order of time."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Pitches:
    """Pulses with the distance between them in pitches: of a wheel without gaps or faults all are 1."""

    position: FloatArray
    """When each pulse begins [samples], shape (pulses,), ascending."""
    pitch: IntArray
    """From each pulse to the next, shape (pulses - 1,)."""
    doubled: FloatArray
    """Where pulses too many began [samples], ascending."""

    @property
    def place(self) -> IntArray:
        """Number of the place of each pulse, as if there were a tooth at every place, shape (pulses,)."""
        return np.concatenate([[0], np.cumsum(self.pitch)])

    @property
    def space(self) -> IntArray:
        """Number of the place behind which each pulse too many began, shape (doubled,); -1 outside of the pulses."""
        before = np.searchsorted(self.position, self.doubled) - 1
        inside = np.clip(before, 0, self.pitch.size - 1)
        share = (self.doubled - self.position[inside]) / (self.position[inside + 1] - self.position[inside])
        space: IntArray = self.place[inside] + np.floor(share * self.pitch[inside]).astype(np.int64)
        return np.where((before == inside) & (share < 1.0), space, -1)


def number_pulses(position: FloatArray, *, channel: str) -> PulseTrain:
    """Return the pulses without the doubled ones, numbered as if none were missing.

    ``position``: where the edges are [samples], shape (edges,), ascending. ``channel``: name of the channel, for
    messages. Raises SignalError if there are fewer than 20 pulses, more than one in twenty is faulty, or those that are
    missing or too many come back with every turn, as on a wheel with gaps or further teeth.
    """
    pitches = count_pitches(position, channel=channel)
    wheel = recurring_wheel(pitches.place, spaces=pitches.space)
    if wheel is not None:
        raise SignalError(
            f"channel {channel}: expected evenly spaced pulses, found the teeth of a wheel {wheel}, turn after turn; "
            f'write wheel = "{wheel}" in place of pulses_per_revolution in the vessel file.'
        )
    missing = pitches.pitch - 1
    faults = doubled_pulses(pitches.doubled) + [
        PulseFault(
            kind="missing pulse",
            position=float(pitches.position[k] + np.diff(pitches.position[k : k + 2])[0] / (missing[k] + 1)),
            count=int(missing[k]),
        )
        for k in np.flatnonzero(missing)
    ]
    faults.sort(key=lambda fault: fault.position)
    expect_few_faults(faults, position.size, channel=channel)
    return PulseTrain(position=pitches.position, number=pitches.place, faults=tuple(faults))


def count_pitches(position: FloatArray, *, channel: str, spacings: Sequence[int] = (1,)) -> Pitches:
    """Return the pulses without the doubled ones, with the distance from each to the next.

    ``position``: where the edges are [samples], shape (edges,), ascending. ``channel``: name of the channel, for
    messages. ``spacings``: distances between teeth that a wheel has, in pitches. Raises SignalError if there are fewer
    than 20 pulses.
    """
    if position.size < _FEWEST_PULSES:
        raise SignalError(
            f"channel {channel}: expected at least {_FEWEST_PULSES} pulses, "
            f"found {position.size}; check the pick-up and the strips."
        )
    kept, doubled = _without_doubled(position, np.array(spacings, dtype=np.float64))
    interval = np.diff(kept)
    before, after = _neighbours(interval)
    pitch = np.ones(interval.size, dtype=np.int64)
    long = interval > _LONG * np.maximum(before, after)
    pitch[long] = np.rint(interval[long] / _usual(interval, np.flatnonzero(long))).astype(np.int64)
    # what comes before the first regular intervals of a shaft that starts cannot be counted, and so at the other end
    first = _uncounted(interval, pitch, longest=max(spacings))
    last = kept.size - _uncounted(interval[::-1], pitch[::-1], longest=max(spacings))
    return Pitches(position=kept[first:last], pitch=pitch[first : last - 1], doubled=np.array(doubled))


def doubled_pulses(position: FloatArray) -> list[PulseFault]:
    """Return pulses too many as faults."""
    return [PulseFault(kind="doubled pulse", position=float(place), count=1) for place in position]


def expect_few_faults(faults: Sequence[PulseFault], pulses: int, *, channel: str) -> None:
    """Check that most pulses are sound.

    Raises SignalError if more than one in twenty is faulty.
    """
    if len(faults) > _LARGEST_SHARE * pulses:
        raise SignalError(
            f"channel {channel}: expected regular pulses, found {len(faults)} missing or doubled "
            f"among {pulses}; check the pick-up, its distance and its cable."
        )


def _uncounted(interval: FloatArray, pitch: IntArray, *, longest: int) -> int:
    """Return how many pulses at the beginning stand alone because the shaft only starts to turn."""
    first = 1 if interval.size > _NEIGHBOURS and pitch[0] > _SILENT * longest else 0
    while first + _NEIGHBOURS < interval.size and pitch[first] != 1:
        following = interval[first + 1 : first + 3] / pitch[first + 1 : first + 3]
        if following[0] < _STARTING * following[1]:
            break
        first += 1
    return first


def _without_doubled(position: FloatArray, spacings: FloatArray) -> tuple[FloatArray, list[float]]:
    """Drop edges until no interval is short against its neighbours on both sides; return what was dropped too."""
    doubled: list[float] = []
    while position.size > 2 * _NEIGHBOURS:
        interval = np.diff(position)
        before, after = _neighbours(interval)
        short = np.flatnonzero(interval < _SHORT * np.minimum(before, after))
        dropped: list[int] = []
        for k in short:
            edge = _edge_too_many(interval, int(k), 0.5 * float(before[k] + after[k]), spacings)
            # intervals beside a dropped edge are no longer what they were: next round
            if edge is not None and (not dropped or edge > dropped[-1] + 1):
                dropped.append(edge)
        if not dropped:
            break
        doubled += position[dropped].tolist()
        position = np.delete(position, dropped)
    return position, sorted(doubled)


def _edge_too_many(interval: FloatArray, k: int, expected: float, spacings: FloatArray) -> int | None:
    """Return which end of the short interval ``k`` does not belong, or nothing if both do."""
    before = interval[k - 1] + interval[k] if k > 0 else np.inf
    after = interval[k] + interval[k + 1] if k + 1 < interval.size else np.inf
    error_before, error_after = (float(np.abs(both - expected * spacings).min()) for both in (before, after))
    if min(error_before, error_after) > _SUM_TOLERANCE * expected:
        return k + 1 if interval[k] < _BOUNCE * expected else None
    return k if error_before < error_after else k + 1


def _usual(interval: FloatArray, which: IntArray) -> FloatArray:
    """Return the mean of the ordinary intervals on both sides of some, shape (which,).

    Where a logger takes few samples a pulse, intervals are four or five samples long and their median is one of them.
    """
    padded = np.pad(interval, _NEIGHBOURS, mode="reflect")
    sides = which[:, np.newaxis] + np.arange(_NEIGHBOURS)
    means = []
    for near in (padded[sides], padded[sides + _NEIGHBOURS + 1]):
        median = np.median(near, axis=1, keepdims=True)
        ordinary = (near > _SHORT * median) & (near < _LONG * median)
        means.append(np.where(ordinary, near, 0.0).sum(axis=1) / ordinary.sum(axis=1))
    return np.asarray(0.5 * (means[0] + means[1]))


def _neighbours(interval: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the median of the intervals before and after each one, shape of ``interval``."""
    padded = np.pad(interval, _NEIGHBOURS, mode="reflect")
    windows = np.lib.stride_tricks.sliding_window_view(padded, _NEIGHBOURS)
    medians = np.partition(windows, _NEIGHBOURS // 2, axis=1)[:, _NEIGHBOURS // 2]
    return medians[: interval.size], medians[_NEIGHBOURS + 1 :]
