"""The line from set-point voltage to engine speed (thesis figure 3.1)."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.normal import NORMAL_95
from shaftprint.report._style import (
    DATA,
    house_style,
    legend_below,
    legend_entries,
    letter_panels,
    look,
    new_figure,
    plain_number,
)
from shaftprint.units import SECONDS_PER_MINUTE

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from shaftprint.signals import SetPointCalibration

BEYOND_V = 0.3


def plot_calibration(calibration: "SetPointCalibration") -> "Figure":
    """Return the set-point line with its levels, and the residuals: what figure 3.1 of the thesis shows.

    Intervals and band are 95 %, the band from the covariance of slope and intercept.
    """
    volts = np.linspace(calibration.level_v.min() - BEYOND_V, calibration.level_v.max() + BEYOND_V, 100)
    base = np.stack([volts, np.ones_like(volts)])
    line = SECONDS_PER_MINUTE * np.array([calibration.slope_rev_s_per_v, calibration.intercept_rev_s]) @ base
    variance = np.einsum("iv,ij,jv->v", base, calibration.covariance, base)
    half = NORMAL_95 * SECONDS_PER_MINUTE * np.sqrt(np.maximum(variance, 0.0))
    at_levels = SECONDS_PER_MINUTE * (calibration.slope_rev_s_per_v * calibration.level_v + calibration.intercept_rev_s)
    levels = SECONDS_PER_MINUTE * calibration.level_rev_s
    bars = NORMAL_95 * SECONDS_PER_MINUTE * calibration.level_std_rev_s
    with house_style():
        figure = new_figure(7.5)
        left, right = figure.subplots(1, 2)
        style = look(0)
        slope = plain_number(round(SECONDS_PER_MINUTE * calibration.slope_rev_s_per_v, 2))
        intercept = SECONDS_PER_MINUTE * calibration.intercept_rev_s
        text = f"n = {slope} rpm/V · U {'+' if intercept >= 0.0 else '−'} {abs(intercept):.1f} rpm"
        left.plot(volts, line, color=style.colour, label=text)
        right.axhline(0.0, color=style.colour, linewidth=1.2)
        right.fill_between(volts, -half, half, color=style.colour, alpha=0.28, linewidth=0.0, label="95 % band of line")
        for axes, values in ((left, levels), (right, levels - at_levels)):
            axes.errorbar(
                calibration.level_v,
                values,
                yerr=bars,
                linestyle="none",
                marker="o",
                markersize=4.0,
                color=DATA,
                capsize=2.0,
                elinewidth=0.8,
                label="steady levels, 95 % interval",
            )
            axes.set_xlabel("set-point voltage U [V]")
        left.set_ylabel("engine speed n [rpm]")
        right.set_ylabel("level minus line [rpm]")
        letter_panels((left, right), ("line through the steady levels", "residuals"))
        legend_below(figure, legend_entries((left, right)))
        return figure
