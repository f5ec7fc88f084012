"""Linear least squares with bounds, for many problems at once.

The solution of ``min |y - X^T b|`` within a box is found by an active set: unknowns that leave the box are put on their
bound, and one whose slope points back inside is let go. In the first passes all wrong ones change together; after that
only the first of them, which cannot run in a circle (Murty, Note on a Bard-type scheme for solving the complementarity
problem, 1974).
"""

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray

PASSES = 200
SINGLE_AFTER = 4
# Share of a column's own square that keeps the system solvable where columns say the same.
RIDGE = 1e-14
# Slopes below this share of a column's size are rounding.
ROUNDING = 1e-12


def bounded_least_squares(columns: FloatArray, aim: FloatArray, lower: FloatArray, upper: FloatArray) -> FloatArray:
    """Return the best unknowns of every problem, shape (problems, unknowns).

    ``columns``: ``X``, shape (problems, unknowns, rows). ``aim``: ``y``, shape (problems, rows). ``lower``, ``upper``:
    bounds, shape (unknowns,).
    """
    scale = np.linalg.norm(columns, axis=2)
    scale[scale == 0.0] = 1.0
    scaled = columns / scale[:, :, None]
    matrix = scaled @ scaled.swapaxes(1, 2) + RIDGE * np.eye(lower.size)
    right = (scaled @ aim[:, :, None])[:, :, 0]
    low, high = lower * scale, upper * scale
    slack = ROUNDING * np.linalg.norm(aim, axis=1)[:, None]
    at_low = np.zeros(right.shape, dtype=np.bool_)
    at_high = at_low.copy()
    for count in range(PASSES):
        solution = _beside(matrix, right, np.where(at_low, low, high), at_low | at_high)
        slope = (matrix @ solution[:, :, None])[:, :, 0] - right
        below, above = ~at_low & (solution < low), ~at_high & (solution > high)
        back = (at_low & (slope < -slack)) | (at_high & (slope > slack))
        change = below | above | back
        if not change.any():
            break
        if count >= SINGLE_AFTER:
            change &= np.cumsum(change, axis=1) == 1
        at_low, at_high = (at_low & ~change) | (below & change), (at_high & ~change) | (above & change)
    inside = np.clip(solution / scale, lower, upper)
    return np.where(at_low, lower, np.where(at_high, upper, inside))


def _beside(matrix: FloatArray, right: FloatArray, bound: FloatArray, held: BoolArray) -> FloatArray:
    """Return the best unknowns of every problem with some of them held on a bound."""
    put = np.where(held, bound, 0.0)
    reduced = np.where(held, put, right - (matrix @ put[:, :, None])[:, :, 0])
    system = np.where(held[:, :, None] | held[:, None, :], 0.0, matrix)
    rows, size, _ = system.shape
    system.reshape(rows, -1)[:, :: size + 1][held] = 1.0
    return np.asarray(np.linalg.solve(system, reduced[:, :, None])[:, :, 0])
