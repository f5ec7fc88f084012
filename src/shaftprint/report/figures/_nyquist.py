"""The loop gain in the complex plane, with the margins to instability."""

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.patches import Circle

from shaftprint.arrays import ComplexArray
from shaftprint.models import Margins, loop_gain, margins
from shaftprint.report.figures._style import REFERENCE, house_style, look, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from shaftprint.report._curve import Curve

SPAN_RAD_S = (0.05, 500.0)
POINTS = 4000
WINDOW = ((-2.2, 1.2), (-2.2, 1.2))
NAMED_RAD_S = (1.0, 2.0, 5.0, 10.0, 20.0)


def plot_nyquist(curve: "Curve") -> "Figure":
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

    def loop(omega: float) -> complex:
        return complex(loop_gain(curve.structure, curve.values, np.array([1j * omega]))[0])

    omega = np.geomspace(*SPAN_RAD_S, POINTS)
    gain = loop_gain(curve.structure, curve.values, 1j * omega)
    with house_style():
        figure = new_figure(9.5)
        axes = figure.subplots()
        axes.set_aspect("equal")
        axes.set_xlim(*WINDOW[0])
        axes.set_ylim(*WINDOW[1])
        _draw_circles(axes, loop_margins)
        axes.plot(gain.real, gain.imag, color=look(0).colour, label=f"loop gain L of {curve.label}")
        _name_frequencies(axes, np.array([loop(value) for value in NAMED_RAD_S]))
        axes.plot(-1.0, 0.0, marker="+", markersize=9.0, color="black", linestyle="none", label="critical point −1")
        _mark_margins(axes, loop_margins, loop)
        axes.set_xlabel("real part of L [-]")
        axes.set_ylabel("imaginary part of L [-]")
        axes.legend(loc="center left", bbox_to_anchor=(1.03, 0.5), borderaxespad=0.0)
        return figure


def _draw_circles(axes: "Axes", found: Margins) -> None:
    axes.axhline(0.0, color="black", linewidth=0.5)
    axes.axvline(0.0, color="black", linewidth=0.5)
    for centre, radius, dashes, text in (
        ((0.0, 0.0), 1.0, (0.0, (1.0, 1.5)), "|L| = 1"),
        (
            (-1.0, 0.0),
            1.0 / found.peak_sensitivity,
            (0.0, (4.0, 2.0)),
            f"nearest to −1: {1.0 / found.peak_sensitivity:.2f}\nat {found.peak_sensitivity_rad_s:.1f} rad/s",
        ),
    ):
        axes.add_patch(
            Circle(centre, radius, fill=False, edgecolor=REFERENCE, linewidth=0.9, linestyle=dashes, label=text)
        )


def _name_frequencies(axes: "Axes", places: ComplexArray) -> None:
    """Mark some frequencies on the curve, as far as they are in the window."""
    (real_low, real_high), (low, high) = WINDOW
    inside = (places.real > real_low) & (places.real < real_high) & (places.imag > low) & (places.imag < high)
    for value, point in zip(np.array(NAMED_RAD_S)[inside], places[inside], strict=True):
        axes.annotate(
            f"{value:g}",
            xy=(point.real, point.imag),
            xytext=(-5.0, 0.0),
            textcoords="offset points",
            ha="right",
            va="center",
        )
    axes.plot(
        places[inside].real,
        places[inside].imag,
        linestyle="none",
        marker="o",
        markersize=3.5,
        color=look(0).colour,
        label="frequency [rad/s]",
    )


def _mark_margins(axes: "Axes", found: Margins, loop: Callable[[float], complex]) -> None:
    if np.isfinite(found.gain_margin):
        at = -1.0 / found.gain_margin
        axes.plot(
            at,
            0.0,
            marker="s",
            markersize=5.5,
            color=look(1).colour,
            linestyle="none",
            label=f"gain margin {found.gain_margin:.2f}\nat {found.gain_margin_rad_s:.1f} rad/s",
        )
    if np.isfinite(found.phase_margin_rad):
        point = loop(found.phase_margin_rad_s)
        axes.plot(
            point.real,
            point.imag,
            marker="^",
            markersize=6.0,
            color=look(2).colour,
            linestyle="none",
            label=f"phase margin {np.degrees(found.phase_margin_rad):.1f}°\nat {found.phase_margin_rad_s:.1f} rad/s",
        )
    axes.plot(
        [],
        [],
        linestyle="none",
        label=f"delay margin {found.delay_margin_s:.3f} s\n{'stable' if found.stable else 'UNSTABLE'}",
    )
