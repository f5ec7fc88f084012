"""Interactive plots of what the numbers stand on: profiles, uncertainty budget, residuals, signal-to-noise ratios."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.distributions import NORMAL_95
from shaftprint.identify.uncertainty import profile_curve
from shaftprint.report.figures import PERCENT, ROOM, THESIS_LIMIT_DB, normalised_residuals
from shaftprint.report.plots._panels import TWO_LEGEND_ROWS_PX, Grid, room_px
from shaftprint.report.plots._plot import Json, Plot
from shaftprint.report.plots._traces import MARKERS, colour, line, points, straight
from shaftprint.report.plots._words import axis_text, name_text

if TYPE_CHECKING:
    from shaftprint.identify import Identification
    from shaftprint.identify.uncertainty import Budget
    from shaftprint.spectra import Spectra

COLUMNS = 3
ROW_PX = 230
FRAME_PX = 120
BAR_PX = 26
SHAPES = ("", "/", ".")
COLOURS = 6
PARABOLA_POINTS = 41


def profile_plot(identification: "Identification") -> Plot:
    """Return a panel for each free parameter: the lowest cost at each of its values, and its parabola.

    Raises
    ------
    IdentificationError
        If the fit was not weighted by the covariance.
    """
    names = [parameter.name for parameter in identification.objective.free_parameters]
    curves = [profile_curve(identification, name) for name in names]
    rows, columns = -(-len(names) // COLUMNS), min(COLUMNS, len(names))
    titles = [axis_text(curve.name, curve.unit) for curve in curves]
    rises = ["rise of the cost [-]" if index % columns == 0 else "" for index in range(rows * columns)]
    grid = Grid(rows=rows, columns=columns, titles=titles, y_titles=rises, linked="none")
    layout = grid.layout()
    for index in range(len(names), rows * columns):
        for which in ("xaxis", "yaxis"):
            layout.pop(f"{which}{index + 1}")
    traces: list[Json] = []
    for index, curve in enumerate(curves):
        row, column = divmod(index, columns)
        axes, legend = grid.place(row, column), index == 0
        top = ROOM * curve.limit
        layout[grid.axis("y", row, column)]["range"] = [0.0, top]
        layout[grid.axis("x", row, column)]["nticks"] = 5
        ends = [float(curve.values[0]), float(curve.values[-1])]
        traces.append(straight("95 % interval below", axes, ends, [curve.limit] * 2, legend=legend))
        if np.isfinite(curve.std) and curve.values.size > 1:
            values = np.linspace(ends[0], ends[1], PARABOLA_POINTS)
            rise = 0.5 * ((values - curve.value) / curve.std) ** 2
            traces.append(line(values, rise, "parabola of the standard deviation", 1, axes, legend=legend))
        drawn = line(curve.values, curve.rise, "profile of the likelihood", 0, axes, legend=legend)
        traces.append(drawn | {"mode": "lines+markers", "marker": {"color": "@0", "size": 4}})
    return Plot(traces=traces, layout=layout, height_px=FRAME_PX + ROW_PX * rows)


def budget_plot(budget: "Budget") -> Plot:
    """Return one bar a number, divided by the share of each source in its variance.

    Raises
    ------
    ValueError
        If there is no number whose uncertainty is known.
    """
    rows = [row for row in budget.rows if row.shares]
    if not rows:
        raise ValueError("budget: expected a number whose uncertainty is known, found none.")
    names = [name_text(row.name) for row in rows]
    share = "share of the variance [%]"
    grid = Grid(x_titles=[share], below_px=TWO_LEGEND_ROWS_PX, left_px=room_px(names))
    traces: list[Json] = []
    for source in budget.sources:
        shares = [PERCENT * row.shares.get(source, 0.0) for row in rows]
        if not any(shares):
            continue
        number = len(traces)
        traces.append(
            {
                "type": "bar",
                "orientation": "h",
                "x": [round(share, 2) for share in shares],
                "y": names,
                "name": name_text(source),
                "marker": {"color": colour(number), "pattern": {"shape": SHAPES[number // COLOURS % len(SHAPES)]}},
                "hovertemplate": "%{y}: %{x:.1f} %",
                **grid.place(0, 0),
            }
        )
    layout = grid.layout(barmode="relative")
    layout["yaxis"] |= {"autorange": "reversed", "type": "category"}
    return Plot(traces=traces, layout=layout, height_px=FRAME_PX + 60 + BAR_PX * len(rows))


def residual_plot(identification: "Identification") -> Plot:
    """Return measured minus model over standard deviation at each fitted line, real and imaginary parts."""
    data, fitted = identification.response, identification.fitted
    residuals = normalised_residuals(identification)
    names = tuple(identification.fit_percent)
    below = ["residual over<br>standard deviation [-]"]
    grid = Grid(x_titles=["frequency [rad/s]"], y_titles=below, x_log=True, below_px=TWO_LEGEND_ROWS_PX)
    axes = grid.place(0, 0)
    omega = data.omega_rad_s[fitted]
    ends = [float(omega.min()), float(omega.max())]
    words = [name for name, shown in zip(data.lines, fitted, strict=True) if shown]
    text = f"95 % of a right model lies within ±{NORMAL_95:.2f}"
    traces = [straight(text, axes, ends, [sign * NORMAL_95] * 2, legend=sign > 0.0) for sign in (1.0, -1.0)]
    for row in range(residuals.shape[0]):
        part, channel = divmod(row, len(names))
        traces.append(
            points(
                omega,
                residuals[row, fitted],
                f"{'imaginary' if part else 'real'} part of {name_text(names[channel])}",
                axes,
                shade=colour(channel),
                marker="x" if part else MARKERS[channel % len(MARKERS)],
                words=words,
            )
        )
    return Plot(traces=traces, layout=grid.layout(), height_px=420)


def signal_to_noise_plot(spectra: "Spectra", *, aliasing_limit_hz: float | None = None) -> Plot:
    """Return the local signal-to-noise ratio of each line and channel, with the thesis' limit and the aliasing limit.

    Parameters
    ----------
    spectra
        Responses and signal-to-noise ratios.
    aliasing_limit_hz
        Half the pulse rate of the speed sensor [Hz].
    """
    ratios = spectra.signal_to_noise
    omega = 2.0 * np.pi * np.array([window.frequency_hz for window in spectra.windows])
    grid = Grid(x_titles=["frequency [rad/s]"], y_titles=["local signal-to-noise ratio [dB]"], x_log=True)
    axes = grid.place(0, 0)
    traces: list[Json] = []
    for index, channel in enumerate(ratios.channels):
        drawn = line(omega, ratios.local_db[:, index], name_text(channel), index, axes)
        marker = {"color": colour(index), "size": 7, "symbol": MARKERS[index % len(MARKERS)]}
        traces.append(drawn | {"mode": "lines+markers", "marker": marker, "text": list(ratios.lines)})
    ends = [float(omega.min()), float(omega.max())]
    traces.append(straight(f"{THESIS_LIMIT_DB:g} dB, the thesis' limit", axes, ends, [THESIS_LIMIT_DB] * 2))
    if aliasing_limit_hz is not None:
        at = 2.0 * np.pi * aliasing_limit_hz
        highest, lowest = float(np.nanmax(ratios.local_db)), float(min(np.nanmin(ratios.local_db), 0.0))
        text = f"aliasing limit of the speed, {aliasing_limit_hz:.2f} Hz"
        traces.append(straight(text, axes, [at, at], [lowest, highest]))
    return Plot(traces=traces, layout=grid.layout(), height_px=480)
