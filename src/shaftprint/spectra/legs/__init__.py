"""Legs: whole periods of many lines at once, cut to the clock that really drove them, and what each line tells."""

from shaftprint.spectra.legs._leg_check import LegFinding, check_leg, leg_clock_reasons, leg_shape_reasons
from shaftprint.spectra.legs._leg_lines import LegLines, leg_freedom, measure_leg
from shaftprint.spectra.legs._leg_window import LegWindow, cut_leg

__all__ = [
    "LegFinding",
    "LegLines",
    "LegWindow",
    "check_leg",
    "cut_leg",
    "leg_clock_reasons",
    "leg_freedom",
    "leg_shape_reasons",
    "measure_leg",
]
