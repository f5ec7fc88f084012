"""Pulses of a wheel with gaps or further teeth: every tooth gets its number in the turn.

Distances between pulses, in pitches, show where teeth are missing. What is missing turn after turn is a gap of the
wheel, which marks the turn; what is missing once is a fault. A further tooth between two places marks the turn in the
same way, and is not counted.
"""

from typing import NamedTuple

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray, IntArray
from shaftprint.errors import SignalError
from shaftprint.signals.pulses._found_wheel import gaps_of, recurring_places, recurring_wheel
from shaftprint.signals.pulses._pulses import (
    LostCount,
    Pitches,
    PulseFault,
    PulseTrain,
    count_pitches,
    doubled_pulses,
    expect_few_faults,
)
from shaftprint.vessel._wheel import Wheel

# Turns in which the marks are looked for, at a time.
_TURNS = 20
# The marks of a turn are in place where so many of them are. So many turns in a row do not lose them by chance.
_IN_PLACE, _IN_A_ROW = 0.5, 3
# Pulses at the ends that may be those of a shaft that starts or stops: of the next five the intervals are so many times
# longer than of the five behind them.
_ENDS, _STARTING = 12, 1.15
# With so many times as many places without a tooth a turn says nothing of its marks.
_DROPOUT = 3


def number_teeth(position: FloatArray, wheel: Wheel, *, channel: str) -> PulseTrain:
    """Return the pulses of the teeth that are counted, numbered as if no pulse were missing.

    ``position``: where the edges are [samples], shape (edges,), ascending. ``wheel``: the wheel that the vessel file
    names, with gaps or further teeth. ``channel``: name of the channel, for messages. Returns the pulses: number ``k``
    is tooth ``k % wheel.counted`` of the turn, which begins behind the largest gap, or with the tooth before the first
    further one. Raises SignalError if there are too few pulses, too many faults, or the pulses are those of another
    wheel, which is named.
    """
    pitches = count_pitches(position, channel=channel, spacings=wheel.spacings)
    marks = _marks(pitches, wheel)
    pattern = _pattern(marks, wheel)
    if pattern is None:
        raise _another_wheel(pitches, wheel, channel)
    shift, lost = _placed(pitches, marks, pattern)
    teeth = np.ones(wheel.places, dtype=np.bool_) if wheel.extra else ~pattern
    place = _mended_ends(pitches, pitches.place + shift, teeth)
    is_tooth = teeth[place % wheel.places]
    where, tooth = pitches.position[is_tooth], place[is_tooth]
    number = tooth // wheel.places * wheel.counted + (np.cumsum(teeth) - 1)[tooth % wheel.places]
    faults = _missing(where, tooth, number, teeth) + doubled_pulses(pitches.position[~is_tooth])
    faults += doubled_pulses(_not_of_wheel(pitches, place, pattern, wheel))
    faults = [fault for fault in faults if not any(gap.first < fault.position < gap.last for gap in lost)]
    expect_few_faults(faults, position.size, channel=channel)
    return PulseTrain(
        position=where,
        number=number - number[0] // wheel.counted * wheel.counted,
        faults=tuple(sorted(faults, key=lambda fault: fault.position)),
        nominal_rev=np.diff(np.append(np.flatnonzero(teeth), wheel.places)) / wheel.places,
        lost=lost,
    )


def _marks(pitches: Pitches, wheel: Wheel) -> BoolArray:
    """Return whether there is a mark at each place: no tooth, or a further tooth behind it; whole turns, in rows."""
    place = pitches.place
    rows = int(place[-1]) // wheel.places + 1
    if wheel.extra:
        marks = np.zeros(rows * wheel.places, dtype=np.bool_)
        marks[pitches.space[pitches.space >= 0]] = True
    else:
        marks = np.ones(rows * wheel.places, dtype=np.bool_)
        marks[place] = False
        marks[int(place[-1]) :] = False
    return marks.reshape(rows, wheel.places)


def _pattern(marks: BoolArray, wheel: Wheel) -> BoolArray | None:
    """Return which places of the turn are marked, shape (places,); nothing where they are not those of the wheel."""
    for first in range(0, marks.shape[0], _TURNS):
        turns = marks[first : first + _TURNS]
        recurring = recurring_places(turns.ravel(), wheel.places)
        if turns.shape[0] < _IN_A_ROW or not recurring.any() or recurring.all():
            continue
        if wheel.extra and int(recurring.sum()) == wheel.extra:
            return np.roll(recurring, -int(np.argmax(recurring)))
        gaps = [(*wheel.missing[k:], *wheel.missing[:k]) for k in range(len(wheel.missing))]
        if not wheel.extra and gaps_of(recurring) == max(gaps):
            return np.roll(recurring, -_first_of_turn(recurring))
    return None


def _first_of_turn(empty: BoolArray) -> int:
    """Return the place of the first tooth behind the largest gap."""
    starts = np.flatnonzero(~empty & np.roll(empty, 1)).tolist()
    return int(max(starts, key=lambda start: int(np.argmin(np.roll(empty, -start)[::-1]))))


def _another_wheel(pitches: Pitches, wheel: Wheel, channel: str) -> SignalError:
    found = recurring_wheel(pitches.place, spaces=pitches.space)
    expected = f"channel {channel}: expected the teeth of a wheel {wheel}, as the vessel file says, found"
    if found is not None:
        return SignalError(
            f'{expected} those of a wheel {found}, turn after turn; write wheel = "{found}" in the vessel file.'
        )
    return SignalError(
        f"{expected} {pitches.position.size} pulses of which none is missing or too many turn after turn; write "
        "pulses_per_revolution with the number of teeth in place of wheel in the vessel file if they are evenly "
        "spaced, or check that the pick-up sees every tooth."
    )


