"""How many periods of which leg are still missing, by the information that a period of each gives."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.identify.prediction._line_information import line_information
from shaftprint.identify.prediction._planned_response import planned_lines

if TYPE_CHECKING:
    from shaftprint.design.plan._plan import Plan
    from shaftprint.identify.prediction._noise_levels import NoiseLevels
    from shaftprint.spectra._frequency_response import FrequencyResponse

MOST_PERIODS = 400
"""Periods after which nothing more is to be expected of the same lines: a day of them."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class PeriodInformation:
    """What a period of each leg tells of the numbers that are wished for."""

    of_period: tuple[FloatArray, ...]
    """Information of one period of each leg, each of shape (free, free)."""
    before: FloatArray
    """Information that is there already: priors, earlier recordings, and what bounds say, shape (free, free)."""
    targets: Mapping[str, float]
    """Wished standard deviations in the numbers' units, by name."""
    slopes: Mapping[str, FloatArray]
    """Derivative of each wished number over its wish, by name, each of shape (free,)."""

    def after(self, counts: Sequence[int]) -> FloatArray:
        """Return the information after so many periods of each leg, shape (free, free)."""
        told = sum((count * one for count, one in zip(counts, self.of_period, strict=True)), self.before)
        return np.asarray(told)

    def ratios(self, counts: Sequence[int]) -> dict[str, float]:
        """Return the predicted deviation over its wish after so many periods of each leg, by name."""
        covariance = np.linalg.inv(self.after(counts))
        return {name: float(np.sqrt(row @ covariance @ row)) for name, row in self.slopes.items()}


def period_information(
    plan: "Plan",
    noise: "Sequence[NoiseLevels]",
    *,
    values: Mapping[str, float],
    costs: Sequence[FloatArray],
) -> PeriodInformation:
    """Return what a period of each leg of a plan tells.

    ``plan``: the plan; its earlier tests and priors count. ``noise``: noise at each leg. ``values``: values at which it
    is predicted, by name. ``costs``: by what factor the covariance of each line counts larger because it is estimated
    from few samples, of each leg.
    """
    lines = [
        _enlarged(
            planned_lines(leg.frequency_hz, noise=level, amplitude=np.abs(leg.amplitudes), duration_s=leg.period_s),
            cost,
        )
        for leg, level, cost in zip(plan.legs, noise, costs, strict=True)
    ]
    pairs = [*zip(plan.structures, lines, strict=True), *plan.earlier]
    information = line_information(pairs, values=values, priors=plan.priors)
    each = [one.sum(axis=0) for one in information.of_lines]
    earlier = sum(each[len(lines) :], information.of_priors)
    targets = plan.wish.targets(information.values)
    return PeriodInformation(
        targets=targets,
        of_period=tuple(each[: len(lines)]),
        # what nothing is told of is known to the width of its bounds
        before=np.asarray(earlier + np.diag(1.0 / information.ranges**2)),
        slopes={name: information.slopes[name] / target for name, target in targets.items()},
    )


def missing_periods(information: PeriodInformation, *, fewest: int) -> tuple[int, ...] | None:
    """Return how many more periods of each leg meet every wish; None where none of a day do.

    One period after the other goes to the leg where it does most for the worst of the wishes. A leg that is sailed
    again is sailed for a few periods, so that its noise can be told from its response.

    ``information``: what a further period of each leg tells, beside all that is known. ``fewest``: fewest periods of a
    leg that is sailed again.
    """
    more = [0] * len(information.of_period)
    for _ in range(MOST_PERIODS):
        worst = _worst(information, more)
        if worst <= 1.0:
            return tuple(more)
        trials = []
        for place, given in enumerate(more):
            trial = list(more)
            trial[place] = max(given + 1, fewest)
            gain = float(np.log(worst / _worst(information, trial)))
            trials.append((gain / (trial[place] - given), trial))
        more = max(trials, key=lambda trial: trial[0])[1]
    return None


def _enlarged(response: "FrequencyResponse", cost: FloatArray) -> "FrequencyResponse":
    return replace(response, covariance=response.covariance * cost[:, np.newaxis, np.newaxis])


def _worst(information: PeriodInformation, counts: Sequence[int]) -> float:
    return max(information.ratios(counts).values(), default=0.0)
