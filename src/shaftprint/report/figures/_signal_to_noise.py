"""Signal-to-noise ratio of every line and channel (thesis table 3.7 as a picture)."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.report.figures._style import (
    REFERENCE,
    house_style,
    legend_below,
    legend_entries,
    look,
    new_figure,
    plain_log_axis,
)
from shaftprint.report.notation import mathtext

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from shaftprint.arrays import BoolArray, FloatArray
    from shaftprint.report.figures._style import LineLook
    from shaftprint.spectra import Spectra

THESIS_LIMIT_DB = 3.0


def plot_signal_to_noise(spectra: "Spectra", *, aliasing_limit_hz: float | None = None) -> "Figure":
    """Return the local signal-to-noise ratio of each line and channel (values of thesis table 3.7).

    Lines that are not used are hollow. The horizontal line is the thesis' limit of 3 dB.

    Parameters
    ----------
    spectra
        What the sines told.
    aliasing_limit_hz
        Half the pulse rate of the speed sensor [Hz].
    """
    ratios = spectra.signal_to_noise
    response = spectra.response
    omega = 2.0 * np.pi * np.array([window.frequency_hz for window in spectra.windows])
    line_used = dict(zip(response.lines, response.used, strict=True))
    used = np.array([bool(line_used.get(line, False)) for line in ratios.lines])
    with house_style():
        figure = new_figure(8.0)
        axes = figure.subplots()
        for index, channel in enumerate(ratios.channels):
            _draw(axes, omega, ratios.local_db[:, index], used, look(index), mathtext(channel))
        axes.axhline(THESIS_LIMIT_DB, color="black", linewidth=0.9, label=f"{THESIS_LIMIT_DB:g} dB, the thesis' limit")
        if aliasing_limit_hz is not None:
            axes.axvline(
                2.0 * np.pi * aliasing_limit_hz,
                color=REFERENCE,
                linestyle=(0.0, (1.0, 1.5)),
                label=f"aliasing limit of the speed, {aliasing_limit_hz:.2f} Hz",
            )
        plain_log_axis(axes)
        axes.set_xlabel("frequency [rad/s]")
        axes.set_ylabel("local signal-to-noise ratio [dB]")
        legend_below(figure, legend_entries((axes,)))
        return figure


def _draw(
    axes: "Axes", omega: "FloatArray", values: "FloatArray", used: "BoolArray", style: "LineLook", label: str
) -> None:
    """Draw one channel: its line, and a marker a test line, hollow where it is not used."""
    axes.plot(omega, values, color=style.colour, linestyle=style.dashes, linewidth=0.9)
    for chosen, fill in ((used, style.colour), (~used, "white")):
        axes.plot(
            omega[chosen],
            values[chosen],
            linestyle="none",
            marker=style.marker,
            markersize=4.0,
            color=style.colour,
            markerfacecolor=fill,
        )
    # the legend shows line and marker together
    axes.plot(
        [],
        [],
        color=style.colour,
        linestyle=style.dashes,
        linewidth=0.9,
        marker=style.marker,
        markersize=4.0,
        label=label,
    )
