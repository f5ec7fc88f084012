"""The limits of a line: torque of the engine over speed, and the hardest seconds of the test in time."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray
from shaftprint.catalogue import AHEAD_S, GovernorSymbol
from shaftprint.distributions import NORMAL_95
from shaftprint.report.figures._style import (
    DATA,
    REFERENCE,
    house_style,
    legend_below,
    legend_entries,
    letter_panels,
    look,
    new_figure,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from shaftprint.limits import LimitFit

SHOWN_S = 12.0
LEVEL = GovernorSymbol.TORQUE_LIMIT


def plot_limits(limits: "LimitFit") -> "Figure":
    """Return measured and predicted torque of the engine: over speed with its limit, and where it moves most.

    Parameters
    ----------
    limits
        What ``identify_limits`` returns.
    """
    with house_style():
        figure = new_figure(14.0)
        panels = figure.subplot_mosaic([["speed"], ["time"]], height_ratios=[1.2, 1.0])
        _draw_over_speed(panels["speed"], limits)
        _draw_over_time(panels["time"], limits)
        order = [panels["speed"], panels["time"]]
        letter_panels(order, ["Torque of the engine over speed", "The same over the load, where it moves most"])
        legend_below(figure, legend_entries(order))
    return figure


def _draw_over_speed(axes: "Axes", limits: "LimitFit") -> None:
    part = limits.predicted
    time, used = part.record.time_s, part.record.used
    # speed and full-load curve are given early
    speed, curve = (np.interp(time - AHEAD_S, time, part.record.inputs[name]) for name in ("n", "c"))
    for values, label, colour in (
        (part.record.outputs["y"], "measured", REFERENCE),
        (part.predicted, "predicted", look(0).colour),
    ):
        torque = (1.0 + values) * (1.0 + speed) ** 2
        axes.plot(1.0 + speed[used], torque[used], ".", markersize=1.5, color=colour, rasterized=True, label=label)
    level = next((number for number in limits.numbers if number.name == LEVEL), None)
    if level is not None:
        order = np.argsort(speed[used])
        shown, shape = 1.0 + speed[used][order], 1.0 + curve[used][order]
        colour = look(1).colour
        axes.plot(shown, level.value * shape, color=colour, label="torque limit, 95 %")
        if np.isfinite([level.lower, level.upper]).all():
            axes.fill_between(shown, level.lower * shape, level.upper * shape, color=colour, alpha=0.25, linewidth=0)
    axes.set_xlabel("engine speed over that of the working point")
    axes.set_ylabel("torque over that of the working point")


def _draw_over_time(axes: "Axes", limits: "LimitFit") -> None:
    part = limits.predicted
    time, used, measured = part.record.time_s, part.record.used, part.record.outputs["y"]
    begin = _hardest(part.predicted, used, round(SHOWN_S * part.record.rate_hz))
    shown = slice(begin, begin + round(SHOWN_S * part.record.rate_hz))
    std = NORMAL_95 * float(np.std((measured - part.predicted)[used]))
    axes.plot(time[shown], measured[shown], color=DATA, linewidth=0.9, label="measured")
    colour = look(0).colour
    axes.plot(time[shown], part.predicted[shown], color=colour, label="predicted, 95 % of the noise")
    axes.fill_between(
        time[shown], part.predicted[shown] - std, part.predicted[shown] + std, color=colour, alpha=0.2, linewidth=0
    )
    axes.set_xlabel("time [s]")
    axes.set_ylabel("torque over load, deviation")


def _hardest(predicted: FloatArray, used: BoolArray, count: int) -> int:
    """Return where the stretch of so many samples begins in which the prediction changes most."""
    change = np.append(np.abs(np.diff(predicted)), 0.0) * used
    sums = np.concatenate([[0.0], np.cumsum(change)])
    return int(np.argmax(sums[count:] - sums[:-count])) if predicted.size > count else 0
