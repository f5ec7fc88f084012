"""The whole periods of a leg that a recording holds."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.signals._gaps import merged

if TYPE_CHECKING:
    from shaftprint.arrays import ComplexArray, FloatArray
    from shaftprint.campaign._leg import Leg
    from shaftprint.signals._gaps import Coverage

FEWEST_PERIODS = 2
"""The noise of a leg is what differs from period to period."""
# A recording that ends with the last period must not lose it to the rounding of its times.
_ROUNDING = 1e-6


@dataclass(frozen=True, kw_only=True, slots=True)
class LegPeriods:
    """The longest stretch of a leg that is measured without interruption: a whole number of periods."""

    leg: str
    """Name of the leg."""
    start_s: float
    """When the first period begins, in seconds of the recording."""
    period_s: float
    """Length of one period [s]."""
    periods: int
    """How many follow each other."""

    @property
    def stop_s(self) -> float:
        """When the last one ends [s]."""
        return self.start_s + self.duration_s

    @property
    def duration_s(self) -> float:
        """How long they are together [s]."""
        return self.periods * self.period_s

    def cut(self, values: "FloatArray", *, rate_hz: float, start_s: float) -> "FloatArray":
        """Return the samples of a signal on the grid in these periods, to the nearest sample.

        ``values``: the signal, shape (samples,). ``rate_hz``, ``start_s``: the grid.
        """
        first = max(0, round((self.start_s - start_s) * rate_hz))
        return values[first : first + round(self.periods * self.period_s * rate_hz)]


def leg_periods(leg: "Leg", coverage: "Coverage") -> LegPeriods | None:
    """Return the longest run of whole periods of a leg that a recording holds; None where there are fewer than two.

    It need not begin where a period of the set point does: every stretch as long as a period holds a whole one.

    ``leg``: a leg of the campaign. ``coverage``: what the recording covers.
    """
    # a recording that begins or ends with the leg may do so a sample beside it
    begin_s = leg.settled_s if leg.settled_s > coverage.start_s - coverage.step_s else coverage.start_s
    end_s = leg.stop_s if leg.stop_s < coverage.stop_s + coverage.step_s else coverage.stop_s
    borders = [begin_s, *(border for gap in merged(coverage.gaps, begin_s, end_s) for border in gap), end_s]
    stretches = list(zip(borders[::2], borders[1::2], strict=True))
    first_s, last_s = max(stretches, key=lambda stretch: stretch[1] - stretch[0])
    periods = math.floor((last_s - first_s) / leg.length_of_period_s + _ROUNDING)
    if periods < FEWEST_PERIODS:
        return None
    return LegPeriods(leg=leg.name, start_s=first_s, period_s=leg.length_of_period_s, periods=periods)


def between_lines(values: "FloatArray", periods: int) -> "ComplexArray":
    """Return the Fourier coefficients of what differs from period to period, below the first line.

    ``values``: samples of whole periods, shape (samples,). ``periods``: their number ``P``. Returns coefficients
    ``1..P-1``, mean of ``x exp(-2 pi j k m / N)``, shape (P - 1,).
    """
    turns = np.arange(values.size) / values.size
    return np.array([np.mean(values * np.exp(-2j * np.pi * k * turns)) for k in range(1, periods)])
