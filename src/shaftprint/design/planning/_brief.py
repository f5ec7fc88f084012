"""Everything that is laid down before the search: legs without their amplitudes, and what binds them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.design.inputs._assumed_ship import AssumedShip
from shaftprint.design.inputs._gauge_range import FULL_SCALE
from shaftprint.design.inputs._limits import Limits
from shaftprint.design.inputs._wish import Wish
from shaftprint.design.motion._bound import Bound
from shaftprint.design.motion._bounds import bounds_of_leg
from shaftprint.design.motion._gauge import gauge_bounds
from shaftprint.design.motion._motion import expect_motion, motion, motion_noise
from shaftprint.design.plan._leg import odd_harmonics
from shaftprint.design.plan._plan import LaidDown, SailedTest
from shaftprint.design.plan._timetable import Timetable
from shaftprint.design.search._uses import Uses
from shaftprint.errors import DesignError
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.identify.prediction._line_information import LineInformation, line_information
from shaftprint.identify.prediction._noise_at_speeds import noise_at
from shaftprint.identify.prediction._noise_levels import NoiseLevels
from shaftprint.identify.prediction._planned_response import planned_lines
from shaftprint.models._working_point import at_working_point

# Odd harmonics of a leg.
MOST_LINES = 70


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Brief(LaidDown):
    """Everything that is laid down before the search: legs without their amplitudes, and what binds them."""

    speeds: tuple[float, ...]
    """Mean speed of each leg over that of the first working point."""
    bounds: tuple[tuple[Bound, ...], ...]
    """Bounds of each leg."""
    harmonics: tuple[tuple[int, ...], ...]
    """Harmonics that each leg may have."""
    periods: int
    """Whole periods of each leg."""
    period_s: float
    """Their length [s]."""

    @classmethod
    def of(
        cls,
        ship: AssumedShip,
        wish: Wish,
        limits: Limits,
        noise: NoiseLevels | Mapping[float, NoiseLevels],
        *,
        speeds: Sequence[float],
        within_s: float,
        priors: Mapping[str, Prior],
        timetable: Timetable,
        earlier: Sequence[SailedTest] = (),
    ) -> "Brief":
        """Return what follows from the wishes of the user; see ``design_campaign``.

        Raises DesignError if there is no speed, no room below a limit or too little time.
        """
        expect_motion(ship.structure)
        if not speeds or not all(share > 0.0 for share in speeds):
            stated = ", ".join(f"{share:g}" for share in speeds) or "none"
            raise DesignError(f"plan: expected positive speeds over that of the working point, found {stated}.")
        periods, period_s = timetable.periods(within_s, [share * limits.engine_speed_rpm for share in speeds])
        levels = tuple(noise_at(noise, share) for share in speeds)
        structures = tuple(at_working_point(ship.structure, speed_share=share) for share in speeds)
        spread = (motion_noise(one, ship.values, level) for one, level in zip(structures, levels, strict=True))
        return cls(
            ship=ship,
            wish=wish,
            limits=limits,
            priors=priors,
            timetable=timetable,
            speeds=tuple(speeds),
            noise=levels,
            structures=structures,
            bounds=tuple(bounds_of_leg(limits, share, one) for share, one in zip(speeds, spread, strict=True)),
            harmonics=tuple(
                odd_harmonics(period_s, min(limits.last_frequency_hz, float(level.frequency_hz[-1])), MOST_LINES)
                for level in levels
            ),
            periods=periods,
            period_s=period_s,
            earlier=tuple(earlier),
        )

    def information(self, values: FloatArray) -> LineInformation:
        """Return what every line would tell for a unit of amplitude over a second; earlier tests count as priors."""
        pairs = [
            (structure, planned_lines(np.array(lines) / self.period_s, noise=level, amplitude=1.0, duration_s=1.0))
            for structure, lines, level in zip(self.structures, self.harmonics, self.noise, strict=True)
        ]
        named = dict(zip(self.ship.structure.names, values.tolist(), strict=True))
        every = line_information([*pairs, *self.earlier], values=named, priors=self.priors)
        before = sum((lines.sum(axis=0) for lines in every.of_lines[len(pairs) :]), every.of_priors)
        return replace(every, of_lines=every.of_lines[: len(pairs)], of_priors=before)

    def uses(self, leg: int, table: FloatArray, harmonics: tuple[int, ...] | None = None, fold: int = 1) -> Uses:
        """Return the uses of the bounds of a leg, for possible ships, shape (rows, parameters)."""
        lines = harmonics or self.harmonics[leg]
        omega = 2.0 * np.pi * np.array(lines) / self.period_s
        return Uses.of(motion(self.structures[leg], table, omega), self.bounds[leg], lines, fold)

    def without_gauge(self) -> "Brief":
        """Return the same without the full scale of the gauge among what binds the legs."""
        return replace(self, bounds=tuple(tuple(one for one in leg if one.name != FULL_SCALE) for leg in self.bounds))

    def with_crest(self, crest: float) -> "Brief":
        """Return the same with so many times the ripple kept free below the full scale of the gauge at crests."""
        others = self.without_gauge().bounds
        of_gauge = [gauge_bounds(self.limits, share, crest=crest) for share in self.speeds]
        return replace(self, bounds=tuple((*leg, *ends) for leg, ends in zip(others, of_gauge, strict=True)))

    @property
    def seconds(self) -> tuple[float, ...]:
        """Length of the window of each leg [s]."""
        return (self.periods * self.period_s,) * len(self.speeds)
