"""Differences of fingerprints as points with intervals, in percent of the first."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.plain_table import Symbol
from shaftprint.report.charts._chart import Chart, Panel, Scale
from shaftprint.report.charts._marks import Mark, Points, Straight
from shaftprint.units import PERCENT

if TYPE_CHECKING:
    from shaftprint.report.comparison._differences import Difference

ROW_PX, FRAME_PX = 30, 20
APART = 0.5


def in_percent(difference: "Difference") -> tuple[float, float, float] | None:
    """Return a difference and the ends of its interval in percent of the first number; None where there are none.

    A number in percent already is one of another, whose percent would say nothing.
    """
    if difference.first.unit == "%" or difference.interval_95 is None or difference.first.value == 0.0:
        return None
    scale = PERCENT / abs(difference.first.value)
    low, high = difference.interval_95
    return scale * difference.value, scale * low, scale * high


def difference_chart(found: Mapping[str, Sequence["Difference"]]) -> Chart:
    """Return differences in percent of the first fingerprint, each with its 95 % interval.

    Parameters
    ----------
    found
        Differences from the first fingerprint, by the name of the other.

    Raises
    ------
    ValueError
        If there is no number that can be shown in percent.
    """
    names = shown_names(found)
    if not names:
        raise ValueError("differences: expected a number that both fingerprints know, found none.")
    marks: list[Mark] = [Straight(at=0.0, axis="x", dash="solid")]
    for index, (label, differences) in enumerate(found.items()):
        shown = [(d, percent) for d in differences if (percent := shown_percent(d)) is not None]
        places = np.array([names.index(d.first.name) for d, _ in shown], dtype=np.float64)
        value, low, high = np.array([percent for _, percent in shown]).reshape(-1, 3).T
        marks.append(
            Points(
                x=value,
                y=places + APART * ((index + 0.5) / len(found) - 0.5),
                bars=(value - low, high - value),
                bars_along="x",
                name=label,
                shade=index,
                words=[d.outcome for d, _ in shown],
            )
        )
    return Chart(
        panels=(
            Panel(
                marks=marks,
                x=Scale(title="difference, with 95 % interval [%]"),
                y=Scale(names=[Symbol(name) for name in names], span=(len(names) - 0.5, -0.5)),
            ),
        ),
        heights_px=(ROW_PX * len(names) + FRAME_PX,),
    )


def shown_names(found: Mapping[str, Sequence["Difference"]]) -> list[str]:
    """Return the names of the numbers that can be shown in percent, in their order."""
    return list(dict.fromkeys(d.first.name for ds in found.values() for d in ds if shown_percent(d) is not None))


def shown_percent(difference: "Difference") -> tuple[float, float, float] | None:
    """Return what a figure shows of a difference: that of a number which stands for the ship, in percent."""
    return None if difference.normalised else in_percent(difference)
