"""Bode diagrams of measured responses and models, with intervals on data and bands on models."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray
from shaftprint.identify.uncertainty._band import model_band
from shaftprint.report.charts._chart import Chart, Panel, Scale
from shaftprint.report.charts._marks import Band, Line, Mark, Points, Shade, Straight
from shaftprint.report.charts._text import Text, joined, over
from shaftprint.report.figures._bode_range import FAR_DB, FAR_DEG, axis_span, beside, beyond_marks, bulk_of
from shaftprint.report.figures._phase import TURN_DEG, WRAPPED_SPAN_DEG, reads_better_wrapped, wrapped, wrapped_line
from shaftprint.report.figures._traces import Trace, channel_of, measured_phase_deg, trace_of
from shaftprint.report.figures._uncertainty import measured_points

if TYPE_CHECKING:
    from shaftprint.report._curve import Curve
    from shaftprint.spectra._frequency_response import FrequencyResponse

GRID_POINTS = 301
# Bands are smoother than lines: every third point will do, and keeps the file small.
BAND_STEP = 3
DEFAULT_SPAN = (0.02, 300.0)
# How much wider than the data the picture is.
WIDER = 1.4
# Points of several responses at one frequency stand side by side, this factor apart.
SIDEWAYS = 1.12
# Stands for an error bar without end.
ENDLESS_DB = 500.0
TURN_STEP_DEG = 90.0
HEIGHTS_PX = (260, 220)
BELOW_PX = 170


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Column:
    """One column of a Bode diagram: magnitude above, phase below."""

    title: Text
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


def bode_chart(
    curves: Sequence["Curve"] = (),
    *,
    data: "FrequencyResponse | Mapping[str, FrequencyResponse] | None" = None,
    aliasing_limit_hz: float | None = None,
    outputs: Sequence[str] | None = None,
    span_rad_s: tuple[float, float] | None = None,
    zoom_rad_s: tuple[float, float] | None = None,
) -> Chart:
    """Return a Bode diagram of models and data: rad/s, dB, degrees, 95 % intervals and bands.

    A phase of more than a turn and a half is drawn between -270 and 90 degrees, where it can be read.

    Parameters
    ----------
    curves
        Models; a band is drawn around those with a covariance.
    data
        Measured response, or several by their label; lines that are not used are drawn as hollow markers.
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
    measured = data if isinstance(data, Mapping) else {} if data is None else {"data": data}
    if not curves and not measured:
        raise ValueError("a Bode diagram needs a model or data, found neither.")
    first = next(iter(measured.values())) if measured else curves[0].structure
    columns = []
    for name, cause in product(outputs or tuple(first.outputs), first.inputs):
        title = over(name, cause)
        column = Column(title=title, output=name, cause=cause, curves=curves, data=measured, span_rad_s=span_rad_s)
        columns.append(column)
        if zoom_rad_s is not None:
            title = joined(title, f", {zoom_rad_s[0]:g} to {zoom_rad_s[1]:g} rad/s")
            columns.append(replace(column, title=title, span_rad_s=zoom_rad_s))
    return columns_chart(columns, aliasing_limit_hz=aliasing_limit_hz)


def columns_chart(
    columns: Sequence[Column], *, aliasing_limit_hz: float | None = None, below: Sequence[Panel] = ()
) -> Chart:
    """Return Bode diagrams side by side, under one legend.

    ``columns``: what is drawn, from the left. ``aliasing_limit_hz``: half the pulse rate of the speed sensor [Hz].
    ``below``: a further panel below each column, or none.
    """
    pairs = [_panels(column, aliasing_limit_hz, is_first=number == 0) for number, column in enumerate(columns)]
    rows = [*zip(*pairs, strict=True), tuple(below)]
    same = len({column.span_rad_s or column.whole_span() for column in columns}) == 1
    return Chart(
        panels=[panel for row in rows for panel in row],
        columns=len(columns),
        heights_px=(*HEIGHTS_PX, BELOW_PX) if below else HEIGHTS_PX,
        linked="all" if same else "columns",
    )


def frequency_scale(span: tuple[float, float]) -> Scale:
    """Return the horizontal axis of a response: rad/s, logarithmic."""
    return Scale(title="frequency [rad/s]", log=True, span=span)


def _panels(column: Column, aliasing_limit_hz: float | None, *, is_first: bool) -> tuple[Panel, Panel]:
    """Return magnitude and phase of one output over one span."""
    span, whole = column.span_rad_s or column.whole_span(), column.whole_span()
    omega = np.geomspace(min(span[0], whole[0]), max(span[1], whole[1]), GRID_POINTS)
    traces = [trace_of(curve, column.output, omega, column.cause) for curve in column.curves]
    limits = _limits(column, traces, span)
    wraps = reads_better_wrapped(limits[1])
    pair: tuple[list[Mark], list[Mark]] = ([], [])
    for shade, (curve, trace) in enumerate(zip(column.curves, traces, strict=True)):
        _add_model(pair, column, curve, trace, shade, wraps=wraps)
    for place, label in enumerate(column.data):
        _add_data(pair, column, traces, place, label, wraps=wraps)
    ends = limits[0], WRAPPED_SPAN_DEG if wraps else limits[1]
    for marks, end in zip(pair, ends, strict=True):
        marks.extend(beyond_marks([m for m in marks if isinstance(m, Points)], end, span))
    if aliasing_limit_hz is not None and 2.0 * np.pi * aliasing_limit_hz < span[1]:
        text = f"aliasing limit of the speed, {aliasing_limit_hz:.2f} Hz"
        for marks in pair:
            marks.append(Straight(at=2.0 * np.pi * aliasing_limit_hz, axis="x", name=text))
    level = "magnitude [dB re 1 s]" if column.output == "E_n" else "magnitude [dB]"
    turn = Scale(
        title="phase [deg]" if is_first else "",
        span=ends[1],
        step=TURN_STEP_DEG if wraps or np.ptp(limits[1]) > 2.0 * TURN_STEP_DEG else None,
    )
    return (
        Panel(
            title=column.title,
            marks=pair[0],
            x=frequency_scale(span),
            y=Scale(title=level if is_first else "", span=ends[0]),
        ),
        Panel(marks=pair[1], x=frequency_scale(span), y=turn),
    )


