"""Which wheel pulses come from, found from what is missing or too many turn after turn."""

import numpy as np

from shaftprint.arrays import BoolArray, IntArray, in_blocks, runs_of
from shaftprint.vessel._wheel import Wheel

# Faults are random; of what belongs to a wheel so much comes back after a turn.
RECURRING = 0.6
_AS_GOOD = 0.85
_LEAST_TURNS = 6
_FEWEST_PLACES, _MOST_PLACES = 5, 400
# Pulses that are looked at, and the largest share of places that may be empty.
_MOST_PULSES, _LARGEST_SHARE = 40_000, 0.34


def recurring_wheel(place: IntArray, spaces: IntArray) -> Wheel | None:
    """Return the wheel whose gaps or further teeth come back with every turn; nothing where there are none.

    ``place``: number of the place of each pulse, shape (pulses,), ascending. ``spaces``: numbers of the places behind
    which there is a pulse too many, shape (doubled,).
    """
    place = place[:_MOST_PULSES]
    count = int(place[-1]) + 1
    if count > 2 * place.size:
        return None
    empty, extra = np.ones(count, dtype=np.bool_), np.zeros(count, dtype=np.bool_)
    empty[place] = False
    extra[spaces[(spaces >= 0) & (spaces < count)]] = True
    for marks, makes in ((empty, _with_gaps), (extra, _with_further_teeth)):
        places = _period(marks)
        if places:
            return makes(recurring_places(marks, places))
    return None


def recurring_places(marks: BoolArray, places: int) -> BoolArray:
    """Return which places of a wheel are marked in most turns, shape (places,)."""
    turns = in_blocks(marks, places)
    recurring: BoolArray = turns.mean(axis=0) > RECURRING
    return recurring


def gaps_of(empty: BoolArray) -> tuple[int, ...]:
    """Return how many places are empty in each gap of a wheel, from its largest gap on in the order of turning."""
    if not empty.any() or empty.all():
        return ()
    first = int(np.flatnonzero(~empty & np.roll(empty, 1))[0])
    sizes = [stop - begin for begin, stop in runs_of(np.roll(empty, -first))]
    turned = [(*sizes[k:], *sizes[:k]) for k in range(len(sizes))]
    return max(turned)


def _with_gaps(empty: BoolArray) -> Wheel:
    return Wheel(places=empty.size, missing=gaps_of(empty))


def _with_further_teeth(extra: BoolArray) -> Wheel:
    return Wheel(places=extra.size, extra=int(extra.sum()))


def _period(marks: BoolArray) -> int:
    """Return after how many places marks come back; 0 where they do not."""
    total = int(marks.sum())
    if total < _LEAST_TURNS or total > _LARGEST_SHARE * marks.size:
        return 0
    where = np.flatnonzero(marks)
    candidates = range(_FEWEST_PLACES, min(_MOST_PLACES, marks.size // _LEAST_TURNS) + 1)
    again = [float(marks[where[where < marks.size - places] + places].mean()) for places in candidates]
    # half a turn brings some of several gaps back, the turn all of them
    most = max(again, default=0.0)
    places = next((one for one, share in zip(candidates, again, strict=True) if share >= _AS_GOOD * most), 0)
    return places if most > RECURRING and _explained(marks, places) else 0


def _explained(marks: BoolArray, places: int) -> bool:
    """Return whether most marks stand where a wheel of so many places has them."""
    recurring = recurring_places(marks, places)
    return bool(recurring.any() and recurring[np.flatnonzero(marks) % places].mean() > RECURRING)
