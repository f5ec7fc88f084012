"""What a line of a frequency would tell in a second, beside the lines of a plan: where a test has its power right.

The dispersion function of optimal design: ``trace(V J(f))`` with the covariance ``V`` of the planned test and the
information ``J(f)`` that a line at ``f`` gives in a second is the fall of ``log det V`` for another second of it
(Fedorov, Theory of Optimal Experiments, theorem 2.2.1).
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.design.plan._plan import Plan
from shaftprint.identify.prediction._line_information import line_information
from shaftprint.identify.prediction._planned_response import planned_lines

if TYPE_CHECKING:
    from shaftprint.design.plan._leg import Leg

# Frequencies at which the worth is computed.
_FREQUENCIES = 120


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LineWorth:
    """Lines of one leg, and what lines would tell at its speed."""

    leg: "Leg"
    """The leg."""
    frequency_hz: FloatArray
    """Frequencies [Hz], shape (frequencies,)."""
    per_second: FloatArray
    """Fall of the logarithm of the covariance's determinant for another second of a line of 1 rpm [1/s], shape
    (frequencies,)."""


def line_worths(plan: Plan) -> tuple[LineWorth, ...]:
    """Return for every leg what lines of 1 rpm would tell in a second, of the numbers that the plan makes known."""
    spans = [(float(leg.frequency_hz[0]), float(leg.frequency_hz[-1])) for leg in plan.legs]
    grids = [np.geomspace(low, high, _FREQUENCIES) for low, high in spans]
    levels = zip(plan.structures, plan.legs, plan.noise, grids, strict=True)
    planned, possible = [], []
    for structure, leg, noise, grid in levels:
        own = planned_lines(leg.frequency_hz, noise=noise, amplitude=np.abs(leg.amplitudes), duration_s=leg.window_s)
        planned.append((structure, own))
        one_rpm = planned_lines(grid, noise=noise, amplitude=1.0 / leg.level_rpm, duration_s=1.0)
        possible.append((structure, one_rpm))
    count = len(planned)
    information = line_information([*planned, *plan.earlier, *possible], values=plan.ship.by_name, priors=plan.priors)
    told = sum((lines.sum(axis=0) for lines in information.of_lines[:-count]), information.of_priors)
    # what nothing is told of is known to the width of its bounds
    covariance = np.linalg.inv(told + np.diag(1.0 / information.ranges**2))
    return tuple(
        LineWorth(
            leg=leg,
            frequency_hz=frozen_float(grid),
            per_second=frozen_float(np.einsum("ij,lji->l", covariance, lines)),
        )
        for leg, grid, lines in zip(plan.legs, grids, information.of_lines[-count:], strict=True)
    )
