"""Shapes of the torsional modes along the line."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.digits import plain, with_deviation
from shaftprint.report.charts._chart import Chart, Panel, Scale
from shaftprint.report.charts._marks import Line, Mark, Points, Straight

if TYPE_CHECKING:
    from shaftprint.arrays import FloatArray
    from shaftprint.torsion._line import TorsionalLine
    from shaftprint.torsion._modes import Modes

SHOWN = 4
BESIDE = 0.5
HIGHEST = 1.15


def mode_chart(modes: "Modes", *, shown: int = SHOWN) -> Chart:
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
    chain, branches = _layout(line)
    across = np.zeros(len(line.bodies))
    across[chain] = np.arange(len(chain))
    for body, carrier in branches:
        across[body] = across[carrier] + BESIDE
    bodies = Scale(names=[line.bodies[body] for body in chain])
    amplitude = Scale(title="amplitude [-]", span=(-HIGHEST, HIGHEST))
    panels = [
        Panel(title=_title(modes, mode), marks=_shape(modes, mode, chain, branches, across), x=bodies, y=amplitude)
        for mode in range(min(shown, len(modes.frequency_hz)))
    ]
    return Chart(panels=panels, heights_px=(150,))


def _title(modes: "Modes", mode: int) -> str:
    frequency = with_deviation(float(modes.frequency_hz[mode]), float(modes.frequency_std_hz[mode]))
    return f"{frequency} Hz, damping ratio {plain(float(modes.damping_ratio[mode]), 3)}"


def _shape(
    modes: "Modes", mode: int, chain: list[int], branches: list[tuple[int, int]], across: "FloatArray"
) -> list[Mark]:
    line, shape = modes.line, modes.shape[mode].real
    marks: list[Mark] = [
        Straight(at=0.0, axis="y", dash="solid"),
        *_gauge(line, across),
        Line(x=across[chain], y=shape[chain], name="line", marker="circle"),
    ]
    for shade, (body, carrier) in enumerate(branches, start=1):
        way = [carrier, body]
        marks.append(Line(x=across[way], y=shape[way], shade=shade, width=1.5))
        marks.append(Points(x=across[[body]], y=shape[[body]], name=f"branch: {line.bodies[body]}", shade=shade))
    return marks


def _gauge(line: "TorsionalLine", across: "FloatArray") -> list[Mark]:
    """Return where the torque gauge sits; nothing where it is on a body, of which no picture shows which part."""
    if line.gauge is None:
        return []
    at = float(np.mean(across[list(line.links[line.gauge].between)]))
    return [Straight(at=at, axis="x", name="torque gauge")]


def _layout(line: "TorsionalLine") -> tuple[list[int], list[tuple[int, int]]]:
    """Return the bodies from the engine's free end to the propeller, and the other bodies with what carries each."""
    propeller = int(np.argmax(line.load_nm_s_rad if line.gauge is None else line.inertia_kg_m2 * line.is_downstream))
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
