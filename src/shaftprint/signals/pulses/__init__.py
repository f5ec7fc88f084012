"""Voltage to speed: edges, numbered pulses, reflection strips, and the slope of the angle."""

from shaftprint.signals.pulses._edges import PulseLevels, find_edges, pulse_levels, scan_edges
from shaftprint.signals.pulses._flat_top import expect_whole_crests
from shaftprint.signals.pulses._pulses import PulseTrain, number_pulses
from shaftprint.signals.pulses._speed import sample_slopes, solve_slopes, spline_speed
from shaftprint.signals.pulses._strips import find_strips, renumbered, revolutions, unplaced_stretches

__all__ = [
    "PulseLevels",
    "PulseTrain",
    "expect_whole_crests",
    "find_edges",
    "find_strips",
    "number_pulses",
    "pulse_levels",
    "renumbered",
    "revolutions",
    "sample_slopes",
    "scan_edges",
    "solve_slopes",
    "spline_speed",
    "unplaced_stretches",
]
