"""What a plan is made from: the ship as it is assumed, what it allows, what is wished for, and volts to speed."""

from shaftprint.design.inputs._assumed_ship import AssumedShip, assumed_ship, ship_of_fit
from shaftprint.design.inputs._gauge_range import FULL_SCALE, GaugeRange
from shaftprint.design.inputs._knowledge import Knowledge
from shaftprint.design.inputs._known_ship import (
    limits_of_fingerprint,
    possible_ship,
    ship_before_test,
    ship_of_fingerprint,
)
from shaftprint.design.inputs._limits import NO_MOTORING, SPEED_SIGMAS, Curve, Limits, limits_from_vessel, usual_speeds
from shaftprint.design.inputs._set_point_line import SetPointLine, line_of_fingerprint
from shaftprint.design.inputs._wish import Wish, no_worse_than, numbers_of_line

__all__ = [
    "FULL_SCALE",
    "NO_MOTORING",
    "SPEED_SIGMAS",
    "AssumedShip",
    "Curve",
    "GaugeRange",
    "Knowledge",
    "Limits",
    "SetPointLine",
    "Wish",
    "assumed_ship",
    "limits_from_vessel",
    "limits_of_fingerprint",
    "line_of_fingerprint",
    "no_worse_than",
    "numbers_of_line",
    "possible_ship",
    "ship_before_test",
    "ship_of_fingerprint",
    "ship_of_fit",
    "usual_speeds",
]
