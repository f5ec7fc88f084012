"""Sister ships side by side along each cause, in the order of their sizes: a caterpillar plot."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.distributions import NORMAL_95
from shaftprint.report.charts._chart import Chart, Panel, Scale
from shaftprint.report.charts._marks import Band, Mark, Points, Straight

if TYPE_CHECKING:
    from shaftprint.drift._class_finding import CauseSpread, ClassFinding

SHIP_PX, PANEL_PX, COLUMNS = 22, 90, 2
HALF = 0.5


def sister_chart(finding: "ClassFinding") -> Chart:
    """Return where each ship of a class stands along each cause, with the band that holds 95 % of sisters.

    Parameters
    ----------
    finding
        What ``judge_sisters`` has found.

    Raises
    ------
    ValueError
        If nothing could be judged.
    """
    if not finding.causes:
        raise ValueError("sisters: expected a class that can be judged, found none.")
    panels = [_panel(finding, spread) for spread in finding.causes]
    height = PANEL_PX + SHIP_PX * len(finding.ships)
    return Chart(panels=panels, columns=COLUMNS, heights_px=(height,), linked="none")


def _panel(finding: "ClassFinding", spread: "CauseSpread") -> Panel:
    cause = spread.cause
    order = sorted(range(len(finding.ships)), key=lambda at: spread.ships[at].size)
    size, std, drawn = (
        np.array([cause.in_unit(getattr(spread.ships[at], name)) for at in order]) for name in ("size", "std", "shrunk")
    )
    places = np.arange(len(order), dtype=np.float64)
    is_odd = np.array([finding.ships[at].is_odd for at in order])
    half = cause.in_unit(spread.half_width)
    edge = np.array([-half, half])
    marks: list[Mark] = [
        Band(
            x=edge, lower=np.full(2, -HALF), upper=np.full(2, len(order) - HALF), name="95 % of sisters", shade="soft"
        ),
        Straight(at=0.0, axis="x", dash="solid"),
    ]
    kinds = ((~is_odd, "ship, with 95 % interval of its tests", True), (is_odd, "ship that is other", False))
    for chosen, name, filled in kinds:
        bars = NORMAL_95 * std[chosen]
        if chosen.any():
            marks.append(
                Points(
                    x=size[chosen], y=places[chosen], name=name, shade="data", filled=filled, bars=(bars, bars),
                    bars_along="x",
                )
            )  # fmt: skip
    marks.append(Points(x=drawn, y=places, name="drawn to the class", shade=1, marker="x", size=5.0))
    names = tuple(finding.ships[at].name for at in order)
    return Panel(
        marks=marks,
        title=cause.name,
        x=Scale(title=f"difference from the class [{cause.unit}]"),
        y=Scale(names=names, span=(-HALF, len(order) - HALF)),
    )
