"""Bode diagrams of measured responses and models, with intervals on data and bands on models."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.report.figures._bode_parts import channel_of, draw_data, draw_trace, measured_phase_deg, trace_of
from shaftprint.report.figures._style import (
    REFERENCE,
    Handle,
    house_style,
    legend_below,
    look,
    new_figure,
    plain_log_axis,
)
from shaftprint.report.figures._uncertainty import measured_points
from shaftprint.report.notation import response_label

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from shaftprint.report._curve import Curve
    from shaftprint.report.figures._bode_parts import Trace
    from shaftprint.spectra import FrequencyResponse

GRID_POINTS = 600
DEFAULT_SPAN = (0.02, 300.0)
# How much wider than the data the picture is, and how far models may leave the data before the axis lets them go.
WIDER = 1.4
BEYOND_DB = 15.0
BEYOND_DEG = 90.0
ROOM = 0.06
# Points of several responses at one frequency stand side by side, this factor apart.
SIDEWAYS = 1.12


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Column:
    """One column of a Bode figure: magnitude above, phase below."""

    title: str
    """Title above the column."""
    output: str
    """Output that is drawn."""
    cause: str | None = None
    """Input to which it is drawn; the first where none is named."""
    curves: Sequence["Curve"] = ()
    """Models."""
    data: Mapping[str, "FrequencyResponse"] = field(default_factory=dict)
    """Measured responses by label; one is black, several have their own looks."""
    span_rad_s: tuple[float, float] | None = None
    """Frequencies to draw [rad/s]; a little more than the data by default."""

    def whole_span(self) -> tuple[float, float]:
        """Return the frequencies of the data with some room at both ends [rad/s]."""
        if not self.data:
            return DEFAULT_SPAN
        omega = np.concatenate([response.omega_rad_s for response in self.data.values()])
        return float(omega.min() / WIDER), float(omega.max() * WIDER)


def plot_bode(
    curves: Sequence["Curve"] = (),
    *,
    data: "FrequencyResponse | None" = None,
    aliasing_limit_hz: float | None = None,
    outputs: Sequence[str] | None = None,
    span_rad_s: tuple[float, float] | None = None,
    zoom_rad_s: tuple[float, float] | None = None,
) -> "Figure":
    """Return a Bode diagram of models and data: rad/s, dB, unwrapped degrees, 95 % intervals and bands.

    Parameters
    ----------
    curves
        Models; a band is drawn around those with a covariance.
    data
        Measured response; lines that are not used are drawn as hollow markers.
    aliasing_limit_hz
        Half the pulse rate of the speed sensor [Hz], drawn as a vertical line.
    outputs
        Outputs to draw, one column each and input; all of the data or of the first model by default.
    span_rad_s
        Frequencies to draw [rad/s]; a little more than the data by default.
    zoom_rad_s
        A second column for each output shows this span [rad/s] again.

    Raises
    ------
    ValueError
        If there is neither model nor data.
    """
    if not curves and data is None:
        raise ValueError("a Bode diagram needs a model or data, found neither.")
    names = outputs or (data.outputs if data is not None else tuple(curves[0].structure.outputs))
    causes = data.inputs if data is not None else curves[0].structure.inputs
    measured = {} if data is None else {"data": data}
    columns = []
    for name, cause in product(names, causes):
        title = response_label(name, cause)
        column = Column(title=title, output=name, cause=cause, curves=curves, data=measured, span_rad_s=span_rad_s)
        columns.append(column)
        if zoom_rad_s is not None:
            title = f"{title}, {zoom_rad_s[0]:g} to {zoom_rad_s[1]:g} rad/s"
            columns.append(replace(column, title=title, span_rad_s=zoom_rad_s))
    return plot_columns(columns, aliasing_limit_hz=aliasing_limit_hz)


def plot_columns(columns: Sequence[Column], *, aliasing_limit_hz: float | None = None) -> "Figure":
    """Return a figure of Bode diagrams side by side, under one legend."""
    with house_style():
        figure = new_figure(11.5)
        grid = figure.subplots(2, len(columns), squeeze=False, sharex="col")
        entries: dict[str, Handle] = {}
        for index, column in enumerate(columns):
            pair = (grid[0, index], grid[1, index])
            entries |= _draw_column(pair, column, aliasing_limit_hz)
            letter = f"({chr(ord('a') + index)}) " if len(columns) > 1 else ""
            pair[0].set_title(f"{letter}{column.title}")
            pair[1].set_xlabel("frequency [rad/s]")
        grid[0, 0].set_ylabel("magnitude [dB re 1 s]" if columns[0].output == "E_n" else "magnitude [dB]")
        grid[1, 0].set_ylabel("phase [deg]")
        figure.align_ylabels(grid[:, 0])
        legend_below(figure, entries)
        return figure


def _draw_column(pair: "tuple[Axes, Axes]", column: Column, aliasing_limit_hz: float | None) -> dict[str, Handle]:
    """Draw one output over one span into a magnitude and a phase panel; return the legend's entries."""
    entries: dict[str, Handle] = {}
    span = column.span_rad_s or column.whole_span()
    full_span = column.whole_span()
    omega = np.geomspace(min(span[0], full_span[0]), max(span[1], full_span[1]), GRID_POINTS)
    traces = [trace_of(curve, column.output, omega, column.cause) for curve in column.curves]
    for index, (curve, trace) in enumerate(zip(column.curves, traces, strict=True)):
        entries |= draw_trace(pair, curve, trace, column.output, look(index), cause=column.cause)
    for index, (label, response) in enumerate(column.data.items()):
        style = look(index) if len(column.data) > 1 else None
        aside = SIDEWAYS ** (index - 0.5 * (len(column.data) - 1))
        entries |= draw_data(
            pair, response, column.output, traces, style=style, label=label, sideways=aside, cause=column.cause
        )
    for axes in pair:
        if aliasing_limit_hz is not None and 2.0 * np.pi * aliasing_limit_hz < span[1]:
            text = f"aliasing limit of the speed, {aliasing_limit_hz:.2f} Hz"
            entries[text] = axes.axvline(
                2.0 * np.pi * aliasing_limit_hz,
                color=REFERENCE,
                linewidth=0.9,
                linestyle=(0.0, (1.0, 1.5)),
                label=text,
            )
        plain_log_axis(axes)
        axes.set_xlim(*span)
    _set_limits(pair, column, traces, span)
    return entries


