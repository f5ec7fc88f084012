"""Ends of the upright axes of a Bode diagram: around the models and the bulk of the points, not around a stray one."""

from collections.abc import Sequence

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray
from shaftprint.report.charts._marks import Mark, Marker, Points, Words

# So far from the models, or from the lines beside it, a point is stray: a factor of 6, a quarter of a turn.
FAR_DB = 15.0
FAR_DEG = 90.0
# Where more of the points that are known well are far from the models, the models are wrong, not the points.
STRAY_SHARE = 0.2
ROOM = 0.06


def axis_span(points: Sequence[FloatArray], lines: Sequence[FloatArray], far: float) -> tuple[float, float]:
    """Return the ends of an axis: all points of the bulk, and models as far as they are not far from them.

    ``points``: values of the bulk of each response. ``lines``: values of each model. ``far``: how far models may leave
    the points.
    """
    measured = np.concatenate([*points, np.empty(0)])
    drawn = np.concatenate([*lines, np.empty(0)])
    drawn = drawn[np.isfinite(drawn)]
    if measured.size:
        drawn = np.clip(drawn, measured.min() - far, measured.max() + far)
    drawn = np.concatenate([drawn, measured])
    room = ROOM * max(float(np.ptp(drawn)), 1.0)
    return float(drawn.min()) - room, float(drawn.max()) + room


def bulk_of(values: FloatArray, half: FloatArray, used: BoolArray, expected: FloatArray, far: float) -> BoolArray:
    """Return which points set the range of an axis: those that are well known, but for few stray ones.

    Points that are not well known do where they are near what is expected, and all do where no other is left.
    ``values``: values of the points, shape (lines,). ``half``: half lengths of their intervals, shape (lines,).
    ``used``: which lines are used, shape (lines,). ``expected``: what each model, or the lines beside, let expect
    there, shape (expectations, lines). ``far``: how far from all that is expected a point is stray, and beyond which
    half length it is not well known.
    """
    known = used & (half < far)
    is_far = np.abs(values - expected).min(axis=0) > far
    few = np.count_nonzero(known & is_far) <= STRAY_SHARE * np.count_nonzero(known)
    chosen = np.where(known, ~is_far | (not few), ~is_far)
    return np.asarray(chosen if chosen.any() else np.full(values.size, True))


def beside(at: FloatArray, values: FloatArray, known: BoolArray) -> FloatArray:
    """Return what the lines beside each let expect of it: their values, and the lines through two at one side.

    ``at``: places of the lines, in their order, shape (lines,). ``values``, ``known``: as of ``bulk_of``. Shape (6,
    lines); a line without such neighbours is expected where it is.
    """
    places = np.flatnonzero(known)
    expected = np.full((6, values.size), np.inf)
    for place in range(values.size):
        sides = places[places < place][:-3:-1], places[places > place][:2]
        for number, side in enumerate(sides):
            expected[3 * number : 3 * number + side.size, place] = values[side]
            if side.size == 2:
                near, further = side
                slope = (values[near] - values[further]) / (at[near] - at[further])
                expected[3 * number + 2, place] = values[near] + slope * (at[place] - at[near])
    return np.where(np.isinf(expected).all(axis=0), values, expected)


def beyond_marks(points: Sequence[Points], span: tuple[float, float], across: tuple[float, float]) -> list[Mark]:
    """Return what says how many points lie beyond an axis: triangles at its ends, and their number.

    ``points``: all that are drawn. ``span``: ends of the axis. ``across``: ends of the horizontal one.
    """
    marks: list[Mark] = []
    x = np.concatenate([np.empty(0), *(mark.x for mark in points)])
    values = np.concatenate([np.empty(0), *(mark.y for mark in points)])
    seen = (x >= across[0]) & (x <= across[1])
    inset = ROOM * (span[1] - span[0])
    ends: tuple[tuple[BoolArray, float, Marker, str], ...] = (
        (values > span[1], span[1] - inset, "triangle-up", "above"),
        (values < span[0], span[0] + inset, "triangle-down", "below"),
    )
    for beyond, at, marker, word in ends:
        stray = x[beyond & seen]
        if not stray.size:
            continue
        level = np.full(stray.size, at)
        marks.append(Points(x=stray, y=level, name="beyond the axis", shade=1, marker=marker, filled=False))
        text = f"{stray.size} point{'s' if stray.size > 1 else ''} {word}"
        # on the side with more room
        left, right = float(stray.min()), float(stray.max())
        if left / across[0] > across[1] / right:
            marks.append(Words(x=left, y=at, text=text, anchor="left"))
        else:
            marks.append(Words(x=right, y=at, text=text, anchor="right"))
    return marks
