"""How far the best fit at each value of a parameter is from the best of all."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.distributions import NORMAL_95
from shaftprint.report.figures._style import REFERENCE, house_style, legend_below, legend_entries, look, new_figure
from shaftprint.report.notation import mathtext, with_unit

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from shaftprint.identify import Identification
    from shaftprint.identify.fit import Scan


def plot_scan(scan: "Scan", identification: "Identification") -> "Figure":
    """Return the curve of a scan with its optima.

    The distance is the root of the deviance above the best: in standard deviations where the curve is a parabola.
    Without weights it is that of noise of one unknown variance.

    Parameters
    ----------
    scan
        The scan.
    identification
        The fit it belongs to.
    """
    curve, points = look(0), look(1)
    lowest = min(scan.best.cost, float(scan.cost.min()))
    with house_style():
        figure = new_figure(6.5)
        axes = figure.subplots()
        axes.plot(scan.grid, _distance(scan.cost, lowest, identification), color=curve.colour, label="best fit")
        axes.plot(
            [minimum.value for minimum in scan.minima],
            _distance(np.array([minimum.cost for minimum in scan.minima]), lowest, identification),
            color=points.colour,
            marker=points.marker,
            markersize=4.0,
            linestyle="none",
            clip_on=False,
            zorder=3.0,
            label="optimum",
        )
        axes.axhline(
            NORMAL_95, color=REFERENCE, linewidth=0.9, linestyle=(0.0, (1.0, 1.5)), label="95 % interval below"
        )
        axes.set_ylim(bottom=0.0)
        axes.set_xlabel(with_unit(mathtext(scan.parameter.name), scan.parameter.unit))
        axes.set_ylabel("distance [-]")
        legend_below(figure, legend_entries((axes,)))
        return figure


def _distance(cost: FloatArray, lowest: float, fit: "Identification") -> FloatArray:
    deviance = 2.0 * (cost - lowest) if fit.is_likelihood else fit.data_count * np.log(cost / lowest)
    return np.sqrt(np.maximum(deviance, 0.0))
