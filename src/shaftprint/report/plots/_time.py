"""Interactive plots over time: records that a model has not seen, tests as they were measured, steps of the model."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.distributions import deviations
from shaftprint.identify.uncertainty import step_band
from shaftprint.report.figures import DURATION_S, envelope, worthwhile
from shaftprint.report.plots._panels import Grid
from shaftprint.report.plots._plot import Json, Plot, packed
from shaftprint.report.plots._traces import band, line
from shaftprint.report.plots._words import label_text, name_text, over_text

if TYPE_CHECKING:
    from shaftprint.campaign import Excitation
    from shaftprint.identify import Identification
    from shaftprint.signals import Signals
    from shaftprint.validation import ExcerptComparison, Validation

PERCENT = 100.0
STRETCHES = 1600
BAND_POINTS = 200
STEP_POINTS = 301
OUTPUTS = (("n", "engine speed"), ("M_s", "shaft torque"))
DEVIATION = "deviation over<br>working point [-]"


def validation_plot(validations: Sequence["Validation"], record: str, title: str) -> Plot:
    """Return speed and torque of one or more models over a record that they have not seen.

    Parameters
    ----------
    validations
        Models held against the same recording in the same way.
    record, title
        Name of the chirp or staircase, and the beginning of the title of the excerpt.

    Raises
    ------
    ValueError
        If there is no validation, or no such excerpt.
    """
    if not validations:
        raise ValueError("validation plot: expected at least one validation, found none.")
    grid = _grid("time in the recording [s]")
    settings = validations[0].settings
    try:
        first = validations[0].of(record, title).traces
        shown = [validation.of(record, title) for validation in validations]
    except KeyError as missing:
        raise ValueError(f"validation plot: expected an excerpt {missing.args[0]}, found none.") from None
    few = worthwhile(first.time_s, settings.highest_hz)
    traces: list[Json] = []
    for row in range(len(OUTPUTS)):
        axes = grid.place(row, 0)
        traces.append(_signal(first.time_s[few], first.measured[row, few], "measured", "@soft", axes, row, width=4))
        if row == 0:
            traces.append(_signal(first.time_s[few], first.set_point[few], "set point", "@reference", axes, row))
        for number, (validation, comparison) in enumerate(zip(validations, shown, strict=True)):
            traces += _model(validation, comparison, few, number, row, axes)
    return Plot(traces=traces, layout=grid.layout(), height_px=600)


def _model(
    validation: "Validation", comparison: "ExcerptComparison", few: slice, number: int, row: int, axes: Json
) -> list[Json]:
    traces = comparison.traces
    name = label_text(validation.model.name)
    half = deviations(validation.settings.coverage) * traces.model_std[row]
    bands: list[Json] = []
    if np.any(half > 0.0):
        every = slice(None, None, max(1, half.size // BAND_POINTS))
        middle, around = traces.model[row, every], half[every]
        text = f"{PERCENT * validation.settings.coverage:g} % band of {name}"
        bands += band(traces.time_s[every], middle - around, middle + around, text, number, axes, legend=row == 0)
    drawn = line([], [], name, number, axes, legend=row == 0)
    return [*bands, drawn | _samples(traces.time_s[few], traces.model[row, few])]


def excitation_plot(signals: "Signals", tests: Sequence["Excitation"]) -> Plot:
    """Return set point, speed and torque of tests as they were measured, smallest and largest of each stretch.

    Parameters
    ----------
    signals
        The prepared recording.
    tests
        Chirps, staircases or sines of the campaign, in the order of time.
    """
    point = signals.working_point
    grid = _grid("time in the recording [s]")
    first = max(0, int(np.ceil((min(t.start_s for t in tests) - signals.start_s) * signals.rate_hz)))
    last = min(signals.samples, int((max(t.stop_s for t in tests) - signals.start_s) * signals.rate_hz))
    time = signals.start_s + np.arange(first, last) / signals.rate_hz
    set_point = signals.set_point_rev_s[first:last] / point.engine_speed_rev_s - 1.0
    measured = (
        signals.engine_speed.speed_rev_s[first:last] / point.engine_speed_rev_s - 1.0,
        signals.shaft_torque_nm[first:last] / point.shaft_torque_nm - 1.0,
    )
    traces: list[Json] = []
    for row, values in enumerate(measured):
        axes = grid.place(row, 0)
        traces.append(_signal(*envelope(time, values, stretches=STRETCHES), "response", "@4", axes, row))
        traces.append(_signal(*envelope(time, set_point, stretches=STRETCHES), "set point", "@0", axes, row))
    return Plot(traces=traces, layout=grid.layout(), height_px=560)


def step_plot(identification: "Identification") -> Plot:
    """Return what the identified linear model does after a step of 1 of its input, with its 95 % band."""
    response = step_band(identification, np.linspace(0.0, DURATION_S, STEP_POINTS))
    channels = identification.structure.channels
    titles = [over_text(*channel) for channel in channels]
    grid = Grid(columns=len(channels), titles=titles, x_titles=["time after the step [s]"], y_titles=["response [-]"])
    traces: list[Json] = []
    name = label_text(identification.structure.name)
    for index in range(len(channels)):
        axes = grid.place(0, index)
        text = f"{PERCENT * response.coverage:g} % band"
        traces += band(response.time_s, response.lower[index], response.upper[index], text, 0, axes, legend=index == 0)
        traces.append(line(response.time_s, response.value[index], name, 0, axes, legend=index == 0))
    return Plot(traces=traces, layout=grid.layout(), height_px=440)


def _grid(below: str) -> Grid:
    titles = [f"{words} {name_text(name)}" for name, words in OUTPUTS]
    return Grid(rows=2, titles=titles, x_titles=[below], y_titles=[DEVIATION, DEVIATION])


def _signal(
    time: FloatArray, values: FloatArray, name: str, shade: str, axes: Json, row: int, *, width: float = 1.2
) -> Json:
    trace = line([], [], name, 0, axes, legend=row == 0) | _samples(time, values)
    return trace | {"line": {"color": shade, "width": width}}


def _samples(time: FloatArray, values: FloatArray) -> Json:
    """Return a long signal as 16-bit numbers; evenly spaced times as first and distance, which halves the file."""
    gaps = np.diff(time)
    if gaps.size and np.ptp(gaps) < 1e-6 * gaps.mean():
        spaced: Json = {"x0": float(time[0]), "dx": float((time[-1] - time[0]) / (time.size - 1))}
        return {"x": None} | spaced | {"y": packed(values)}
    return {"x": packed(time), "y": packed(values)}
