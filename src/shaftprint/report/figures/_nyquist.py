"""The loop gain in the complex plane, with the margins to instability."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.models._margins import Margins, margins
from shaftprint.models._nyquist import loop_gain
from shaftprint.report.charts._chart import Chart, Panel, Scale
from shaftprint.report.charts._marks import Line, Mark, Points, Straight, Words

if TYPE_CHECKING:
    from shaftprint.report._curve import Curve

SPAN_RAD_S = (0.05, 500.0)
POINTS = 700
CIRCLE_POINTS = 181
WINDOW = (-2.2, 1.2)
NAMED_RAD_S = (1.0, 2.0, 5.0, 10.0, 20.0)


def nyquist_chart(curve: "Curve") -> Chart:
    """Return the Nyquist plot of a closed loop with gain margin, phase margin and the nearest distance to -1.

    Parameters
    ----------
    curve
        A closed-loop model.

    Raises
    ------
    StructureError
        If the structure has no feedback loop.
    """
    loop_margins = margins(curve.structure, curve.values)
    omega = np.geomspace(*SPAN_RAD_S, POINTS)
    gain = _loop(curve, omega)
    # beyond the window only a little, so that the line ends outside and no data are spent where nobody looks
    seen = (np.abs(gain.real) < -2.0 * WINDOW[0]) & (np.abs(gain.imag) < -2.0 * WINDOW[0])
    real, imaginary = np.where(seen, gain.real, np.nan), np.where(seen, gain.imag, np.nan)
    words = [f"{value:.3g} rad/s" for value in omega]
    marks: list[Mark] = [
        Straight(at=0.0, axis="x", shade="soft", dash="solid"),
        Straight(at=0.0, axis="y", shade="soft", dash="solid"),
        _circle("|L| = 1", 0.0, 1.0),
        *_margin_circle(loop_margins),
        Line(x=real, y=imaginary, name=f"loop gain L of {curve.label}", words=words),
        *_named(curve),
        Points(x=np.array([-1.0]), y=np.zeros(1), name="critical point −1", shade="ink", marker="plus", size=11.0),
        *_margin_points(curve, loop_margins),
    ]
    return Chart(
        panels=(
            Panel(
                marks=marks,
                x=Scale(title="real part of L [-]", span=WINDOW),
                y=Scale(title="imaginary part of L [-]", span=WINDOW),
            ),
        ),
        heights_px=(520,),
        square=True,
    )


def _loop(curve: "Curve", omega: FloatArray) -> ComplexArray:
    return loop_gain(curve.structure, curve.values, 1j * omega)


def _circle(name: str, centre: float, radius: float) -> Line:
    angle = np.linspace(0.0, 2.0 * np.pi, CIRCLE_POINTS)
    x, y = centre + radius * np.cos(angle), radius * np.sin(angle)
    return Line(x=x, y=y, name=name, shade="reference", dash="dot", width=1.5)


def _margin_circle(found: Margins) -> list[Mark]:
    if not np.isfinite(found.peak_sensitivity) or found.peak_sensitivity <= 0.0:
        return []
    nearest = 1.0 / found.peak_sensitivity
    x_y = _circle("", -1.0, nearest)
    name = f"nearest to −1: {nearest:.2f} at {found.peak_sensitivity_rad_s:.1f} rad/s"
    return [Line(x=x_y.x, y=x_y.y, name=name, shade=1, width=1.5)]


def _named(curve: "Curve") -> list[Mark]:
    """Return some frequencies on the curve, as far as they are in the window."""
    marks: list[Mark] = []
    for omega, place in zip(NAMED_RAD_S, _loop(curve, np.array(NAMED_RAD_S)), strict=True):
        if all(WINDOW[0] < part < WINDOW[1] for part in (place.real, place.imag)):
            x, y = np.array([place.real]), np.array([place.imag])
            marks.append(Points(x=x, y=y, shade=0, name="frequency [rad/s]"))
            marks.append(Words(x=place.real, y=place.imag, text=f"{omega:g}", anchor="left"))
    return marks


def _margin_points(curve: "Curve", found: Margins) -> list[Mark]:
    marks: list[Mark] = []
    if np.isfinite(found.gain_margin):
        name = f"gain margin {found.gain_margin:.2f} at {found.gain_margin_rad_s:.1f} rad/s"
        marks.append(Points(x=np.array([-1.0 / found.gain_margin]), y=np.zeros(1), name=name, shade=1, size=9.0))
    if np.isfinite(found.phase_margin_rad):
        (point,) = _loop(curve, np.array([found.phase_margin_rad_s]))
        name = f"phase margin {np.degrees(found.phase_margin_rad):.1f}° at {found.phase_margin_rad_s:.1f} rad/s"
        marks.append(Points(x=np.array([point.real]), y=np.array([point.imag]), name=name, shade=2, size=9.0))
    state = "stable" if found.stable else "UNSTABLE"
    nowhere = np.array([np.nan])
    name = f"delay margin {found.delay_margin_s:.3f} s, {state}"
    marks.append(Points(x=nowhere, y=nowhere, name=name, shade="soft", size=1.0))
    return marks
