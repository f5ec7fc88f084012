"""Sensitivity of a structure: Bode families with one parameter varied at a time."""

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.digits import unit_text
from shaftprint.errors import StructureError
from shaftprint.plain_table import Symbol
from shaftprint.report._curve import Curve
from shaftprint.report.charts._chart import Chart, Panel, Scale
from shaftprint.report.charts._marks import Line, Mark, Points
from shaftprint.report.charts._text import joined
from shaftprint.report.figures._bode import ENDLESS_DB, GRID_POINTS, frequency_scale
from shaftprint.report.figures._traces import channel_of, measured_phase_deg, trace_of
from shaftprint.report.figures._uncertainty import measured_points

if TYPE_CHECKING:
    from collections.abc import Mapping

    from shaftprint.models._parameter import Parameter
    from shaftprint.models._structure import Structure
    from shaftprint.spectra._frequency_response import FrequencyResponse

STEPS = ("lower bound", "a quarter up", "half way", "three quarters up", "upper bound")
# What a meaning explains after its first words: too long for a title.
_TAIL = re.compile(r"[,:;].*")
SPAN_RAD_S = (0.01, 300.0)
# Magnitudes farther below the largest than this are let go: at a bound of 0 the response may vanish altogether.
DEPTH_DB = 90.0
# So are phases: delays turn on for ever.
DEPTH_DEG = 720.0
BEYOND_DATA_DB = 15.0
BEYOND_DATA_DEG = 200.0
ROOM = 0.05


def parameter_steps(parameter: "Parameter") -> FloatArray:
    """Return evenly spaced values of a parameter from its lower to its upper bound, one for each of ``STEPS``."""
    return np.linspace(parameter.lower, parameter.upper, len(STEPS))


def sensitivity_chart(
    structure: "Structure",
    *,
    output: str | None = None,
    cause: str | None = None,
    vary: Sequence[str] | None = None,
    values: "Mapping[str, float] | None" = None,
    data: "FrequencyResponse | None" = None,
    span_rad_s: tuple[float, float] = SPAN_RAD_S,
) -> Chart:
    """Return the Bode families of a structure, one row a parameter, each varied between its bounds.

    The other parameters keep their values. With the thesis' structures (``thesis_families``) these are its figures 4.2
    to 4.8, B.1 to B.4 and D.1.

    Parameters
    ----------
    structure
        The structure; bounds and values are those of its parameters.
    output
        Output to draw; the first by default.
    cause
        Input to which it is drawn; the first by default.
    vary
        Names of the parameters to vary; the free ones by default.
    values
        Values of the parameters that are not varied; their defaults where not given.
    data
        Measured response, drawn with its intervals into every row.
    span_rad_s
        Frequencies to draw [rad/s].

    Raises
    ------
    StructureError
        If output, input or parameters are not of the structure, or nothing is left to vary.
    """
    name, cause = output or next(iter(structure.outputs)), cause or structure.input
    base = structure.vector(values or {})
    pairs = [
        _pair(structure, (name, cause), parameter, base, data, span_rad_s)
        for parameter in _varied(structure, (name, cause), vary)
    ]
    return Chart(panels=[panel for pair in pairs for panel in pair], columns=2, heights_px=(200,))


def _varied(structure: "Structure", channel: tuple[str, str], vary: Sequence[str] | None) -> "tuple[Parameter, ...]":
    for kind, name, there in zip(("output", "input"), channel, (structure.outputs, structure.inputs), strict=True):
        if name not in there:
            raise StructureError(f"structure {structure.name} has no {kind} {name}; it has {', '.join(there)}.")
    parameters = {parameter.name: parameter for parameter in structure.parameters}
    wanted = [parameter.name for parameter in structure.free] if vary is None else list(vary)
    unknown = [name for name in wanted if name not in parameters]
    if unknown or not wanted:
        raise StructureError(
            f"structure {structure.name}: expected parameters to vary out of {', '.join(parameters)}, found "
            f"{', '.join(unknown) or 'none'}."
        )
    return tuple(parameters[name] for name in wanted)


