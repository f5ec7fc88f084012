"""How well a plan's lines would make the numbers known if they were sailed for longer or shorter."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.design.inputs._wish import numbers_of_line
from shaftprint.design.plan._plan import Plan, predicted_accuracy
from shaftprint.design.plan._timetable import FEWEST_PERIODS


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LengthCurve:
    """Length of the test against accuracy, for the same lines at the same strength."""

    duration_s: FloatArray
    """Lengths of the test [s], ascending, shape (lengths,)."""
    relative_std: Mapping[str, FloatArray]
    """Predicted standard deviation over the value, by name, each of shape (lengths,)."""


# Lengths of the windows over those of the plan.
_SHARES = (0.25, 0.35, 0.5, 0.7, 1.0, 1.4, 2.0, 2.8, 4.0)


def length_curve(plan: Plan, shares: Sequence[float] = _SHARES) -> LengthCurve:
    """Return what the lines of a plan would tell in other numbers of periods, at least four of each leg.

    ``shares``: numbers of periods over those of the plan, ascending.
    """
    counts = sorted({tuple(max(FEWEST_PERIODS, round(share * leg.periods)) for leg in plan.legs) for share in shares})
    names = plan.wish.names or numbers_of_line(plan.ship.structure)
    names = tuple(name for name in names if plan.predicted.estimate(name).value != 0.0)
    middle = {} if plan.band is None else plan.band.middle
    durations, rows = [], []
    for count in counts:
        legs = tuple(replace(leg, periods=periods) for leg, periods in zip(plan.legs, count, strict=True))
        accuracy = predicted_accuracy(
            plan.structures,
            legs,
            plan.noise,
            values=plan.ship.by_name,
            priors=plan.priors,
            earlier=plan.earlier,
        )
        durations.append(replace(plan, legs=legs).duration_s)
        every = [accuracy.estimate(name) for name in names]
        rows.append([middle.get(one.name, 1.0) * one.std / abs(one.value) for one in every])
    table = np.array(rows)
    return LengthCurve(
        duration_s=frozen_float(durations),
        relative_std={name: frozen_float(column) for name, column in zip(names, table.T, strict=True)},
    )
