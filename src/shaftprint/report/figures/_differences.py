"""Differences of fingerprints as points with intervals, in percent of the first."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.report.figures._style import REFERENCE, house_style, legend_below, legend_entries, look, new_figure
from shaftprint.report.notation import mathtext, plain_label

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from shaftprint.report.comparison import Difference

PERCENT = 100.0
ROW_CM, FRAME_CM = 0.62, 3.4
APART = 0.5


def in_percent(difference: "Difference") -> tuple[float, float, float] | None:
    """Return a difference and the ends of its interval in percent of the first number; None where there are none.

    A number in percent already is one of another, whose percent would say nothing.
    """
    if difference.first.unit == "%" or difference.interval_95 is None or difference.first.value == 0.0:
        return None
    scale = PERCENT / abs(difference.first.value)
    low, high = difference.interval_95
    return scale * difference.value, scale * low, scale * high


def plot_differences(found: Mapping[str, Sequence["Difference"]]) -> "Figure":
    """Return differences in percent of the first fingerprint, each with its 95 % interval.

    Parameters
    ----------
    found
        Differences from the first fingerprint, by the name of the other.

    Raises
    ------
    ValueError
        If there is no number that can be shown in percent.
    """
    names = shown_names(found)
    if not names:
        raise ValueError("differences: expected a number that both fingerprints know, found none.")
    with house_style():
        figure = new_figure(FRAME_CM + ROW_CM * len(names))
        axes = figure.subplots()
        axes.axvline(0.0, color=REFERENCE, linewidth=1.0)
        for index, (label, differences) in enumerate(found.items()):
            style = look(index)
            rows = {d.first.name: percent for d in differences if (percent := shown_percent(d)) is not None}
            at = np.array([names.index(name) for name in rows], dtype=np.float64)
            values = np.array(list(rows.values())).reshape(-1, 3)
            axes.errorbar(
                values[:, 0],
                at + APART * ((index + 0.5) / len(found) - 0.5),
                xerr=[values[:, 0] - values[:, 1], values[:, 2] - values[:, 0]],
                fmt=style.marker,
                color=style.colour,
                markersize=4.0,
                linewidth=1.0,
                capsize=2.0,
                label=plain_label(label),
            )
        axes.set_yticks(range(len(names)), [mathtext(name) for name in names])
        axes.set_ylim(len(names) - 0.5, -0.5)
        axes.set_xlabel("difference from the first fingerprint, with 95 % interval [%]")
        legend_below(figure, legend_entries((axes,)))
        return figure


def shown_names(found: Mapping[str, Sequence["Difference"]]) -> list[str]:
    """Return the names of the numbers that can be shown in percent, in their order."""
    return list(dict.fromkeys(d.first.name for ds in found.values() for d in ds if shown_percent(d) is not None))


def shown_percent(difference: "Difference") -> tuple[float, float, float] | None:
    """Return what a figure shows of a difference: that of a number which stands for the ship, in percent."""
    return None if difference.normalised else in_percent(difference)
