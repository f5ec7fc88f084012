"""Sensitivity of a structure: Bode families with one parameter varied at a time."""

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import StructureError
from shaftprint.report._curve import Curve
from shaftprint.report.figures._bode_parts import channel_of, draw_data, measured_phase_deg, trace_of
from shaftprint.report.figures._style import RAMP_DASHES, house_style, new_figure, plain_log_axis, plain_number, ramp
from shaftprint.report.figures._uncertainty import measured_points
from shaftprint.report.notation import mathtext, response_label
from shaftprint.tables import unit_text

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from shaftprint.models import Parameter, Structure
    from shaftprint.spectra import FrequencyResponse

STEPS = 5
# What a meaning explains after its first words: too long for a title.
_TAIL = re.compile(r"[,:;].*")
GRID_POINTS = 500
SPAN_RAD_S = (0.01, 300.0)
ROW_CM = 3.9
FOOT_CM = 1.2
# Magnitudes farther below the largest than this are let go: at a bound of 0 the response may vanish altogether.
DEPTH_DB = 90.0
BEYOND_DATA_DB = 15.0
BEYOND_DATA_DEG = 200.0
ROOM = 0.05


def parameter_steps(parameter: "Parameter", steps: int = STEPS) -> FloatArray:
    """Return evenly spaced values of a parameter from its lower to its upper bound, shape (steps,)."""
    return np.linspace(parameter.lower, parameter.upper, steps)


def plot_sensitivity(
    structure: "Structure",
    *,
    output: str | None = None,
    cause: str | None = None,
    vary: Sequence[str] | None = None,
    values: "Mapping[str, float] | None" = None,
    data: "FrequencyResponse | None" = None,
    span_rad_s: tuple[float, float] = SPAN_RAD_S,
) -> "Figure":
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
    varied = _varied(structure, (name, cause), vary)
    base = structure.vector(values or {})
    count = len(varied)
    with house_style():
        figure = new_figure(ROW_CM * count + FOOT_CM)
        grid = figure.subplots(count, 2, squeeze=False, sharex=True)
        for row, parameter in enumerate(varied):
            _draw_row((grid[row, 0], grid[row, 1]), structure, (name, cause), parameter, base, data, span_rad_s)
            letter = f"({chr(ord('a') + row)}) " if count > 1 else ""
            grid[row, 0].set_title(f"{letter}{mathtext(parameter.name)}: {_TAIL.sub('', parameter.meaning)}")
            grid[row, 0].set_ylabel("magnitude [dB re 1 s]" if name == "E_n" else "magnitude [dB]")
            grid[row, 1].set_ylabel("phase [deg]")
        for axes in grid[-1]:
            axes.set_xlabel("frequency [rad/s]")
        figure.suptitle(f"{structure.title}: {response_label(name, cause)}", x=0.01, ha="left")
        figure.align_ylabels()
        return figure


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


def _draw_row(
    pair: "tuple[Axes, Axes]",
    structure: "Structure",
    channel: tuple[str, str],
    parameter: "Parameter",
    base: FloatArray,
    data: "FrequencyResponse | None",
    span: tuple[float, float],
) -> None:
    """Draw the family of one parameter into a magnitude and a phase panel."""
    omega = np.geomspace(*span, GRID_POINTS)
    index = structure.names.index(parameter.name)
    for value, colour, dashes in zip(parameter_steps(parameter), ramp(STEPS), RAMP_DASHES, strict=True):
        table = base.copy()
        table[index] = value
        label = f"{plain_number(value)} {unit_text(parameter.unit)}".strip()
        with np.errstate(divide="ignore"):
            trace = trace_of(Curve(label=label, structure=structure, values=table), channel[0], omega, channel[1])
        silent = not np.any(np.isfinite(trace.magnitude_db))
        phase = np.full_like(trace.phase_deg, np.nan) if silent else trace.phase_deg
        pair[0].plot(omega, trace.magnitude_db, color=colour, linestyle=dashes)
        pair[1].plot(omega, phase, color=colour, linestyle=dashes, label=f"{label}, no response" if silent else label)
    _limit(pair, data, channel)
    if data is not None:
        draw_data(pair, data, channel[0], (), label="data", cause=channel[1])
    for axes in pair:
        plain_log_axis(axes)
        axes.set_xlim(*span)
    pair[1].legend(loc="center left", bbox_to_anchor=(1.01, 0.5), title=mathtext(parameter.name), borderaxespad=0.0)


def _limit(pair: "tuple[Axes, Axes]", data: "FrequencyResponse | None", channel: tuple[str, str]) -> None:
    """Let go of lines that leave all others, or the data, far behind."""
    low, high = pair[0].get_ylim()
    pair[0].set_ylim(max(low, high - DEPTH_DB), high)
    if data is None:
        return
    index = channel_of(data.outputs, data.inputs, *channel)
    for axes, points, beyond in (
        (pair[0], measured_points(data, index).magnitude_db, BEYOND_DATA_DB),
        (pair[1], measured_phase_deg(data, index), BEYOND_DATA_DEG),
    ):
        low, high = axes.get_ylim()
        least, most = float(points.min()), float(points.max())
        low, high = max(min(low, least), least - beyond), min(max(high, most), most + beyond)
        axes.set_ylim(low - ROOM * (high - low), high + ROOM * (high - low))
