"""Correlation of the estimates: which parameters the test cannot tell apart."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.report._style import house_style, new_figure
from shaftprint.report._symbols import mathtext

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from shaftprint.identify import Identification

DARK = 0.6


def plot_correlation(identification: "Identification") -> "Figure":
    """Return the correlation matrix of the free parameters; the sign is written, the strength also shaded."""
    names = [mathtext(parameter.name) for parameter in identification.structure.free]
    correlation = identification.correlation
    count = len(names)
    with house_style():
        figure = new_figure(min(2.5 + 1.05 * count, 14.0))
        axes = figure.subplots()
        axes.grid(visible=False)
        strength = np.ma.masked_invalid(np.abs(correlation))
        image = axes.imshow(strength, cmap="Blues", vmin=0.0, vmax=1.0, aspect="auto")
        for row in range(count):
            for column in range(count):
                value = correlation[row, column]
                text = "?" if not np.isfinite(value) else f"{round(value, 2) + 0.0:+.2f}".replace("-", "−")
                light = np.isfinite(value) and abs(value) > DARK
                axes.text(column, row, text, ha="center", va="center", color="white" if light else "black")
        axes.set_xticks(np.arange(count), names)
        axes.set_yticks(np.arange(count), names)
        bar = figure.colorbar(image, ax=axes, pad=0.02)
        bar.set_label("strength of the correlation [-]")
        return figure
