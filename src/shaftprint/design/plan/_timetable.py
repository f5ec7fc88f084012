"""How the time of a test is divided: what is not measured, and whole periods of each leg."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from shaftprint.errors import DesignError
from shaftprint.notebook._shown import Shown

# A test with fewer periods a leg has too little to tell noise from the response.
FEWEST_PERIODS = 4
# A short test has periods of so much of the length that is aimed at, at least: with 11 s the lines begin at 0.09 Hz,
# and a first test of two legs of 45 s tells the peaks of the loop.
_SHORTEST_SHARE = 1.0 / 3.0
# Ramps have this much more time than they take [s].
_SPARE_S = 0.01
STAIRS = (1.0, 0.0, -1.0, 0.0, 1.0, 0.0)
"""Levels of the staircase of a planned test: a minute of steps up and down that tries models and shows limits."""


@dataclass(frozen=True, kw_only=True, slots=True, repr=False)
class Timetable(Shown):
    """What a test spends on other things than its windows, and how long a period is meant to be."""

    lead_s: float = 10.0
    """Steady running at the level of the first leg before it begins [s]."""
    settle_s: float = 10.0
    """Time for which a multisine runs before its window [s]: the response to its start dies out."""
    ramp_rpm_per_s: float = 30.0
    """Change of the set point between legs [rpm/s]."""
    period_s: float = 33.0
    """Period that is aimed at [s]; it is stretched so that whole ones fill the time."""

    rest_s: float = 5.0
    """Steady running at the level of the first leg after the last one [s]: what that stirred up dies out."""
    stairs: tuple[float, ...] = ()
    """Levels of a staircase at the end, about the level of the first leg and over the largest of them; none: no
    staircase."""
    dwell_s: float = 10.0
    """Time on each of them [s]."""

    def overhead_s(self, levels_rpm: Sequence[float]) -> float:
        """Return the time that is not in a window [s], from the first second to the last."""
        ramps = sum(self.ramp_s(earlier, later) for earlier, later in pairwise((*levels_rpm, levels_rpm[0])))
        return self.lead_s + self.settle_s * len(levels_rpm) + ramps + self.rest_s + self.stairs_s

    def ramp_s(self, from_rpm: float, to_rpm: float) -> float:
        """Return the time from one level to another [s]; a hundredth of a second so that rounding makes none too long.

        Levels that are the same need none.
        """
        return abs(to_rpm - from_rpm) / self.ramp_rpm_per_s + (_SPARE_S if from_rpm != to_rpm else 0.0)

    @property
    def stairs_s(self) -> float:
        """Length of the staircase [s]."""
        return self.dwell_s * len(self.stairs)

    def periods(self, within_s: float, levels_rpm: Sequence[float]) -> tuple[int, float]:
        """Return the number of periods of every leg and their length [s].

        Raises DesignError if the time is too short for a few periods.
        """
        window_s = (within_s - self.overhead_s(levels_rpm)) / len(levels_rpm)
        count = max(FEWEST_PERIODS, round(window_s / self.period_s))
        shortest_s = _SHORTEST_SHARE * self.period_s
        if window_s < FEWEST_PERIODS * shortest_s:
            least = self.overhead_s(levels_rpm) + FEWEST_PERIODS * shortest_s * len(levels_rpm)
            raise DesignError(
                f"test of {within_s:.0f} s with {len(levels_rpm)} legs: expected at least {least:.0f} s, which hold "
                f"{FEWEST_PERIODS} periods of {shortest_s:.3g} s in each leg; give more time or fewer speeds."
            )
        return count, window_s / count
