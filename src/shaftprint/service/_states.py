"""What the ship was doing, second by second, as far as lever, speed and torque tell."""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray
from shaftprint.units import SECONDS_PER_MINUTE

if TYPE_CHECKING:
    from shaftprint.vessel._vessel import Vessel

STATES = ("standing", "clutch out", "idle", "ahead", "astern", "not told")
"""Words for what the ship was doing; ``not told`` where a channel is missing."""
STANDING, CLUTCH_OUT, IDLE, AHEAD, ASTERN, NOT_TOLD = range(len(STATES))
# An engine turns from this share of its idle speed on; it idles up to this share above.
_TURNS, _IDLES = 0.5, 1.05
# A propeller that turns takes more than this share of its torque at that speed.
_LEAST_TORQUE = 0.15


def idle_rpm(vessel: "Vessel") -> float:
    """Return the idle speed of the engine [rpm]; 0 where the vessel file does not state one."""
    engine = vessel.engine
    return 0.0 if engine is None or engine.idle_speed_rpm is None else engine.idle_speed_rpm


def state_of_seconds(speed_rev_s: FloatArray, torque_nm: FloatArray, vessel: "Vessel") -> NDArray[np.int8]:
    """Return what the ship was doing in each second, as places in ``STATES``.

    ``speed_rev_s``, ``torque_nm``: mean engine speed [rev/s] and mean driving torque [N m] of each second, shape
    (seconds,); not a number where a channel is missing. ``vessel``: idle speed and working point.
    """
    idle = idle_rpm(vessel) / SECONDS_PER_MINUTE
    point = vessel.working_point
    square = point.driving_torque_nm * (speed_rev_s * SECONDS_PER_MINUTE / point.engine_speed_rpm) ** 2
    with np.errstate(invalid="ignore"):
        state = np.full(speed_rev_s.size, AHEAD, dtype=np.int8)
        state[speed_rev_s <= _IDLES * idle] = IDLE
        state[torque_nm < -_LEAST_TORQUE * square] = ASTERN
        state[np.abs(torque_nm) <= _LEAST_TORQUE * square] = CLUTCH_OUT
        state[speed_rev_s < (_TURNS * idle or 0.05 * point.engine_speed_rpm / SECONDS_PER_MINUTE)] = STANDING
        state[~np.isfinite(speed_rev_s + torque_nm)] = NOT_TOLD
    return state


def state_of(states: NDArray[np.int8]) -> str:
    """Return what the ship was doing in some seconds, in words: the one state, or that it changed."""
    kinds = [STATES[k] for k in np.unique(states)]
    return kinds[0] if len(kinds) == 1 else " and ".join(kinds)
