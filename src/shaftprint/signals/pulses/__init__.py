"""Voltage to speed: edges, numbered pulses, reflection strips, and the slope of the angle."""

from shaftprint.signals.pulses._edges import PulseLevels, find_edges, pulse_levels, scan_edges
from shaftprint.signals.pulses._flat_top import expect_whole_crests
from shaftprint.signals.pulses._pulses import PulseTrain, number_pulses
from shaftprint.signals.pulses._speed import sample_slopes, solve_slopes, spline_speed, spline_speeds
from shaftprint.signals.pulses._strips import find_strips, renumbered, revolutions, steady_turns, unplaced_stretches
from shaftprint.signals.pulses._teeth import number_teeth

__all__ = [
    "PulseLevels",
    "PulseTrain",
    "expect_whole_crests",
    "find_edges",
    "find_strips",
    "number_pulses",
    "number_teeth",
    "pulse_levels",
    "renumbered",
    "revolutions",
    "sample_slopes",
    "scan_edges",
    "solve_slopes",
    "spline_speed",
    "spline_speeds",
    "steady_turns",
    "unplaced_stretches",
]
