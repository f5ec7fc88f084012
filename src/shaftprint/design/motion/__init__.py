"""What shaft and engine do when the set point moves, and the limits of the ship as bounds of that."""

from shaftprint.design.motion._bound import Bound
from shaftprint.design.motion._bounds import bounds_of_leg
from shaftprint.design.motion._gauge import gauge_bounds, share_cut_off
from shaftprint.design.motion._motion import SIGNALS, expect_motion, motion, motion_noise

__all__ = [
    "SIGNALS",
    "Bound",
    "bounds_of_leg",
    "expect_motion",
    "gauge_bounds",
    "motion",
    "motion_noise",
    "share_cut_off",
]
