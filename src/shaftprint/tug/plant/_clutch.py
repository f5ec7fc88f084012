"""A clutch that is taken out: the engine idles on, behind it the shaft runs down and stands.

The physics of the line has no clutch. With the lever on idle the engine turns as fast without a propeller as with it,
so that what the gauge and a pick-up of the shaft show is all that changes: both fade in the time in which a propeller
brakes its own inertia, and come back in that in which a clutch grips.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.tug.plant._voyage import Stretch

# Time in which the shaft runs down, and in which the clutch grips [s].
_RUNS_DOWN_S, _GRIPS_S = 0.5, 0.2


def declutched(stretch: Stretch, out_s: Sequence[tuple[float, float]]) -> Stretch:
    """Return what happens in a stretch of a voyage in which the clutch is out from one time to another [s]."""
    share = np.ones(stretch.time_s.size)
    for first_s, last_s in out_s:
        if stretch.time_s[0] < last_s + 50.0 * _GRIPS_S and first_s <= stretch.time_s[-1]:
            share *= _engaged(stretch.time_s, first_s, last_s)
    if np.all(share == 1.0):
        return stretch
    return replace(
        stretch, shaft_torque_nm=share * stretch.shaft_torque_nm, shaft_speed_rev_s=share * stretch.shaft_speed_rev_s
    )


def _engaged(time_s: FloatArray, first_s: float, last_s: float) -> FloatArray:
    """Return what of torque and speed the shaft has."""
    left = np.exp(-np.maximum(time_s - first_s, 0.0) / _RUNS_DOWN_S)
    at_end = np.exp(-(last_s - first_s) / _RUNS_DOWN_S)
    back = 1.0 - (1.0 - at_end) * np.exp(-np.maximum(time_s - last_s, 0.0) / _GRIPS_S)
    return np.asarray(np.where(time_s < last_s, left, back))
