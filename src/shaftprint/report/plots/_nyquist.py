"""Interactive Nyquist plot: loop gain with exact delays, unit circle, margin circle, margins."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.models import Margins, loop_gain, margins
from shaftprint.report.plots._panels import Grid
from shaftprint.report.plots._plot import Json, Plot
from shaftprint.report.plots._traces import line, points, straight
from shaftprint.report.plots._words import label_text

if TYPE_CHECKING:
    from shaftprint.report._curve import Curve

SPAN_RAD_S = (0.05, 500.0)
POINTS = 700
CIRCLE_POINTS = 181
WINDOW = (-2.2, 1.2)
NAMED_RAD_S = (1.0, 2.0, 5.0, 10.0, 20.0)


def nyquist_plot(curve: "Curve") -> Plot:
    """Return the Nyquist plot of a closed loop with unit circle, margin circle about -1, and the margins.

    Raises
    ------
    StructureError
        If the structure has no feedback loop.
    """
    loop_margins = margins(curve.structure, curve.values)
    grid = Grid(x_titles=["real part of L [-]"], y_titles=["imaginary part of L [-]"], below_px=120)
    axes = grid.place(0, 0)
    omega = np.geomspace(*SPAN_RAD_S, POINTS)
    gain = _loop(curve, omega)
    gain_line = line(gain.real, gain.imag, f"loop gain L of {label_text(curve.label)}", 0, axes)
    gain_line |= {"text": [f"{value:.3g} rad/s" for value in omega], "hovertemplate": "%{text}<br>%{x:.3f}, %{y:.3f}j"}
    layout = grid.layout()
    layout["xaxis"] |= {"range": list(WINDOW), "constrain": "domain"}
    layout["yaxis"] |= {"range": list(WINDOW), "scaleanchor": "x", "scaleratio": 1}
    named = _loop(curve, np.array(NAMED_RAD_S))
    traces = [
        _circle("|L| = 1", axes, 0.0, 1.0),
        *_margin_circle(loop_margins, axes),
        gain_line,
        _named(named, axes),
        points([-1.0], [0.0], "critical point −1", axes, shade="@ink", marker="cross-thin", filled=False),
        *_marks(curve, loop_margins, axes),
    ]
    return Plot(traces=traces, layout=layout, height_px=680)


def _loop(curve: "Curve", omega: FloatArray) -> ComplexArray:
    return loop_gain(curve.structure, curve.values, 1j * omega)


def _circle(name: str, axes: Json, centre: float, radius: float) -> Json:
    angle = np.linspace(0.0, 2.0 * np.pi, CIRCLE_POINTS)
    return straight(name, axes, centre + radius * np.cos(angle), radius * np.sin(angle))


def _margin_circle(found: Margins, axes: Json) -> list[Json]:
    if not np.isfinite(found.peak_sensitivity) or found.peak_sensitivity <= 0.0:
        return []
    nearest = 1.0 / found.peak_sensitivity
    text = f"nearest to −1: {nearest:.2f} at {found.peak_sensitivity_rad_s:.1f} rad/s"
    circle = _circle(text, axes, -1.0, nearest)
    circle["line"] = circle["line"] | {"color": "@1", "dash": "dash"}
    return [circle]


def _named(places: ComplexArray, axes: Json) -> Json:
    trace = points(places.real, places.imag, "frequency [rad/s]", axes, shade="@0")
    words = [f"{value:g}" for value in NAMED_RAD_S]
    return trace | {"mode": "markers+text", "text": words, "textposition": "middle left"}


def _marks(curve: "Curve", found: Margins, axes: Json) -> list[Json]:
    marks: list[Json] = []
    if np.isfinite(found.gain_margin):
        text = f"gain margin {found.gain_margin:.2f} at {found.gain_margin_rad_s:.1f} rad/s"
        marks.append(points([-1.0 / found.gain_margin], [0.0], text, axes, shade="@1", marker="square"))
    if np.isfinite(found.phase_margin_rad):
        (point,) = _loop(curve, np.array([found.phase_margin_rad_s]))
        degrees = np.degrees(found.phase_margin_rad)
        text = f"phase margin {degrees:.1f}° at {found.phase_margin_rad_s:.1f} rad/s"
        marks.append(points([point.real], [point.imag], text, axes, shade="@2", marker="triangle-up"))
    state = "stable" if found.stable else "UNSTABLE"
    marks.append(
        points([None], [None], f"delay margin {found.delay_margin_s:.3f} s, {state}", axes)  # type: ignore[list-item]
        | {"marker": {"color": "@paper", "size": 1}}
    )
    return marks
