"""What a clock map rests on: the minutes that were compared, and how far they scatter."""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from shaftprint.clocks._clock_map import ClockMap


@dataclass(frozen=True, kw_only=True, slots=True)
class Stretch:
    """What one stretch says of two clocks."""

    time_s: float
    """Middle of the stretch on the other clock [s]."""
    offset_s: float
    """What the reference clock reads more there [s]."""
    std_s: float
    """Its standard deviation [s]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Alignment:
    """A clock map and what it rests on; one that is known from elsewhere rests on no stretch."""

    map: ClockMap
    """From the other clock to the reference."""
    span_s: tuple[float, float]
    """First and last time on the other clock for which the map is used [s]."""
    stretches: tuple[Stretch, ...] = ()
    """What each stretch says, in order of time."""
    scatter: float | None = None
    """Root mean square of the stretches' distances from the line in their standard deviations, about 1 where all is
    well; the covariance of the map has grown by its square where it is larger. None without
    stretches, and of a short recording, which is one stretch."""

    @property
    def worst_std_s(self) -> float:
        """Largest standard deviation of the map within its span [s]."""
        return float(self.map.std_s(np.array(self.span_s)).max())

    def then(self, following: ClockMap) -> Self:
        """Return the alignment with the clock to which the reference itself is mapped."""
        through = self.map.then(following)
        moved = []
        for stretch in self.stretches:
            reference_s = stretch.time_s + stretch.offset_s
            offset_s = float(following.reference_s(np.asarray(reference_s))) - stretch.time_s
            moved.append(replace(stretch, offset_s=offset_s, std_s=stretch.std_s * (1.0 + following.drift)))
        return replace(self, map=through, stretches=tuple(moved))
