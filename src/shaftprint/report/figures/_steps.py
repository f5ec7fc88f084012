"""Steps and the delay between set point and speed (thesis figure 3.3)."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.report.figures._style import (
    REFERENCE,
    house_style,
    legend_below,
    legend_entries,
    letter_panels,
    look,
    new_figure,
)
from shaftprint.report.notation import mathtext

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from shaftprint.signals import Signals, StepDelay

AROUND_S = 20.0
ZOOM_BEFORE_S, ZOOM_AFTER_S = 0.6, 1.8
# The middle of a step lies between the set points this long before and after it.
BESIDE_S = 0.5


def plot_step_delays(signals: "Signals", *, staircase: str | None = None) -> "Figure":
    """Return the steps of a staircase, one of them enlarged, and all delays: what figure 3.3 of the thesis shows.

    Parameters
    ----------
    signals
        The prepared recording, with the delay of each step.
    staircase
        Name of the staircase; the first by default.

    Raises
    ------
    ValueError
        If there is no step of that name.
    """
    steps = [s for s in signals.step_delays if staircase in (None, s.staircase)]
    steps = [s for s in steps if s.staircase == steps[0].staircase]
    if not steps:
        raise ValueError(f"step delays: expected steps of {staircase or 'a staircase'}, found none in the signals.")
    with house_style():
        figure = new_figure(11.5)
        panels = figure.subplot_mosaic([["overview", "overview"], ["zoom", "delays"]])
        overview, zoom, delays = panels["overview"], panels["zoom"], panels["delays"]
        begin, end = steps[0].set_point_time_s - AROUND_S, steps[-1].speed_time_s + AROUND_S
        _draw_signals(overview, signals, begin, end)
        shown = steps[0].set_point_time_s
        _draw_signals(zoom, signals, shown - ZOOM_BEFORE_S, shown + ZOOM_AFTER_S)
        _mark_crossings(zoom, signals, steps[0])
        _draw_delays(delays, steps)
        letter_panels(
            (overview, zoom, delays),
            (f"staircase {steps[0].staircase}", "first step, enlarged", "delay of each step"),
        )
        legend_below(figure, legend_entries((overview, zoom, delays)))
        return figure


def _draw_signals(axes: "Axes", signals: "Signals", begin_s: float, end_s: float) -> None:
    first = max(0, int((begin_s - signals.start_s) * signals.rate_hz))
    last = min(signals.samples, int((end_s - signals.start_s) * signals.rate_hz) + 1)
    time = signals.start_s + np.arange(first, last) / signals.rate_hz
    for values, name, style in (
        (signals.set_point_rev_s, "n_set", look(0)),
        (signals.engine_speed.speed_rev_s, "n", look(1)),
    ):
        axes.plot(
            time,
            _deviation(signals, values[first:last]),
            color=style.colour,
            linestyle=style.dashes,
            label=_label(name),
        )
    axes.set_xlim(time[0], time[-1])
    axes.set_xlabel("time in the recording [s]")
    axes.set_ylabel("deviation over\nworking point [-]")


def _label(name: str) -> str:
    return f"{mathtext(name)}, {'set point' if name == 'n_set' else 'engine speed'}"


def _deviation(signals: "Signals", speed_rev_s: FloatArray) -> FloatArray:
    return speed_rev_s / signals.working_point.engine_speed_rev_s - 1.0


def _mark_crossings(axes: "Axes", signals: "Signals", step: "StepDelay") -> None:
    """Draw where set point and speed cross the middle of the step, and the time between."""
    sides = (step.set_point_time_s + np.array([-BESIDE_S, BESIDE_S]) - signals.start_s) * signals.rate_hz
    level = float(_deviation(signals, signals.set_point_rev_s[sides.astype(np.intp)]).mean())
    for at in (step.set_point_time_s, step.speed_time_s):
        axes.axvline(at, color=REFERENCE, linewidth=0.8, linestyle=(0.0, (3.0, 2.0)))
    axes.annotate(
        "",
        xy=(step.speed_time_s, level),
        xytext=(step.set_point_time_s, level),
        arrowprops={"arrowstyle": "<->", "linewidth": 0.8, "shrinkA": 0.0, "shrinkB": 0.0},
    )
    axes.annotate(
        f"{step.delay_s:.3f} s",
        xy=(step.speed_time_s, level),
        xytext=(6.0, 0.0),
        textcoords="offset points",
        va="center",
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.0},
    )


def _draw_delays(axes: "Axes", steps: "list[StepDelay]") -> None:
    delay = np.array([step.delay_s for step in steps])
    rising = np.array([step.rising for step in steps])
    number = np.arange(1, delay.size + 1)
    for chosen, text, marker, fill in ((rising, "speed rises", "^", "black"), (~rising, "speed falls", "v", "white")):
        if chosen.any():
            axes.plot(
                number[chosen],
                delay[chosen],
                linestyle="none",
                marker=marker,
                color="black",
                markerfacecolor=fill,
                label=text,
            )
    axes.axhline(delay.mean(), color=REFERENCE, linewidth=1.0, label=f"mean {delay.mean():.3f} s")
    axes.set_xticks(number)
    axes.set_xlabel("step [-]")
    axes.set_ylabel("delay [s]")
    axes.set_ylim(0.0, 1.2 * float(delay.max()))
