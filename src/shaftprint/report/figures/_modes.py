"""Shapes of the torsional modes along the line."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.report.figures._style import (
    FONT_PT,
    REFERENCE,
    house_style,
    legend_below,
    legend_entries,
    letter_panels,
    look,
    new_figure,
)
from shaftprint.tables import plain, with_deviation

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from shaftprint.arrays import FloatArray
    from shaftprint.torsion import Modes, TorsionalLine

SHOWN = 4
PANEL_CM, NAMES_CM = 3.1, 5.4
BESIDE = 0.5


def plot_modes(modes: "Modes", *, shown: int = SHOWN) -> "Figure":
    """Return the shapes of the slowest modes, one panel each, with frequency and damping ratio in the title.

    The bodies stand in the order of the line from the engine's free end to the propeller; what branches off, such as
    the ring of a damper, stands half a place beside the body that carries it. Amplitudes are angles at the propeller
    shaft, 1 where the largest is, at the moment when that body is farthest out.

    Parameters
    ----------
    modes
        Modes of a line.
    shown
        How many, from the slowest on.
    """
    line = modes.line
    count = min(shown, len(modes.frequency_hz))
    chain, branches = _layout(line)
    across = np.zeros(len(line.bodies))
    across[chain] = np.arange(len(chain))
    for body, carrier in branches:
        across[body] = across[carrier] + BESIDE
    with house_style():
        figure = new_figure(PANEL_CM * count + NAMES_CM)
        panels = list(np.atleast_1d(figure.subplots(count, 1, sharex=True, sharey=True)))
        for mode, axes in enumerate(panels):
            _draw(axes, modes, mode, chain, branches, across)
        letter_panels(panels, [_title(modes, mode) for mode in range(count)])
        panels[-1].set_xticks(across, labels=line.bodies, rotation=90)
        figure.supylabel("amplitude at the propeller shaft [-]", fontsize=FONT_PT)
        legend_below(figure, legend_entries(panels))
        return figure


def _title(modes: "Modes", mode: int) -> str:
    frequency = with_deviation(float(modes.frequency_hz[mode]), float(modes.frequency_std_hz[mode]))
    return f"{frequency} Hz, damping ratio {plain(float(modes.damping_ratio[mode]), 3)}"


def _draw(
    axes: "Axes", modes: "Modes", mode: int, chain: list[int], branches: list[tuple[int, int]], across: "FloatArray"
) -> None:
    line, shape = modes.line, modes.shape[mode].real
    main, branch = look(0), look(1)
    axes.axhline(0.0, color=REFERENCE, linewidth=0.7)
    gauge = float(np.mean(across[list(line.links[line.gauge].between)]))
    axes.axvline(gauge, color=REFERENCE, linewidth=0.9, linestyle=(0.0, (1.0, 1.5)), label="torque gauge")
    axes.plot(across[chain], shape[chain], color=main.colour, marker=main.marker, markersize=3.5, label="line")
    for body, carrier in branches:
        axes.plot(
            across[[carrier, body]], shape[[carrier, body]], color=branch.colour, linestyle=branch.dashes, linewidth=0.9
        )
        axes.plot(
            across[body],
            shape[body],
            color=branch.colour,
            marker=branch.marker,
            markersize=3.5,
            linestyle="none",
            label="branch",
        )
    axes.set_ylim(-1.15, 1.15)


def _layout(line: "TorsionalLine") -> tuple[list[int], list[tuple[int, int]]]:
    """Return the bodies from the engine's free end to the propeller, and the other bodies with what carries each."""
    propeller = int(np.argmax(line.inertia_kg_m2 * line.is_downstream))
    came_from, compliance = _ways(line, propeller)
    springs = [body for body, soft in compliance.items() if np.isfinite(soft)]
    steps = {body: len(_way(body, came_from)) for body in springs}
    chain = _way(max(springs, key=lambda body: steps[body]), came_from)
    others = [(body, came_from[body]) for body in came_from if body not in chain]
    return chain, [(body, carrier) for body, carrier in others if carrier is not None]


def _ways(line: "TorsionalLine", start: int) -> tuple[dict[int, int | None], dict[int, float]]:
    """Return from where each body is reached, and the compliance on the way, infinite behind a damper."""
    came_from: dict[int, int | None] = {start: None}
    compliance = {start: 0.0}
    waiting = [start]
    while waiting:
        body = waiting.pop(0)
        for link in line.links:
            if body not in link.between:
                continue
            other = link.between[0] if link.between[1] == body else link.between[1]
            if other not in came_from:
                came_from[other] = body
                soft = 1.0 / link.stiffness_nm_rad if link.stiffness_nm_rad else np.inf
                compliance[other] = compliance[body] + soft
                waiting.append(other)
    return came_from, compliance


def _way(body: int, came_from: dict[int, int | None]) -> list[int]:
    """Return the bodies from one to where the search began."""
    bodies = [body]
    while (before := came_from[bodies[-1]]) is not None:
        bodies.append(before)
    return bodies
