"""Angles between the reflection strips (thesis table 3.4 as a picture)."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.normal import NORMAL_95
from shaftprint.report._style import DATA, house_style, legend_below, legend_entries, letter_panels, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from shaftprint.arrays import FloatArray
    from shaftprint.signals import StripAngles
    from shaftprint.vessel import Vessel

DEGREES_PER_REV = 360.0


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


def _turned(earlier: "FloatArray", found: "FloatArray") -> "FloatArray":
    """Return the earlier angles from the strip on that was counted first now, which no recording shows."""
    if earlier.size != found.size:
        return earlier
    turns = [np.roll(earlier, shift) for shift in range(earlier.size)]
    return min(turns, key=lambda angles: float(np.abs(angles - found).max()))
