"""The tests of a line over time: how far each is from the first along each cause, and what was done between them."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.distributions import NORMAL_95
from shaftprint.report.charts._chart import Chart, Panel, Scale
from shaftprint.report.charts._marks import Mark, Points, Straight

if TYPE_CHECKING:
    from datetime import datetime

    from shaftprint.drift._finding import SizedCause
    from shaftprint.drift._history import History

PANEL_PX = 150


def history_chart(history: "History", sizes: "Mapping[str, Sequence[SizedCause | None]]") -> Chart:
    """Return the size of each cause in every test with its 95 % interval, the first test being zero.

    Parameters
    ----------
    history
        The tests, and what was done to the ship.
    sizes
        Size of each cause against the first test, by the name of the cause, in the order of the tests; None for what
        cannot be judged.

    Raises
    ------
    ValueError
        If there is no cause.
    """
    years = np.array([_year(test.at) for test in history.tests])
    panels = [
        _panel(name, years, column, [_year(event.at) for event in history.events]) for name, column in sizes.items()
    ]
    if not panels:
        raise ValueError("history: expected a cause that can be judged, found none.")
    return Chart(panels=panels, heights_px=(PANEL_PX,))


def _panel(name: str, years: FloatArray, column: "Sequence[SizedCause | None]", events: Sequence[float]) -> Panel:
    there = [(year, one) for year, one in zip(years, column, strict=True) if one is not None]
    cause = there[0][1].cause
    x = np.array([year for year, _ in there])
    y, std = (np.array([cause.in_unit(getattr(one, field)) for _, one in there]) for field in ("size", "std"))
    marks: list[Mark] = [Straight(at=0.0, axis="y", dash="solid")]
    marks += [Straight(at=at, axis="x", name="what was done to the ship") for at in events]
    half = NORMAL_95 * std
    marks.append(Points(x=x, y=y, bars=(half, half), name="test, with 95 % interval", shade="data"))
    return Panel(marks=marks, title=name, x=Scale(title="year"), y=Scale(title=f"change [{cause.unit}]"))


def _year(at: "datetime") -> float:
    """Return a time as a year with its fraction."""
    begin = at.replace(month=1, day=1, hour=0, minute=0, second=0, microsecond=0)
    return at.year + (at - begin) / (begin.replace(year=at.year + 1) - begin)
