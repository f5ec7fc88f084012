"""An explanation in words and tables, for the report and for the terminal."""

import math
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.digits import p_value_text, plain, rounded, with_deviation
from shaftprint.plain_table import Table, numbers, texts
from shaftprint.report.thesis._integral_gain import integral_gain_table, integral_gain_words

if TYPE_CHECKING:
    from shaftprint.report.thesis._explanation import Explanation, GainStep, LineStep

REJECTED_BELOW = 0.01


def explanation_sentences(explanation: "Explanation") -> tuple[str, ...]:
    """Return what the four tables say, one paragraph each."""
    return (
        _inertia_words(explanation),
        _damping_words(explanation),
        _gain_words(explanation),
        integral_gain_words(explanation.integral),
    )


def integral_table(explanation: "Explanation") -> Table:
    """Return the integral gain structure by structure, with the set point as it is and off."""
    return integral_gain_table(explanation.integral)


def inertia_table(explanation: "Explanation") -> Table:
    """Return the inertia time step by step."""
    return Table(
        title="The factor: the inertia time, one change a row",
        columns=(*texts("step"), *numbers("inertia time [s]", "calculated upstream over it"), *texts("what changed")),
        symbols=True,
        rows=tuple(
            (step.what, _with_std(step.value_s, step.std_s), plain(step.factor, 2), step.why)
            for step in explanation.inertia
        ),
    )


def damping_table(explanation: "Explanation") -> Table:
    """Return governor and engine line by line, without and with the inertia upstream of the gauge."""
    return Table(
        title="The damping: governor and engine from 0.5 to 12 rad/s",
        columns=(
            *texts("line"),
            *numbers("[rad/s]", "M_s / e measured", "governor and engine", "inertia", "product"),
            *numbers("n / n_set measured", "gauge-aware", "OL1+OL5"),
        ),
        symbols=True,
        rows=tuple(_damping_row(step) for step in explanation.lines),
        note=(
            "Magnitude and phase; of n / n_set the magnitude. Inertia: (tau_dn s + k_q) / ((tau_up + tau_dn) s + k_q - "
            "g), what the inertia upstream of the gauge takes from the torque before the gauge sees it. OL1+OL5: the "
            "sets that the thesis' way finds, put into one loop."
        ),
    )


def gain_table(explanation: "Explanation") -> Table:
    """Return the proportional gain structure by structure."""
    return Table(
        title="The drift: the proportional gain of each structure",
        columns=(
            *texts("structure"),
            *numbers("K_p, the thesis' way", "FitPercent", "K_p, weighted", "p-value"),
        ),
        symbols=True,
        rows=tuple(_gain_row(step) for step in explanation.gains),
        note="The p-value is the chance of data at least as far off if the structure held; below 0.01 it is rejected.",
    )


def _with_std(value: float, std: float) -> str:
    return rounded(value) if math.isnan(std) else with_deviation(value, std)


def _complex(value: complex) -> str:
    return f"{rounded(abs(value), 3)}, {plain(math.degrees(np.angle(value)), 0)}°"


def _damping_row(step: "LineStep") -> tuple[str, ...]:
    return (
        step.line,
        rounded(step.omega_rad_s, 3),
        _complex(step.measured),
        _complex(step.governor),
        _complex(step.inertia),
        _complex(step.governor * step.inertia),
        plain(step.speed, 2),
        plain(step.speed_gauge_aware, 2),
        plain(step.speed_thesis, 2),
    )


def _gain_row(step: "GainStep") -> tuple[str, ...]:
    return (
        step.structure,
        "–" if math.isnan(step.thesis) else rounded(step.thesis, 3),
        "–" if math.isnan(step.thesis_fit_percent) else plain(step.thesis_fit_percent, 1),
        with_deviation(step.weighted, step.weighted_std),
        p_value_text(step.p_value),
    )


def _inertia_words(explanation: "Explanation") -> str:
    upstream, downstream, thesis, sensed, _, ours = explanation.inertia
    return (
        f"The thesis' way finds {rounded(thesis.value_s, 3)} s where the torsional vibration calculation gives "
        f"{rounded(upstream.value_s, 4)} s upstream of the gauge, a factor {plain(thesis.factor, 2)}. They are two "
        f"bodies: n / M_s sees what lies downstream of the gauge, {rounded(downstream.value_s, 3)} s. The rest comes "
        f"from the pick-up, which is late: with it in the model the same signals give {rounded(sensed.value_s, 3)} s, "
        f"and speed without that delay gives {rounded(ours.value_s, 4)} s."
    )


def _damping_words(explanation: "Explanation") -> str:
    if not explanation.lines:
        return "No line was measured between 0.5 and 12 rad/s: nothing can be said of the damping there."
    deepest = min(explanation.lines, key=lambda step: np.angle(step.inertia))
    last = explanation.lines[-1]
    peak = max(explanation.lines, key=lambda step: step.speed)
    return (
        "Between 1 and 10 rad/s the inertia upstream of the gauge takes up torque before the gauge sees it: M_s / e is "
        f"turned by {plain(math.degrees(np.angle(deepest.inertia)), 0)}° at {deepest.line} and reduced to "
        f"{plain(100.0 * abs(last.inertia), 0)} % at {last.line}. Governor and delay alone cannot do that, so the "
        "thesis' structures need a lag with a damping of its own, and the loop seems to lack damping. At "
        f"{peak.line} n / n_set is {plain(peak.speed, 2)}; the gauge-aware structure says "
        f"{plain(peak.speed_gauge_aware, 2)}, OL1 and OL5 together say {plain(peak.speed_thesis, 2)}."
    )


def _gain_words(explanation: "Explanation") -> str:
    governors, gauge = explanation.gains[:-1], explanation.gains[-1]
    gains = [step.thesis for step in governors]
    percent = [step.thesis_fit_percent for step in governors]
    rejected = [step.structure for step in governors if step.p_value < REJECTED_BELOW]
    verdict = (
        f"Weighted by the noise {', '.join(rejected)} are rejected outright."
        if rejected
        else "Weighted by the noise none of them is rejected on this recording."
    )
    return (
        f"K_p goes from {plain(min(gains), 2)} to {plain(max(gains), 2)} while FitPercent stays between "
        f"{plain(min(percent), 1)} and {plain(max(percent), 1)} %: the two slowest lines hold "
        f"{plain(100.0 * explanation.share_of_two_lines, 0)} % of the squares, and K_p does nothing there. "
        f"{verdict} The gauge-aware structure finds K_p = {with_deviation(gauge.weighted, gauge.weighted_std)}; above "
        f"10 rad/s a structure without the upstream inertia sees {rounded(explanation.seen_gain, 2)} of it, "
        "v K_p tau_dn / (tau_up + tau_dn)."
    )
