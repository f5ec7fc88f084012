"""How the uncertainty of the parameters hangs together, and where it comes from."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.report.figures._style import house_style, legend_below, legend_entries, look, new_figure
from shaftprint.report.notation import mathtext

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from shaftprint.identify import Identification
    from shaftprint.identify.uncertainty import Budget

DARK = 0.6
PERCENT = 100.0
BAR_CM = 0.48
AROUND_CM = 3.2
# Sources beyond the colours of the house style are told apart by their hatching.
COLOURS = 6
HATCHES = ("", "////", "....")


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


def plot_budget(budget: "Budget", names: Sequence[str] | None = None) -> "Figure":
    """Return one bar a number, divided by the share of each source in its variance.

    Where the noise of two outputs partly makes up for each other, one share is negative and the bar begins left of 0.

    Parameters
    ----------
    budget
        The uncertainty budget.
    names
        Numbers to show; all whose uncertainty is known by default.

    Raises
    ------
    ValueError
        If there is no number to show.
    """
    rows = [row for row in budget.rows if row.shares and (names is None or row.name in names)]
    if not rows:
        raise ValueError("budget: expected a number whose uncertainty is known, found none.")
    shown = [source for source in budget.sources if any(row.shares.get(source, 0.0) != 0.0 for row in rows)]
    with house_style():
        figure = new_figure(AROUND_CM + BAR_CM * len(rows))
        axes = figure.subplots()
        places = np.arange(len(rows))
        above, below = np.zeros(len(rows)), np.zeros(len(rows))
        for number, source in enumerate(shown):
            share = np.array([PERCENT * row.shares.get(source, 0.0) for row in rows])
            start = np.where(share >= 0.0, above, below)
            axes.barh(
                places,
                share,
                left=start,
                height=0.7,
                color=look(number).colour,
                hatch=HATCHES[number // COLOURS % len(HATCHES)],
                edgecolor="white",
                linewidth=0.4,
                label=mathtext(source),
            )
            above, below = np.where(share >= 0.0, above + share, above), np.where(share < 0.0, below + share, below)
        axes.set_yticks(places, [mathtext(row.name) for row in rows])
        axes.invert_yaxis()
        axes.grid(visible=False, axis="y")
        axes.axvline(0.0, color="black", linewidth=0.8)
        axes.set_xlim(min(0.0, float(below.min())), max(PERCENT, float(above.max())))
        axes.set_xlabel("share of the variance [%]")
        legend_below(figure, legend_entries((axes,)))
        return figure
