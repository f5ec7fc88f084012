"""Interactive Bode diagram: models with bands, data with error bars, all panels zoomed together."""

from collections.abc import Mapping, Sequence
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.identify.uncertainty import model_band
from shaftprint.report.figures import BAND_STEP, ENDLESS_DB, channel_of, measured_phase_deg, measured_points, trace_of
from shaftprint.report.plots._panels import TWO_LEGEND_ROWS_PX, Grid
from shaftprint.report.plots._plot import Json, Plot
from shaftprint.report.plots._traces import MARKERS, band, colour, line, points, straight
from shaftprint.report.plots._words import label_text, over_text

if TYPE_CHECKING:
    from shaftprint.report._curve import Curve
    from shaftprint.report.figures import Trace
    from shaftprint.spectra import FrequencyResponse

GRID_POINTS = 301
DEFAULT_SPAN = (0.02, 60.0)
WIDER = 1.4
# How far a model may leave the data before the axis lets it go.
BEYOND_DB = 15.0
BEYOND_DEG = 90.0
ROOM = 0.06


def bode_plot(
    curves: Sequence["Curve"] = (),
    *,
    data: "Mapping[str, FrequencyResponse] | None" = None,
    aliasing_limit_hz: float | None = None,
) -> Plot:
    """Return a Bode diagram of models and data: rad/s, dB, unwrapped degrees, 95 % bands and error bars.

    Parameters
    ----------
    curves
        Models of the same outputs; a band is drawn around those with a covariance.
    data
        Measured responses by label; lines that are not used are hollow.
    aliasing_limit_hz
        Half the pulse rate of the speed sensor [Hz], drawn as a vertical line where it is within the frequencies shown.

    Raises
    ------
    ValueError
        If there is neither model nor data.
    """
    data = data or {}
    if not curves and not data:
        raise ValueError("a Bode diagram needs a model or data, found neither.")
    first = next(iter(data.values())) if data else curves[0].structure
    channels = list(product(tuple(first.outputs), first.inputs))
    span = _span(data)
    grid = Grid(
        rows=2,
        columns=len(channels),
        titles=[over_text(*channel) for channel in channels],
        x_titles=["frequency [rad/s]"],
        y_titles=["magnitude [dB]", "phase [deg]"],
        x_log=True,
        below_px=TWO_LEGEND_ROWS_PX,
    )
    layout = grid.layout()
    traces: list[Json] = []
    for column, (output, cause) in enumerate(channels):
        drawn = _column(grid, column, curves, data, (output, cause), span)
        traces += drawn
        for row, beyond in ((0, BEYOND_DB), (1, BEYOND_DEG)):
            panel_traces = [trace for trace in drawn if trace["yaxis"] == grid.place(row, 0 + column)["yaxis"]]
            limits = _limits(panel_traces, beyond)
            layout[grid.axis("y", row, column)]["range"] = limits
            if aliasing_limit_hz is not None and 2.0 * np.pi * aliasing_limit_hz < span[1]:
                text = f"aliasing limit of the speed, {aliasing_limit_hz:.2f} Hz"
                at = 2.0 * np.pi * aliasing_limit_hz
                traces.append(straight(text, grid.place(row, column), [at, at], limits, legend=row + column == 0))
    layout["xaxis"]["range"] = [round(float(np.log10(end)), 4) for end in span]
    return Plot(traces=traces, layout=layout, height_px=640)


def _span(data: "Mapping[str, FrequencyResponse]") -> tuple[float, float]:
    """Return the frequencies of the data with some room at both ends [rad/s]."""
    if not data:
        return DEFAULT_SPAN
    omega = np.concatenate([response.omega_rad_s for response in data.values()])
    return float(omega.min() / WIDER), float(omega.max() * WIDER)