def _add_model(
    pair: tuple[list[Mark], list[Mark]], column: Column, curve: "Curve", trace: Trace, shade: Shade, *, wraps: bool
) -> None:
    """Add a model's line, and its band where it has a covariance."""
    name = curve.label
    phase = wrapped_line(trace.phase_deg) if wraps else trace.phase_deg
    if curve.covariance is not None:
        at = channel_of(curve.structure.outputs, curve.structure.inputs, column.output, column.cause)
        few = slice(None, None, BAND_STEP)
        omega = trace.omega_rad_s[few]
        band = model_band(curve.structure, curve.values, curve.covariance, omega / (2.0 * np.pi))
        halves = (band.magnitude_upper_db - band.magnitude_db)[at], (band.phase_upper_deg - band.phase_deg)[at]
        if np.isfinite(halves).all():
            words = f"{curve.label}, {100.0 * band.coverage:g} % band"
            for marks, middle, half in zip(pair, (trace.magnitude_db[few], phase[few]), halves, strict=True):
                marks.append(Band(x=omega, lower=middle - half, upper=middle + half, name=words, shade=shade))
        else:
            name = f"{curve.label}, no band"
    for marks, values in zip(pair, (trace.magnitude_db, phase), strict=True):
        marks.append(Line(x=trace.omega_rad_s, y=values, name=name, shade=shade))


def _add_data(
    pair: tuple[list[Mark], list[Mark]],
    column: Column,
    traces: Sequence[Trace],
    place: int,
    label: str,
    *,
    wraps: bool,
) -> None:
    """Add a measured response with 95 % intervals, used lines filled, the others hollow.

    Used lines that noise may have made alone are pale and have no interval: theirs reach out of any diagram, and hide
    the others.
    """
    data = column.data[label]
    index = channel_of(data.outputs, data.inputs, column.output, column.cause)
    points = measured_points(data, index)
    phase = measured_phase_deg(data, index, traces)
    phase = wrapped(phase) if wraps else _seen_with(phase, data.used)
    below = np.minimum(points.below_db, ENDLESS_DB)
    aside = SIDEWAYS ** (place - 0.5 * (len(column.data) - 1))
    drowned = data.used & np.isinf(points.below_db)
    own: Shade = "data" if len(column.data) == 1 else place
    for chosen, filled, shade, text in (
        (data.used & ~drowned, True, own, f"{label}, 95 % interval"),
        (drowned, True, "soft", f"{label}, weaker than noise"),
        (~data.used, False, own, f"{label}, line not used"),
    ):
        if not chosen.any():
            continue
        has_bars = shade == own
        for marks, middle, bars in (
            (pair[0], points.magnitude_db, (below, points.above_db)),
            (pair[1], phase, (points.phase_half_deg, points.phase_half_deg)),
        ):
            marks.append(
                Points(
                    x=aside * data.omega_rad_s[chosen],
                    y=middle[chosen],
                    name=text,
                    shade=shade,
                    filled=filled,
                    bars=(bars[0][chosen], bars[1][chosen]) if has_bars else None,
                    words=[line for line, is_shown in zip(data.lines, chosen, strict=True) if is_shown],
                )
            )


def _seen_with(phase_deg: FloatArray, used: BoolArray) -> FloatArray:
    """Return phases [deg], those of lines that are not used by whole turns nearest to the last used one."""
    last = phase_deg[used][-1:] if used.any() else phase_deg[:1]
    return np.where(used, phase_deg, phase_deg + TURN_DEG * np.round((last - phase_deg) / TURN_DEG))


def _limits(
    column: Column, traces: Sequence[Trace], span: tuple[float, float]
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the ends of both vertical axes: the bulk of the points, and the models as far as they are not far."""
    measured: tuple[list[FloatArray], list[FloatArray]] = ([], [])
    for response in column.data.values():
        index = channel_of(response.outputs, response.inputs, column.output, column.cause)
        points, at = measured_points(response, index), np.log(response.omega_rad_s)
        phase = _seen_with(measured_phase_deg(response, index, traces), response.used)
        inside = (response.omega_rad_s >= span[0]) & (response.omega_rad_s <= span[1])
        lines = [(np.log(trace.omega_rad_s), trace.magnitude_db, trace.phase_deg) for trace in traces]
        for place, (values, half, far) in enumerate(
            ((points.magnitude_db, points.below_db, FAR_DB), (phase, points.phase_half_deg, FAR_DEG))
        ):
            modelled = np.array([np.interp(at, line[0], line[1 + place]) for line in lines])
            expected = modelled if lines else beside(at, values, response.used & (half < far))
            measured[place].append(values[inside & bulk_of(values, half, response.used, expected, far)])
    seen = [(trace.omega_rad_s >= span[0]) & (trace.omega_rad_s <= span[1]) for trace in traces]
    levels = [t.magnitude_db[i] for t, i in zip(traces, seen, strict=True)]
    turns = [t.phase_deg[i] for t, i in zip(traces, seen, strict=True)]
    return axis_span(measured[0], levels, FAR_DB), axis_span(measured[1], turns, FAR_DEG)
