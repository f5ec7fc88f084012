"""Points that fill a box evenly without chance."""

import numpy as np

from shaftprint.arrays import FloatArray


def spread(count: int, lower: FloatArray, upper: FloatArray) -> FloatArray:
    """Return points of an additive recurrence within bounds, shape (count, sizes).

    Coordinate ``j`` of point ``n`` is the fraction of ``1/2 + n g^-(j+1)`` with ``g^(d+1) = g + 1``, the generalisation
    of the golden ratio to ``d`` dimensions (Roberts, The unreasonable effectiveness of quasirandom sequences, 2018).

    ``count``: number of points. ``lower``, ``upper``: bounds, shape (sizes,).
    """
    size = lower.size
    ratio = 2.0
    for _ in range(60):
        ratio = (1.0 + ratio) ** (1.0 / (size + 1.0))
    steps = ratio ** -np.arange(1.0, size + 1.0)
    share = np.mod(0.5 + np.arange(1, count + 1)[:, None] * steps, 1.0)
    return np.asarray(lower + share * (upper - lower))
