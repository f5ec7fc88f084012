"""What a model leaves of one record in time: residuals, their autocorrelation, and what inputs still say of them."""

from typing import TYPE_CHECKING

import numpy as np
from scipy.signal import correlate

from shaftprint.arrays import BoolArray, FloatArray
from shaftprint.distributions import NORMAL_95
from shaftprint.plain_table import Symbol
from shaftprint.report.charts._chart import Chart, Panel, Scale
from shaftprint.report.charts._marks import Line, Points
from shaftprint.report.charts._text import Text, joined
from shaftprint.report.figures._envelope import envelope
from shaftprint.report.figures._residuals import LEAST_STD, explained_band

if TYPE_CHECKING:
    from shaftprint.time_domain._record_fit import RecordFit

# So many lags are shown, of a short record a quarter of its samples: further ones are means of few products.
MOST_LAGS, LEAST_PERIODS = 60, 4
HIGHEST = 1.15


def correlations(part: "RecordFit") -> dict[tuple[str, str | None], FloatArray]:
    """Return the correlations of a record's whitened residuals by output and by input, None with themselves.

    Each over its lags from 0 on, that with itself from 1 on, and in units of its own standard deviation ``1/sqrt(N)``:
    of residuals that are white and independent of the past of the inputs, 95 % lie within 1.96. Samples that were not
    used count as nothing.
    """
    used = part.record.used
    samples = int(used.sum())
    lags = min(MOST_LAGS, samples // LEAST_PERIODS)
    told: dict[tuple[str, str | None], FloatArray] = {}
    for column, output in enumerate(part.structure.outputs):
        left = _filled(part.whitened[:, column], used)
        told[output, None] = _correlation(left, left, samples)[1 : lags + 1]
        for cause, values in _moving(part).items():
            told[output, cause] = _correlation(left, _filled(values[used], used), samples)[: lags + 1]
    return told


def outside(part: "RecordFit") -> tuple[int, int]:
    """Return how many of the correlations lie outside the bounds, and how many there are."""
    every = np.concatenate([np.abs(values) for values in correlations(part).values()])
    return int(np.sum(every > NORMAL_95)), every.size


def _moving(part: "RecordFit") -> dict[str, FloatArray]:
    """Return the inputs that do not stand still: nothing is correlated with one that does."""
    return {name: values for name, values in part.record.inputs.items() if np.ptp(values[part.record.used]) > 0.0}


def _filled(values: FloatArray, used: BoolArray) -> FloatArray:
    """Return used samples without their mean, at their places among nothing."""
    filled = np.zeros(used.size)
    filled[used] = values - values.mean()
    return filled


def _correlation(later: FloatArray, earlier: FloatArray, samples: int) -> FloatArray:
    """Return the correlation over lags from 0 on, in its standard deviations."""
    power = float(np.sqrt(np.sum(later**2) * np.sum(earlier**2)))
    products = correlate(later, earlier, method="fft")[later.size - 1 :]
    return np.asarray(products / power * np.sqrt(samples))


def left_chart(part: "RecordFit") -> Chart:
    """Return a row an output: residuals over time, their autocorrelation, and their correlation with each input."""
    told, record = correlations(part), part.record
    causes = (None, *_moving(part))
    panels = []
    for column, output in enumerate(part.structure.outputs):
        name = joined("residual of ", Symbol(output))
        time, values = envelope(record.time_s[record.used], part.whitened[:, column])
        panels.append(_panel(Line(x=time, y=values, shade=column, width=1.2), name, "time [s]", "over its std [-]"))
        for cause in causes:
            shown = told[output, cause]
            lag_s = (np.arange(shown.size) + (cause is None)) / record.rate_hz
            title = joined(name, " with ", "itself" if cause is None else Symbol(cause))
            panels.append(
                _panel(Points(x=lag_s, y=values, shade=column, size=5.0), title, "lag [s]", "correlation / std")
            )
    return Chart(panels=panels, columns=1 + len(causes), heights_px=(190,), linked="none")


def _panel(mark: Line | Points, title: Text, x: str, y: str) -> Panel:
    """Return one panel with the band in which 95 % lie where structure and noise hold."""
    largest = max(LEAST_STD, HIGHEST * float(np.max(np.abs(mark.y), initial=0.0)))
    span = (float(np.min(mark.x, initial=0.0)), float(np.max(mark.x, initial=0.0)))
    return Panel(
        title=title,
        marks=[explained_band(span), mark],
        x=Scale(title=x, span=span),
        y=Scale(title=y, span=(-largest, largest)),
    )
