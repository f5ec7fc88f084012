"""What the identified model does after a step of its input, with its confidence band."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.identify.uncertainty import step_band
from shaftprint.report.figures._style import house_style, legend_below, legend_entries, letter_panels, look, new_figure
from shaftprint.report.notation import mathtext, response_label

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from shaftprint.identify import Identification

DURATION_S = 6.0
POINTS = 301
BAND_ALPHA = 0.28
PERCENT = 100.0


def plot_step_band(identification: "Identification", *, duration_s: float = DURATION_S) -> "Figure":
    """Return the response of every output to a step of 1 at an input, with its pointwise 95 % band.

    Parameters
    ----------
    identification
        The fit.
    duration_s
        Time after the step that is shown [s].
    """
    band = step_band(identification, np.linspace(0.0, duration_s, POINTS))
    channels = identification.structure.channels
    with house_style():
        figure = new_figure(7.5)
        panels = figure.subplots(1, len(channels), squeeze=False)[0]
        for index, (axes, (output, cause)) in enumerate(zip(panels, channels, strict=True)):
            style = look(0)
            if np.isfinite(band.lower[index]).all():
                axes.fill_between(
                    band.time_s,
                    band.lower[index],
                    band.upper[index],
                    color=style.colour,
                    alpha=BAND_ALPHA,
                    linewidth=0.0,
                    label=f"{PERCENT * band.coverage:g} % band, at each time",
                )
            axes.plot(band.time_s, band.value[index], color=style.colour, label=f"{identification.structure.name}")
            axes.set_xlabel("time after the step [s]")
            axes.set_ylabel(f"{mathtext(output)} after a step of 1 of {mathtext(cause)}")
        letter_panels(panels, [response_label(*channel) for channel in channels])
        legend_below(figure, legend_entries(panels))
        return figure
