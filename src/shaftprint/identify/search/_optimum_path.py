"""The way from one optimum to another: along a valley, or over a ridge."""

import numpy as np

from shaftprint.arrays import FloatArray, IntArray
from shaftprint.identify.likelihood._objective import Objective
from shaftprint.identify.search._levenberg_marquardt import descend

# Places on the way at which the cost is looked at.
STATIONS = 9
# How much stiffer a station is held at its share of the way than the cost would move it.
STIFFNESS = 1e4
# Widest a station may stray, as a share of the way.
LARGEST_STRAY = 0.01
TOLERANCE, ITERATIONS = 1e-6, 60


def highest_between(objective: Objective, one: FloatArray, others: FloatArray) -> FloatArray:
    """Return the highest cost on the way from one optimum to each of others, shape (others,).

    At each station between them the share of the way is held and everything across it is at its best, so that a curved
    valley is followed.

    ``objective``: the problem. ``one``, ``others``: free parameters, shape (free,) and (others, free).
    """
    width = objective.upper - objective.lower
    way = (others - one) / width
    length = np.linalg.norm(way, axis=1)
    direction = np.repeat(way / length[:, None] ** 2 / width, STATIONS, axis=0)
    share = np.tile(np.arange(1, STATIONS + 1) / (STATIONS + 1.0), others.shape[0])
    start = one + share[:, None] * np.repeat(others - one, STATIONS, axis=0)
    _, slopes = objective.residuals(start)
    along = np.linalg.norm(np.einsum("sr,srn->sn", np.repeat(others - one, STATIONS, axis=0), slopes), axis=1)
    stray = np.minimum(1.0 / (np.sqrt(STIFFNESS) * np.maximum(along, 1e-300)), LARGEST_STRAY)

    def residuals(theta: FloatArray, rows: IntArray) -> tuple[FloatArray, FloatArray]:
        r, jacobian = objective.residuals(theta)
        hold = (np.vecdot(direction[rows], theta - one) - share[rows]) / stray[rows]
        slope = direction[rows] / stray[rows, None]
        return np.concatenate([r, hold[:, None]], axis=1), np.concatenate([jacobian, slope[:, :, None]], axis=2)

    path = descend(
        residuals, start, objective.lower, objective.upper, tolerance=TOLERANCE, max_iterations=ITERATIONS
    ).theta
    r, _ = objective.residuals(path)
    return np.asarray((0.5 * np.vecdot(r, r)).reshape(-1, STATIONS).max(axis=1))
