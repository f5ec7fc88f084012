"""Calibration of the sensors: the line of the set point and the angles between the strips of a pick-up."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.distributions import NORMAL_95
from shaftprint.report.figures._style import (
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

    from shaftprint.arrays import FloatArray
    from shaftprint.signals import SetPointCalibration, StripAngles
    from shaftprint.vessel import Vessel

BEYOND_V = 0.3
DEGREES_PER_REV = 360.0


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
        line_axes, residual_axes = figure.subplots(1, 2)
        style = look(0)
        slope = plain_number(round(SECONDS_PER_MINUTE * calibration.slope_rev_s_per_v, 2))
        intercept = SECONDS_PER_MINUTE * calibration.intercept_rev_s
        text = f"n = {slope} rpm/V · U {'+' if intercept >= 0.0 else '−'} {abs(intercept):.1f} rpm"
        line_axes.plot(volts, line, color=style.colour, label=text)
        residual_axes.axhline(0.0, color=style.colour, linewidth=1.2)
        residual_axes.fill_between(
            volts, -half, half, color=style.colour, alpha=0.28, linewidth=0.0, label="95 % band of line"
        )
        for axes, values in ((line_axes, levels), (residual_axes, levels - at_levels)):
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
        line_axes.set_ylabel("engine speed n [rpm]")
        residual_axes.set_ylabel("level minus line [rpm]")
        letter_panels((line_axes, residual_axes), ("line through the steady levels", "residuals"))
        legend_below(figure, legend_entries((line_axes, residual_axes)))
        return figure


def plot_strip_angles(strips: "tuple[StripAngles, ...]", vessel: "Vessel | None" = None) -> "Figure":
    """Return how far each strip angle is from an even spacing, with 95 % intervals (values of table 3.4).

    Parameters
    ----------
    strips
        Angles of the multi-pulse channels, as found in the recording.
    vessel
        Gives the angles that were found earlier, for comparison.

    Raises
    ------
    ValueError
        If no channel has more than one strip.
    """
    several = [strip for strip in strips if strip.angle_rev.size > 1]
    if not several:
        raise ValueError("strip angles: expected a channel of more than one pulse a revolution, found none.")
    with house_style():
        figure = new_figure(6.5)
        panels = figure.subplots(1, len(several), squeeze=False)[0]
        for axes, strip in zip(panels, several, strict=True):
            number = np.arange(1, strip.angle_rev.size + 1)
            even = DEGREES_PER_REV / strip.angle_rev.size
            axes.axhline(0.0, color="black", linewidth=0.8)
            axes.bar(number, DEGREES_PER_REV * strip.angle_rev - even, width=0.5, color="#b9cfe0", edgecolor="black")
            axes.errorbar(
                number,
                DEGREES_PER_REV * strip.angle_rev - even,
                yerr=NORMAL_95 * DEGREES_PER_REV * strip.std_rev,
                linestyle="none",
                color=DATA,
                capsize=3.0,
                label="found in this recording, 95 % interval",
            )
            earlier = _earlier_deg(strip, vessel)
            if earlier is not None:
                axes.plot(
                    number,
                    earlier - even,
                    linestyle="none",
                    marker="D",
                    color=DATA,
                    markerfacecolor="white",
                    markersize=4.5,
                    label="vessel file",
                )
            axes.set_xticks(number)
            axes.set_xlabel("strip, angle to the next [-]")
            axes.set_ylabel(f"angle minus {even:g}° [deg]")
        letter_panels(panels, [f"channel {strip.channel}" for strip in several])
        legend_below(figure, legend_entries(panels))
        return figure


def _earlier_deg(strip: "StripAngles", vessel: "Vessel | None") -> "FloatArray | None":
    if vessel is None:
        return None
    for sensor in vessel.sensors.speed:
        if sensor.channel == strip.channel and sensor.strip_angles_deg is not None:
            angles = np.array(sensor.strip_angles_deg)
            return _turned(angles * (DEGREES_PER_REV / angles.sum()), DEGREES_PER_REV * strip.angle_rev)
    return None


def _turned(earlier: "FloatArray", identified_deg: "FloatArray") -> "FloatArray":
    """Return the earlier angles from the strip on that was counted first now, which no recording shows."""
    if earlier.size != identified_deg.size:
        return earlier
    turns = [np.roll(earlier, shift) for shift in range(earlier.size)]
    return min(turns, key=lambda angles: float(np.abs(angles - identified_deg).max()))
