"""A phase of many turns drawn between -270 and 90 degrees, where its numbers can be read."""

import numpy as np

from shaftprint.arrays import FloatArray

TURN_DEG = 360.0
HIGHEST_DEG = 90.0
WRAPPED_SPAN_DEG = (-285.0, 105.0)
# More than that on one axis cannot be read; up to it a line without jumps tells more.
MOST_DEG = 540.0


def reads_better_wrapped(limits_deg: tuple[float, float]) -> bool:
    """Return whether a phase axis of these ends [deg] shows more than a turn and a half."""
    return limits_deg[1] - limits_deg[0] > MOST_DEG


def wrapped(phase_deg: FloatArray) -> FloatArray:
    """Return phases [deg] less the whole turns that bring them into (-270, 90]."""
    return phase_deg - TURN_DEG * np.ceil((phase_deg - HIGHEST_DEG) / TURN_DEG)


def wrapped_line(phase_deg: FloatArray) -> FloatArray:
    """Return the same of a line, with a gap where it jumps by a turn."""
    turned = np.asarray(wrapped(phase_deg))
    jumps = np.flatnonzero(np.abs(np.diff(turned)) > 0.5 * TURN_DEG) + 1
    turned[jumps] = np.nan
    return turned
