"""Evidence of nonlinearity: harmonics against noise, steps over each other, torque against speed with its limit."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.normal import NORMAL_95
from shaftprint.report._style import (
    DATA,
    REFERENCE,
    house_style,
    legend_below,
    legend_entries,
    letter_panels,
    look,
    new_figure,
    plain_log_axis,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from shaftprint.nonlinearity import HarmonicEvidence, LimitEvidence, Nonlinearities, StepEvidence

_MOST_POINTS = 6000
_SHOWN_S = 6.0
_PERCENT = 100.0


def plot_nonlinearities(found: "Nonlinearities") -> "Figure":
    """Return harmonics of the torque, normalised steps up and down, and torque against speed with the limit.

    Parameters
    ----------
    found
        What the detector says.
    """
    with house_style():
        figure = new_figure(15.0)
        panels = figure.subplot_mosaic([["harmonics", "steps"], ["torque", "torque"]], height_ratios=[1.0, 1.1])
        _draw_harmonics(panels["harmonics"], found.harmonics)
        _draw_steps(panels["steps"], found.steps)
        _draw_torque(panels["torque"], found.limits)
        order = [panels["harmonics"], panels["steps"], panels["torque"]]
        letter_panels(
            order,
            ["Harmonics of the shaft torque", "Speed of each step, normalised", "Torque of the engine over speed"],
        )
        legend_below(figure, legend_entries(order))
    return figure


def _draw_harmonics(axes: "Axes", found: "HarmonicEvidence | None") -> None:
    axes.set_xlabel("frequency of the sine [Hz]")
    axes.set_ylabel("amplitude [% of $M_{s0}$]")
    if found is None:
        axes.text(0.5, 0.5, "no sines in this campaign", transform=axes.transAxes, ha="center")
        return
    for place, order in enumerate((2, 3)):
        style = look(place)
        amplitude, std = _PERCENT * found.amplitude[:, 1, place], _PERCENT * found.std[:, 1, place]
        axes.errorbar(
            found.frequency_hz,
            amplitude,
            yerr=NORMAL_95 * std,
            fmt=style.marker,
            color=style.colour,
            markersize=4.0,
            capsize=2.0,
            label=f"harmonic {order}, 95 %",
        )
        axes.plot(
            found.frequency_hz,
            _PERCENT * found.expected[:, 1, place],
            linestyle="none",
            marker="_",
            markersize=11.0,
            color=style.colour,
            label=f"harmonic {order} of a quadratic propeller",
        )
    plain_log_axis(axes)
    axes.set_ylim(bottom=0.0)


def _draw_steps(axes: "Axes", found: "StepEvidence") -> None:
    axes.set_xlabel("time since the jump [s]")
    axes.set_ylabel("change over that asked for")
    for rising, name, place in ((True, "up", 0), (False, "down", 1)):
        chosen = np.flatnonzero(found.rising == rising)
        style = look(place)
        for number, step in enumerate(chosen):
            label = f"steps {name}" if number == 0 else None
            axes.plot(
                found.time_s, found.speed[step], color=style.colour, linestyle=style.dashes, linewidth=0.8, label=label
            )
    if found.expected_speed.size:
        axes.plot(
            found.time_s,
            found.expected_speed.mean(axis=0),
            color=DATA,
            linewidth=1.6,
            label="mean step of a linear governor",
        )
    axes.axhline(1.0, color=REFERENCE, linewidth=0.6)
    axes.set_xlim(-1.0, _SHOWN_S)


def _draw_torque(axes: "Axes", found: "LimitEvidence") -> None:
    axes.set_xlabel("engine speed over $n_0$")
    axes.set_ylabel("torque over $M_{b0}$")
    every = max(found.cloud_speed.size // _MOST_POINTS, 1)
    axes.plot(
        1.0 + found.cloud_speed[::every],
        found.cloud_torque[::every],
        ".",
        markersize=1.0,
        color=REFERENCE,
        rasterized=True,
        label="all tests",
    )
    speed = np.linspace(0.5, 1.5, 50)
    axes.plot(speed, speed**2, color=look(2).colour, linestyle=look(2).dashes, label="quadratic propeller, steady")
    if found.curve_speed.size:
        shown = np.linspace(found.curve_speed[0], found.curve_speed[-1], 100)
        curve, std = (np.interp(shown, found.curve_speed, values) for values in (found.curve_torque, found.curve_std))
        axes.plot(1.0 + shown, curve, color=look(1).colour, label="limit found, 95 %")
        axes.fill_between(
            1.0 + shown, curve - NORMAL_95 * std, curve + NORMAL_95 * std, color=look(1).colour, alpha=0.25, linewidth=0
        )
    if found.speed.size:
        axes.errorbar(
            1.0 + found.speed,
            found.torque,
            yerr=NORMAL_95 * found.torque_std,
            fmt=look(0).marker,
            color=look(0).colour,
            markersize=4.0,
            capsize=2.0,
            label="stretches on a limit, 95 %",
        )
    span = found.cloud_speed
    axes.set_xlim(1.0 + span.min() - 0.05, 1.0 + span.max() + 0.05)
