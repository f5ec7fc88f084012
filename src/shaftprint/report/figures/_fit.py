"""A fitted model through its data: Bode diagram, and below it what it leaves and its band in deviations of the data."""

import math
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.identify.uncertainty._band import model_band
from shaftprint.report._curve import Curve
from shaftprint.report.charts._chart import Chart, Panel, Scale
from shaftprint.report.charts._marks import Band, Mark, Points
from shaftprint.report.charts._text import over
from shaftprint.report.figures._bode import Column, columns_chart, frequency_scale
from shaftprint.report.figures._residuals import LEAST_STD, explained_band, unexplained
from shaftprint.report.figures._uncertainty import stds_along_and_across
from shaftprint.units import decibel

if TYPE_CHECKING:
    from shaftprint.identify.fit._identification import Identification

ROOM = 1.1
STEP_STD, MOST_STEPS = 2.0, 4.0


def fit_chart(identification: "Identification", *, aliasing_limit_hz: float | None = None) -> Chart:
    """Return a fitted model with its 95 % band through the measured response, and the residuals below.

    On the scale of the response band and residuals are often thinner than a line: the lowest panel shows both, along
    the model and across it, over the standard deviation of each measured line.

    Parameters
    ----------
    identification
        The fit.
    aliasing_limit_hz
        Half the pulse rate of the speed sensor [Hz], drawn as a vertical line.
    """
    curve, data = Curve.of(identification), identification.response
    columns = [
        Column(title=over(output, cause), output=output, cause=cause, curves=[curve], data={"data": data})
        for output, cause in identification.structure.channels
    ]
    below = [_remainder(identification, curve, place, column) for place, column in enumerate(columns)]
    return columns_chart(columns, aliasing_limit_hz=aliasing_limit_hz, below=below)


def _remainder(identification: "Identification", curve: Curve, channel: int, column: Column) -> Panel:
    """Return what the model leaves of one channel, in standard deviations of the data."""
    data, fitted = identification.response, identification.fitted
    remainder = unexplained(identification)[channel]
    # along the model: along what was measured a line that is nothing but noise would always stand at +1
    model = data.response.reshape(len(data.outputs) * len(data.inputs), -1)[channel] - remainder
    size = np.abs(model)
    along_std, across_std = stds_along_and_across(data, channel, model)
    turned = remainder * model.conj() / size
    omega = data.omega_rad_s[fitted]
    span = column.whole_span()
    marks: list[Mark] = [explained_band(span)]
    largest = LEAST_STD
    halves = _model_halves(curve, channel, omega / (2.0 * np.pi))
    for shade, (name, values, std, half) in enumerate(
        (
            ("magnitude", turned.real, along_std, size[fitted] * halves[0]),
            ("phase", turned.imag, across_std, size[fitted] * halves[1]),
        ),
        start=2,
    ):
        normalised, around = values[fitted] / std[fitted], half / std[fitted]
        if np.isfinite(around).all():
            text = f"model band, {name}"
            marks.append(Band(x=omega, lower=-around, upper=around, name=text, shade=shade))
        words = [line for line, is_shown in zip(data.lines, fitted, strict=True) if is_shown]
        marks.append(Points(x=omega, y=normalised, name=f"residual, {name}", shade=shade, words=words))
        largest = max(largest, ROOM * float(np.abs(normalised).max()))
    title = "residual / std" if channel == 0 else ""
    step = STEP_STD if largest < MOST_STEPS * STEP_STD else None
    return Panel(marks=marks, x=frequency_scale(span), y=Scale(title=title, span=(-largest, largest), step=step))


def _model_halves(curve: Curve, channel: int, frequency_hz: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the half widths of the model's 95 % band over the size of its response: magnitude and phase."""
    if curve.covariance is None:
        nothing = np.full(frequency_hz.size, np.nan)
        return nothing, nothing
    band = model_band(curve.structure, curve.values, curve.covariance, frequency_hz)
    magnitude = (band.magnitude_upper_db - band.magnitude_db)[channel] / decibel(math.e)
    return magnitude, np.radians((band.phase_upper_deg - band.phase_deg)[channel])