def _placed(pitches: Pitches, marks: BoolArray, pattern: BoolArray) -> tuple[IntArray, tuple[LostCount, ...]]:
    """Return by how many places each pulse is moved so that the marks stand where the pattern has them.

    ``shift``: shape (pulses,), never descending. ``lost``: where the count breaks off, or the marks are in another
    order.
    """
    turn = pitches.place // pattern.size
    runs = _runs(_shifts_of_turns(marks, pattern))
    firsts = np.searchsorted(turn, [run.first for run in runs]).tolist()
    lasts = (np.searchsorted(turn, [run.last for run in runs], side="right") - 1).tolist()
    shift = np.full(turn.size, runs[0].shift, dtype=np.int64)
    for first, earlier, later in zip(firsts[1:], runs[:-1], runs[1:], strict=True):
        shift[first:] += (later.shift - earlier.shift) % pattern.size
    lost = list(zip(lasts[:-1], firsts[1:], strict=True))
    if runs[0].first >= _IN_A_ROW:
        lost.insert(0, (0, firsts[0]))
    if marks.shape[0] - 1 - runs[-1].last >= _IN_A_ROW:
        lost.append((lasts[-1], turn.size - 1))
    where = pitches.position
    return shift, tuple(LostCount(first=float(where[first]), last=float(where[last])) for first, last in lost)


def _mended_ends(pitches: Pitches, place: IntArray, teeth: BoolArray) -> IntArray:
    """Return the places with those of a shaft that starts or stops put right, where intervals tell little.

    Its first pulses stand at the teeth before the first one that is sure, and so at the other end.
    """
    interval = np.diff(pitches.position) / pitches.pitch
    mended = _mended_start(interval, place, teeth)
    # the end is a beginning in a mirror
    last = int(place[-1]) + teeth.size
    mirrored = _mended_start(interval[::-1], last - mended[::-1], np.roll(teeth[::-1], last + 1))
    mended = last - mirrored[::-1]
    return mended - min(int(mended[0]) // teeth.size, 0) * teeth.size


def _mended_start(interval: FloatArray, place: IntArray, teeth: BoolArray) -> IntArray:
    mended = place.copy()
    for k in range(min(_ENDS, place.size) - 1, -1, -1):
        near, far = interval[k + 1 : k + 6], interval[k + 6 : k + 11]
        if far.size and np.median(near) > _STARTING * np.median(far):
            beside = int(mended[k + 1]) - 1
            while not teeth[beside % teeth.size]:
                beside -= 1
            mended[k] = beside
    return mended


class _Run(NamedTuple):
    """Turns in which the marks stand at the same places."""

    first: int
    last: int
    shift: int


def _shifts_of_turns(marks: BoolArray, pattern: BoolArray) -> list[int]:
    """Return by how many places the marks of each turn are to be moved on, -1 where it does not say."""
    places, wanted = pattern.size, int(pattern.sum())
    moved = np.array([np.roll(pattern, -shift) for shift in range(places)], dtype=np.float64).T
    hits = marks.astype(np.float64) @ moved
    counts = marks.sum(axis=1)
    shifts: list[int] = []
    running = 0
    for turn in range(marks.shape[0]):
        row = hits[turn]
        best = running if row[running] == row.max() else int(np.argmax(row))
        if counts[turn] > _DROPOUT * wanted or row[best] < _IN_PLACE * wanted:
            shifts.append(-1)
        else:
            shifts.append(best)
            running = best
    return shifts


def _runs(shifts: list[int]) -> list[_Run]:
    """Return the runs of turns that agree, those of a few turns left out; at least one."""
    runs: list[_Run] = []
    for turn, shift in enumerate(shifts):
        if shift < 0:
            continue
        if runs and runs[-1].shift == shift and turn - runs[-1].last <= _IN_A_ROW:
            runs[-1] = runs[-1]._replace(last=turn)
        else:
            runs.append(_Run(turn, turn, shift))
    joined: list[_Run] = []
    for run in runs:
        if run.last - run.first + 1 < _IN_A_ROW:
            continue
        if joined and joined[-1].shift == run.shift and run.first - joined[-1].last <= _IN_A_ROW:
            joined[-1] = joined[-1]._replace(last=run.last)
        else:
            joined.append(run)
    return joined or runs[:1] or [_Run(0, len(shifts) - 1, 0)]


def _missing(where: FloatArray, place: IntArray, number: IntArray, teeth: BoolArray) -> list[PulseFault]:
    """Return the teeth that passed without a pulse."""
    faults = []
    for k in np.flatnonzero(np.diff(number) > 1).tolist():
        ahead = 1 + int(np.argmax(np.roll(teeth, -int(place[k] + 1) % teeth.size)))
        share = ahead / float(place[k + 1] - place[k])
        faults.append(
            PulseFault(
                kind="missing pulse",
                position=float(where[k] + share * (where[k + 1] - where[k])),
                count=int(number[k + 1] - number[k] - 1),
            )
        )
    return faults


def _not_of_wheel(pitches: Pitches, place: IntArray, pattern: BoolArray, wheel: Wheel) -> FloatArray:
    """Return where pulses too many began [samples], without those of the further teeth of the wheel."""
    if not wheel.extra:
        return pitches.doubled
    space = pitches.space
    moved = space + (place - pitches.place)[np.searchsorted(pitches.position, pitches.doubled) - 1]
    expected = (space >= 0) & pattern[moved % pattern.size]
    # of two in one space one is the tooth
    expected[1:] &= space[1:] != space[:-1]
    others: FloatArray = pitches.doubled[~expected]
    return others