def _set_limits(
    pair: "tuple[Axes, Axes]", column: Column, traces: Sequence["Trace"], span: tuple[float, float]
) -> None:
    """Let the axes hold all points, and the models as far as they are not far from them."""
    magnitudes, phases = [np.empty(0)], [np.empty(0)]
    for response in column.data.values():
        inside = (response.omega_rad_s >= span[0]) & (response.omega_rad_s <= span[1])
        index = channel_of(response.outputs, response.inputs, column.output, column.cause)
        magnitudes.append(measured_points(response, index).magnitude_db[inside])
        phases.append(measured_phase_deg(response, index, traces)[inside])
    seen = [(trace.omega_rad_s >= span[0]) & (trace.omega_rad_s <= span[1]) for trace in traces]
    for axes, points, lines, beyond in (
        (pair[0], magnitudes, [t.magnitude_db[i] for t, i in zip(traces, seen, strict=True)], BEYOND_DB),
        (pair[1], phases, [t.phase_deg[i] for t, i in zip(traces, seen, strict=True)], BEYOND_DEG),
    ):
        measured = np.concatenate(points)
        drawn = np.concatenate([*lines, np.empty(0)])
        if measured.size:
            drawn = np.clip(drawn, measured.min() - beyond, measured.max() + beyond)
        drawn = np.concatenate([drawn, measured])
        width = max(float(np.ptp(drawn)), 1.0)
        axes.set_ylim(float(drawn.min()) - ROOM * width, float(drawn.max()) + ROOM * width)
