"""How the time of a test is divided: what is not measured, and whole periods of each leg."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from shaftprint.errors import DesignError
from shaftprint.notebook import Shown

# A test with fewer periods a leg has too little to tell noise from the response.
FEWEST_PERIODS = 4
# A short test has periods of so much of the length that is aimed at, at least: with 11 s the lines begin at 0.09 Hz,
# and a first test of two legs of 45 s tells the peaks of the loop.
_SHORTEST_SHARE = 1.0 / 3.0


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

    def overhead_s(self, levels_rpm: Sequence[float]) -> float:
        """Return the time that is not in a window [s]."""
        ramps = sum(abs(later - earlier) for earlier, later in pairwise(levels_rpm)) / self.ramp_rpm_per_s
        return self.lead_s + self.settle_s * len(levels_rpm) + ramps

    def periods(self, within_s: float, levels_rpm: Sequence[float]) -> tuple[int, float]:
        """Return the number of periods of every leg and their length [s].

        Raises
        ------
        DesignError
            If the time is too short for a few periods.
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