def _pair(
    structure: "Structure",
    channel: tuple[str, str],
    parameter: "Parameter",
    base: FloatArray,
    data: "FrequencyResponse | None",
    span: tuple[float, float],
) -> tuple[Panel, Panel]:
    """Return the family of one parameter: magnitude and phase, with its values in the title."""
    omega = np.geomspace(*span, GRID_POINTS)
    index = structure.names.index(parameter.name)
    magnitudes: list[Mark] = []
    phases: list[Mark] = []
    steps = parameter_steps(parameter)
    for shade, (name, value) in enumerate(zip(STEPS, steps, strict=True)):
        table = base.copy()
        table[index] = value
        with np.errstate(divide="ignore"):
            trace = trace_of(Curve(label="", structure=structure, values=table), channel[0], omega, channel[1])
        silent = not np.any(np.isfinite(trace.magnitude_db))
        magnitudes.append(Line(x=omega, y=trace.magnitude_db, name=name, shade=shade))
        turned = np.full_like(trace.phase_deg, np.nan) if silent else trace.phase_deg
        phases.append(Line(x=omega, y=turned, name=name, shade=shade))
    limits = _limits(magnitudes, phases, data, channel)
    if data is not None:
        _add_data(magnitudes, phases, data, channel)
    unit = unit_text(parameter.unit)
    numbers = ", ".join(f"{value:g}" for value in steps).replace("-", "−")
    values_text = joined(Symbol(parameter.name), f" = {numbers} {unit}".rstrip())
    level = "magnitude [dB re 1 s]" if channel[0] == "E_n" else "magnitude [dB]"
    return (
        Panel(
            title=joined(Symbol(parameter.name), f": {_TAIL.sub('', parameter.meaning)}"),
            marks=magnitudes,
            x=frequency_scale(span),
            y=Scale(title=level, span=limits[0]),
        ),
        Panel(title=values_text, marks=phases, x=frequency_scale(span), y=Scale(title="phase [deg]", span=limits[1])),
    )


def _add_data(magnitudes: list[Mark], phases: list[Mark], data: "FrequencyResponse", channel: tuple[str, str]) -> None:
    index = channel_of(data.outputs, data.inputs, *channel)
    points, phase = measured_points(data, index), measured_phase_deg(data, index)
    used = data.used
    bars = np.minimum(points.below_db, ENDLESS_DB)[used], points.above_db[used]
    turns = points.phase_half_deg[used], points.phase_half_deg[used]
    name = "data, 95 % interval"
    magnitudes.append(Points(x=data.omega_rad_s[used], y=points.magnitude_db[used], bars=bars, name=name))
    phases.append(Points(x=data.omega_rad_s[used], y=phase[used], bars=turns, name=name))


def _limits(
    magnitudes: list[Mark], phases: list[Mark], data: "FrequencyResponse | None", channel: tuple[str, str]
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the ends of both axes, which let go of lines that leave all others, or the data, far behind."""
    ends = []
    for marks in (magnitudes, phases):
        drawn = np.concatenate([mark.y for mark in marks if isinstance(mark, Line)])
        drawn = drawn[np.isfinite(drawn)]
        ends.append((float(drawn.min()), float(drawn.max())) if drawn.size else (-1.0, 1.0))
    ends = [(max(low, high - depth), high) for (low, high), depth in zip(ends, (DEPTH_DB, DEPTH_DEG), strict=True)]
    if data is not None:
        index = channel_of(data.outputs, data.inputs, *channel)
        points = measured_points(data, index).magnitude_db, measured_phase_deg(data, index)
        for place, beyond in enumerate((BEYOND_DATA_DB, BEYOND_DATA_DEG)):
            least, most = float(points[place][data.used].min()), float(points[place][data.used].max())
            low, high = ends[place]
            ends[place] = max(min(low, least), least - beyond), min(max(high, most), most + beyond)
    first, second = ((low - ROOM * (high - low), high + ROOM * (high - low)) for low, high in ends)
    return first, second
