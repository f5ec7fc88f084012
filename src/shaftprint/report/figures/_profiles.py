"""Profiles of the likelihood beside the parabolas of the standard deviations."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.identify.uncertainty._profile_curve import profile_curve
from shaftprint.report.charts._chart import Chart, Panel, Scale
from shaftprint.report.charts._marks import Line, Mark, Straight
from shaftprint.report.charts._text import quantity

if TYPE_CHECKING:
    from shaftprint.identify.fit._identification import Identification
    from shaftprint.identify.uncertainty._profile_curve import ProfileCurve

COLUMNS = 3
PARABOLA_POINTS = 41
# The picture ends a little above the limit.
ROOM = 1.6


def profile_chart(identification: "Identification", names: Sequence[str] | None = None) -> Chart:
    """Return a panel for each parameter: the lowest cost at each of its values, and what its deviation would make it.

    Parameters
    ----------
    identification
        A fit that is weighted by the covariance.
    names
        Parameters and combinations to show; all free parameters by default.

    Raises
    ------
    IdentificationError
        If the fit was not weighted by the covariance.
    """
    shown = [parameter.name for parameter in identification.objective.free_parameters] if names is None else names
    panels = [
        _panel(profile_curve(identification, name), is_first=number % COLUMNS == 0) for number, name in enumerate(shown)
    ]
    return Chart(panels=panels, columns=min(COLUMNS, len(panels)), heights_px=(140,), linked="none")


def _panel(curve: "ProfileCurve", *, is_first: bool) -> Panel:
    marks: list[Mark] = [
        Straight(at=curve.limit, axis="y", name="95 % interval below"),
        Straight(at=curve.value, axis="x", shade="soft", dash="solid"),
    ]
    if np.isfinite(curve.std) and curve.values.size > 1:
        values = np.linspace(curve.values[0], curve.values[-1], PARABOLA_POINTS)
        rise = 0.5 * ((values - curve.value) / curve.std) ** 2
        rise = np.where(rise < 2.0 * ROOM * curve.limit, rise, np.nan)
        marks.append(Line(x=values, y=rise, name="parabola of the standard deviation", shade=1))
    marks.append(Line(x=curve.values, y=curve.rise, name="profile of the likelihood", marker="circle"))
    return Panel(
        marks=marks,
        x=Scale(title=quantity(curve.name, curve.unit)),
        y=Scale(title="rise of the cost [-]" if is_first else "", span=(0.0, ROOM * curve.limit)),
    )
