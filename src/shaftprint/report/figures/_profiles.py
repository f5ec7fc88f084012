"""Profiles of the likelihood beside the parabolas of the standard deviations."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.identify.uncertainty import profile_curve
from shaftprint.report.figures._style import REFERENCE, house_style, legend_below, legend_entries, look, new_figure
from shaftprint.report.notation import mathtext
from shaftprint.tables import unit_text

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from shaftprint.identify import Identification
    from shaftprint.identify.uncertainty import ProfileCurve

COLUMNS = 4
ROW_CM = 4.0
BELOW_CM = 1.4
PARABOLA_POINTS = 81
# The picture ends a little above the limit.
ROOM = 1.6


def plot_profiles(identification: "Identification", names: Sequence[str] | None = None) -> "Figure":
    """Return a panel for each parameter: the lowest cost at each of its values, and what its deviation would make it.

    Parameters
    ----------
    identification
        A fit that is weighted by the covariance.
    names
        Parameters and combinations to show; all free parameters by default.
    """
    shown = [parameter.name for parameter in identification.objective.free_parameters] if names is None else names
    rows = -(-len(shown) // COLUMNS)
    columns = min(COLUMNS, len(shown))
    with house_style():
        figure = new_figure(BELOW_CM + ROW_CM * rows)
        panels = list(figure.subplots(rows, columns, squeeze=False, sharey=True).ravel())
        for axes, name in zip(panels, shown, strict=False):
            _draw(axes, profile_curve(identification, name))
        for axes in panels[len(shown) :]:
            axes.set_visible(False)
        for axes in panels[::columns]:
            axes.set_ylabel("rise of the cost [-]")
        legend_below(figure, legend_entries(panels[: len(shown)]))
        return figure


def _draw(axes: "Axes", curve: "ProfileCurve") -> None:
    profile, parabola = look(0), look(1)
    axes.axhline(curve.limit, color=REFERENCE, linewidth=0.9, linestyle=(0.0, (1.0, 1.5)), label="95 % interval below")
    if np.isfinite(curve.std) and curve.values.size > 1:
        values = np.linspace(curve.values[0], curve.values[-1], PARABOLA_POINTS)
        rise = 0.5 * ((values - curve.value) / curve.std) ** 2
        axes.plot(
            values, rise, color=parabola.colour, linestyle=parabola.dashes, label="parabola of the standard deviation"
        )
    axes.plot(
        curve.values,
        curve.rise,
        color=profile.colour,
        linestyle=profile.dashes,
        marker="o",
        markersize=2.0,
        label="profile of the likelihood",
    )
    axes.axvline(curve.value, color="black", linewidth=0.5)
    axes.set_ylim(0.0, ROOM * curve.limit)
    unit = unit_text(curve.unit)
    axes.set_xlabel(f"{mathtext(curve.name)} [{unit or '-'}]")
    axes.locator_params(axis="x", nbins=3)