def _column(
    grid: Grid,
    column: int,
    curves: "Sequence[Curve]",
    data: "Mapping[str, FrequencyResponse]",
    channel: tuple[str, str],
    span: tuple[float, float],
) -> list[Json]:
    """Return all that is drawn of one output: magnitude above, phase below."""
    omega = np.geomspace(*span, GRID_POINTS)
    traces = [trace_of(curve, channel[0], omega, channel[1]) for curve in curves]
    drawn: list[Json] = []
    for index, (curve, trace) in enumerate(zip(curves, traces, strict=True)):
        drawn += _model(grid, column, curve, trace, channel, index)
    for index, (label, response) in enumerate(data.items()):
        drawn += _data(grid, column, response, traces, channel, (index, len(data)), label)
    return drawn


def _model(grid: Grid, column: int, curve: "Curve", trace: "Trace", channel: tuple[str, str], index: int) -> list[Json]:
    drawn: list[Json] = []
    label = label_text(curve.label)
    panels = [grid.place(row, column) for row in (0, 1)]
    if curve.covariance is not None:
        at = channel_of(curve.structure.outputs, curve.structure.inputs, *channel)
        few = slice(None, None, BAND_STEP)
        omega = trace.omega_rad_s[few]
        around = model_band(curve.structure, curve.values, curve.covariance, omega / (2.0 * np.pi))
        name = f"{label}, {100.0 * around.coverage:g} % band"
        for row, middle, half in (
            (0, trace.magnitude_db[few], (around.magnitude_upper_db - around.magnitude_db)[at]),
            (1, trace.phase_deg[few], (around.phase_upper_deg - around.phase_deg)[at]),
        ):
            legend = column == 0 and row == 0
            drawn += band(omega, middle - half, middle + half, name, index, panels[row], legend=legend)
    for row, values in enumerate((trace.magnitude_db, trace.phase_deg)):
        drawn.append(line(trace.omega_rad_s, values, label, index, panels[row], legend=column == 0 and row == 0))
    return drawn


def _data(
    grid: Grid,
    column: int,
    response: "FrequencyResponse",
    traces: "Sequence[Trace]",
    channel: tuple[str, str],
    place: tuple[int, int],
    label: str,
) -> list[Json]:
    at = channel_of(response.outputs, response.inputs, *channel)
    measured = measured_points(response, at)
    phase = measured_phase_deg(response, at, traces)
    below = np.minimum(measured.below_db, ENDLESS_DB)
    shade = "@data" if place[1] == 1 else colour(place[0])
    drawn: list[Json] = []
    for chosen, filled, text in (
        (response.used, True, f"{label_text(label)}, 95 % interval"),
        (~response.used, False, f"{label_text(label)}, line not used"),
    ):
        if not chosen.any():
            continue
        words = [name for name, shown in zip(response.lines, chosen, strict=True) if shown]
        for row, middle, bars in (
            (0, measured.magnitude_db, (below, measured.above_db)),
            (1, phase, (measured.phase_half_deg, measured.phase_half_deg)),
        ):
            drawn.append(
                points(
                    response.omega_rad_s[chosen],
                    middle[chosen],
                    text,
                    grid.place(row, column),
                    shade=shade,
                    marker=MARKERS[place[0] % len(MARKERS)],
                    filled=filled,
                    bars=(bars[0][chosen], bars[1][chosen]),
                    words=words,
                    legend=column == 0 and row == 0,
                )
            )
    return drawn


def _limits(traces: Sequence[Json], beyond: float) -> list[float]:
    """Return the ends of a vertical axis that holds all points, and the models as far as they are not far from them."""
    measured = [y for trace in traces if trace["mode"] == "markers" for y in trace["y"]]
    drawn = np.array([y for trace in traces if trace["mode"] == "lines" for y in trace["y"]], dtype=np.float64)
    if measured:
        drawn = np.clip(drawn, min(measured) - beyond, max(measured) + beyond)
    together = np.concatenate([drawn, np.array(measured, dtype=np.float64)])
    room = ROOM * max(float(np.ptp(together)), 1.0)
    return [round(float(together.min()) - room, 3), round(float(together.max()) + room, 3)]
