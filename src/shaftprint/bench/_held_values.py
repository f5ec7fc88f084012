"""For how many samples an output keeps each value: a slow instrument in the table of a fast logger.

Such an output is a staircase whose steps come late by half their length on average. A structure takes that for a lag
or a delay, and its noise, the same for many samples, for one of long memory.
"""

import numpy as np

from shaftprint.arrays import FloatArray

# Fewer changes do not tell how long a value is kept; so many of the shortest distances may be chance.
FEWEST_CHANGES, BY_CHANCE = 20, 0.05
# A change of more than so many of the smallest steps is no single one.
MORE = 1.5
# Differences of two values below this share of their range are rounding.
ROUNDING = 1e-9


def kept_for(values: FloatArray) -> float:
    """Return for how many samples each value is kept, on average; 1 where neighbours are values of their own.

    A coarse reading stands still for long by itself and then changes by its smallest step. What changes by more has
    moved on for as long as it was kept, so that only such changes count.

    ``values``: the samples, shape (samples,).
    """
    changes = np.diff(values)
    moved = np.abs(changes) > ROUNDING * np.ptp(values)
    places = np.flatnonzero(moved)
    if places.size < FEWEST_CHANGES:
        return 1.0
    smallest = float(np.abs(changes[places]).min())
    distances = np.diff(places)[np.abs(changes[places[1:]]) > MORE * smallest]
    if distances.size < FEWEST_CHANGES:
        return 1.0
    shortest = float(np.quantile(distances, BY_CHANCE, method="lower"))
    near = distances[distances <= shortest + 1.0]
    return float(near.mean()) if shortest > 1.0 else 1.0
