"""How far the best fit at each value of a parameter is from the best of all."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.distributions import NORMAL_95
from shaftprint.report.charts._chart import Chart, Panel, Scale
from shaftprint.report.charts._marks import Line, Points, Straight
from shaftprint.report.charts._text import quantity

if TYPE_CHECKING:
    from shaftprint.identify.fit._identification import Identification
    from shaftprint.identify.fit._scan import Scan

ROOM = 1.06


def scan_chart(scan: "Scan", identification: "Identification") -> Chart:
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
    lowest = min(scan.best.cost, float(scan.cost.min()))
    curve = _distance(scan.cost, lowest, identification)
    optima = np.array([minimum.value for minimum in scan.minima])
    distances = _distance(np.array([minimum.cost for minimum in scan.minima]), lowest, identification)
    highest = ROOM * max(float(curve.max()), NORMAL_95)
    marks = (
        Straight(at=NORMAL_95, axis="y", name="95 % interval below"),
        Line(x=scan.grid, y=curve, name="best fit"),
        Points(x=optima, y=distances, name="optimum", shade=1),
    )
    name = quantity(scan.parameter.name, scan.parameter.unit)
    return Chart(panels=(Panel(marks=marks, x=Scale(title=name), y=Scale(title="distance [-]", span=(0.0, highest))),))


def _distance(cost: FloatArray, lowest: float, fit: "Identification") -> FloatArray:
    deviance = 2.0 * (cost - lowest) if fit.is_likelihood else fit.data_count * np.log(cost / lowest)
    return np.sqrt(np.maximum(deviance, 0.0))
