"""The staircase at the end of a planned test: as high as the limits let steps be.

Steps are what a model is held against that was fitted to lines, and what limits of governor and engine show on.
"""

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.design.motion._bound import Bound
from shaftprint.design.motion._motion import motion
from shaftprint.design.motion._stairs import stairs_spectrum
from shaftprint.design.planning._brief import Brief

# The limit of a rate is left to the control unit, which follows a step as fast as it does.
_OF_STEPS = "rate of the set point"
# Possible ships whose steps are looked at.
_MOST_SHIPS = 60


def stairs_of(brief: Brief, table: FloatArray) -> tuple[float, ...]:
    """Return the levels of the staircase about the level of the first leg [rpm]; none where the plan has none.

    ``brief``: timetable, and what binds the first leg. ``table``: possible ships for which limits are held, shape
    (rows, parameters).
    """
    shape, dwell_s = brief.timetable.stairs, brief.timetable.dwell_s
    if not shape:
        return ()
    bounds = tuple(bound for bound in brief.bounds[0] if bound.name != _OF_STEPS)
    largest = _largest_use(brief, bounds, table[:_MOST_SHIPS], np.array(shape), dwell_s)
    level_rpm = brief.speeds[0] * brief.limits.engine_speed_rpm
    return tuple(level_rpm * level / largest for level in shape)


def _largest_use(
    brief: Brief, bounds: tuple[Bound, ...], table: FloatArray, shape: FloatArray, dwell_s: float
) -> float:
    """Return the largest use of the bounds by a staircase of one, with as long a rest after it."""
    stairs = stairs_spectrum(shape, dwell_s)
    weights = np.array([bound.weights / bound.free for bound in bounds])
    responses = motion(brief.structures[0], table, stairs.omega_rad_s)
    return max(float(stairs.in_time(weights @ of_ship).max()) for of_ship in responses)
