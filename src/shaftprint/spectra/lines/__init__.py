"""Test lines: their windows, the fit of their sines, the noise beside them, what of ship or logger shows in them."""

from shaftprint.spectra.lines._bin_selection import ExactBin, HighestPeak
from shaftprint.spectra.lines._clock_check import channel_clock_reasons, clock_reasons, offsets_of_lines
from shaftprint.spectra.lines._cross_term import without_cross_term
from shaftprint.spectra.lines._harmonics import Harmonics, collect_harmonics
from shaftprint.spectra.lines._input_band import InputBand, band_of_lines, band_reasons, input_band
from shaftprint.spectra.lines._input_clock import drift_of_input, drift_of_phases
from shaftprint.spectra.lines._line_fit import LineFit, SineMethod, WindowSamples, cut_window, window_slice
from shaftprint.spectra.lines._line_measurement import LineMeasurement, measure_line, strongest_frequency_hz
from shaftprint.spectra.lines._load_drift import LoadDrift, load_drift
from shaftprint.spectra.lines._message_line import MessageLine, cut_messages
from shaftprint.spectra.lines._message_times import times_of_values
from shaftprint.spectra.lines._modulation import without_modulation
from shaftprint.spectra.lines._noise import (
    LineNoise,
    Neighbours,
    ShaftRelation,
    equivalent_samples,
    levelled,
    noise_from_neighbours,
    residual_spectrum,
)
from shaftprint.spectra.lines._set_point_check import (
    amplitude_remark,
    check_frequency_unit,
    check_set_point,
    shape_reasons,
)
from shaftprint.spectra.lines._signal_to_noise import LineVariances, SignalToNoise, signal_to_noise
from shaftprint.spectra.lines._sine_fit import WholePeriodSine
from shaftprint.spectra.lines._window_orders import left_in_remark, without_orders, words_at
from shaftprint.spectra.lines._windows import Window, plan_windows, whole_period_window

__all__ = [
    "ExactBin",
    "Harmonics",
    "HighestPeak",
    "InputBand",
    "LineFit",
    "LineMeasurement",
    "LineNoise",
    "LineVariances",
    "LoadDrift",
    "MessageLine",
    "Neighbours",
    "ShaftRelation",
    "SignalToNoise",
    "SineMethod",
    "WholePeriodSine",
    "Window",
    "WindowSamples",
    "amplitude_remark",
    "band_of_lines",
    "band_reasons",
    "channel_clock_reasons",
    "check_frequency_unit",
    "check_set_point",
    "clock_reasons",
    "collect_harmonics",
    "cut_messages",
    "cut_window",
    "drift_of_input",
    "drift_of_phases",
    "equivalent_samples",
    "input_band",
    "left_in_remark",
    "levelled",
    "load_drift",
    "measure_line",
    "noise_from_neighbours",
    "offsets_of_lines",
    "plan_windows",
    "residual_spectrum",
    "shape_reasons",
    "signal_to_noise",
    "strongest_frequency_hz",
    "times_of_values",
    "whole_period_window",
    "window_slice",
    "without_cross_term",
    "without_modulation",
    "without_orders",
    "words_at",
]
