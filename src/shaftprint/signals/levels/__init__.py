"""Steady stretches, the wander about them, and what is read from their means: calibration and working point."""

from shaftprint.signals.levels._calibrate import calibrate, calibrate_through_wander
from shaftprint.signals.levels._dc_scale import (
    DcScale,
    LowLines,
    dc_scale,
    low_lines,
    scale_of_sines,
    zero_frequency_ratio,
)
from shaftprint.signals.levels._leg_periods import LegPeriods, leg_periods
from shaftprint.signals.levels._leg_state import LegSamples, calibration_of_legs, leg_state, stretch_of
from shaftprint.signals.levels._load import torque_of_mean_load
from shaftprint.signals.levels._repeated_periods import repeated_periods
from shaftprint.signals.levels._set_point_steadiness import expect_steady_set_point
from shaftprint.signals.levels._speed_scale import (
    ScaleDoubt,
    ScaleEvidence,
    asked_speed,
    evidence_between,
    load_over_expected,
    scale_doubt,
    scale_evidence,
)
from shaftprint.signals.levels._steadiness import expect_steady_gauge
from shaftprint.signals.levels._steady import SteadyStretch, steady_stretches
from shaftprint.signals.levels._wander import fit_through_wander
from shaftprint.signals.levels._working_point import (
    deviation,
    direction_words,
    expect_asked_speed,
    expect_plausible,
    expect_stated_slope,
    find_working_point,
    mean_of_stretches,
    stretches_at_working_point,
    working_point_of_test,
    working_voltage,
)

__all__ = [
    "DcScale",
    "LegPeriods",
    "LegSamples",
    "LowLines",
    "ScaleDoubt",
    "ScaleEvidence",
    "SteadyStretch",
    "asked_speed",
    "calibrate",
    "calibrate_through_wander",
    "calibration_of_legs",
    "dc_scale",
    "deviation",
    "direction_words",
    "evidence_between",
    "expect_asked_speed",
    "expect_plausible",
    "expect_stated_slope",
    "expect_steady_gauge",
    "expect_steady_set_point",
    "find_working_point",
    "fit_through_wander",
    "leg_periods",
    "leg_state",
    "load_over_expected",
    "low_lines",
    "mean_of_stretches",
    "repeated_periods",
    "scale_doubt",
    "scale_evidence",
    "scale_of_sines",
    "steady_stretches",
    "stretch_of",
    "stretches_at_working_point",
    "torque_of_mean_load",
    "working_point_of_test",
    "working_voltage",
    "zero_frequency_ratio",
]
