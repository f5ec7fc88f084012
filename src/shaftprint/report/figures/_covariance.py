"""How the uncertainty of the parameters hangs together, and where it comes from."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.plain_table import Symbol
from shaftprint.report.charts._chart import Chart, Panel, Scale
from shaftprint.report.charts._marks import Bars, Fields, Mark, Straight
from shaftprint.units import PERCENT

if TYPE_CHECKING:
    from shaftprint.identify.fit._identification import Identification
    from shaftprint.identify.uncertainty._budget import Budget

BAR_PX, FIELD_PX = 26, 30


def correlation_chart(identification: "Identification") -> Chart:
    """Return the correlation matrix of the free parameters; colour shows sign and strength, the number is written."""
    names = [Symbol(parameter.name) for parameter in identification.structure.free]
    correlation = identification.correlation
    words = [[_signed(value) for value in row] for row in correlation.tolist()]
    count = len(names)
    return Chart(
        panels=(
            Panel(
                marks=(Fields(values=correlation, words=words),),
                x=Scale(names=names, span=(-0.5, count - 0.5)),
                y=Scale(names=names, span=(count - 0.5, -0.5)),
            ),
        ),
        heights_px=(max(240, FIELD_PX * count),),
    )


def _signed(value: float) -> str:
    """Return a correlation with its sign and the digits that fit a field; ``?`` where none is known."""
    if not np.isfinite(value):
        return "?"
    return f"{round(value, 2) + 0.0:+.2f}".replace("-", "−").replace("0.", ".")


def budget_chart(budget: "Budget", names: Sequence[str] | None = None) -> Chart:
    """Return one bar a number, divided by the share of each source in its variance.

    Where the noise of two outputs partly makes up for each other, one share is negative and the bar begins left of 0.

    Parameters
    ----------
    budget
        The uncertainty budget.
    names
        Numbers to show; all whose uncertainty is known by default.

    Raises
    ------
    ValueError
        If there is no number to show.
    """
    rows = [row for row in budget.rows if row.shares and (names is None or row.name in names)]
    if not rows:
        raise ValueError("budget: expected a number whose uncertainty is known, found none.")
    shown = [source for source in budget.sources if any(row.shares.get(source, 0.0) != 0.0 for row in rows)]
    places = np.arange(len(rows), dtype=np.float64)
    above, below = np.zeros(len(rows)), np.zeros(len(rows))
    marks: list[Mark] = []
    for shade, source in enumerate(shown):
        share = np.array([PERCENT * row.shares.get(source, 0.0) for row in rows])
        start = np.where(share >= 0.0, above, below)
        marks.append(Bars(places=places, lengths=share, starts=start, name=Symbol(source), shade=shade, upright=False))
        above, below = np.where(share >= 0.0, above + share, above), np.where(share < 0.0, below + share, below)
    marks.append(Straight(at=0.0, axis="x", shade="ink", dash="solid"))
    span = (min(0.0, float(below.min())), max(PERCENT, float(above.max())))
    return Chart(
        panels=(
            Panel(
                marks=marks,
                x=Scale(title="share of the variance [%]", span=span),
                y=Scale(names=[Symbol(row.name) for row in rows], span=(len(rows) - 0.5, -0.5)),
            ),
        ),
        heights_px=(BAR_PX * len(rows) + 20,),
    )
