"""Angles that begin again after a turn, as an encoder counts them: 359 deg and then 1."""

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.units import unit_factor

# An angle begins again where it steps by more than half a turn, and nearer to half a turn its sense would be a guess.
HALF, SURE = 0.5, 0.4
# The range may be larger than a turn by this share: noise, rounding.
ROUNDING = 1e-3


def turn_of(unit: str) -> float | None:
    """Return what one turn is in a unit; None where it is none of an angle."""
    return unit_factor("rev", unit)


def unwrapped(values: FloatArray, turn: float) -> FloatArray | None:
    """Return an angle that goes on from turn to turn; None where it does so already.

    ``values``: the angle; what is no number stays so, shape (samples,). ``turn``: one turn in its unit.
    """
    finite = np.isfinite(values)
    angle = values[finite]
    steps = np.diff(angle)
    again = np.abs(steps) > HALF * turn
    if not again.any() or np.ptp(angle) > (1.0 + ROUNDING) * turn:
        return None
    small = steps - turn * np.rint(steps / turn)
    if np.abs(small).max() > SURE * turn:
        return None
    whole = values.astype(np.float64)
    whole[finite] = angle[0] + np.concatenate([[0.0], np.cumsum(small)])
    return whole
