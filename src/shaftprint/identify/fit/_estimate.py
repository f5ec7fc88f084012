"""The noun ``Estimate``: one number that was found, with unit and uncertainty, the same from the fit to the file."""

import math
from dataclasses import dataclass
from typing import Final

from shaftprint.digits import after_number, interval, plain_letters, stated, stated_interval, to_digit_of
from shaftprint.distributions import NORMAL_95
from shaftprint.models._role import Role
from shaftprint.notebook._shown import Shown
from shaftprint.notebook._summary import Summary

# An end of the interval further than this share of its width from the end that a standard deviation gives: only the
# interval is shown.
ENDS_ALIKE: Final = 0.25


@dataclass(frozen=True, kw_only=True, slots=True, repr=False)
class Estimate(Shown):
    """A number with its unit and uncertainty."""

    name: str
    """Field term or formula, such as ``K_p`` or ``t_d + t_sp``."""
    unit: str
    """Unit, ``-`` where there is none."""
    value: float
    """Estimate."""
    std: float
    """Standard deviation to first order; infinite where the test says nothing about it."""
    interval_95: tuple[float, float] | None = None
    """95 % interval where the standard deviation alone does not give it, as from the profile likelihood."""
    interval_open: tuple[bool, bool] = (False, False)
    """Whether an end of the interval is only a bound of the search: the data set none."""
    at_bound: bool = False
    """Whether the search stopped at a bound."""
    expected: float | None = None
    """Value from another source, such as the torsional vibration calculation."""
    expected_std: float | None = None
    """Standard deviation of that value."""
    meaning: str = ""
    """What it stands for."""
    role: Role | None = None
    """What it is in the line, one of ``catalogue.ROLES``; None where it has none, as in files of earlier versions."""
    limit: str = ""
    """The limit of governor or engine that it belongs to, in words; empty for other numbers. This and the next stand in
    files with the limits only."""
    doubt: str = ""
    """Why it is not to be used, beside what the verdict says; empty where it may be."""

    def summary(self) -> Summary:
        """Return value, 95 % interval, what it is, what was expected, and why it is not to be used."""
        lower, upper = self.ends_95
        # where the interval says something else than the deviation it gives the digits
        std = self.interval_std if self.stated_std is None else self.stated_std
        unit = after_number(self.unit)
        alone = plain_letters(f"{to_digit_of(self.value, std)}{unit}{' (at its bound)' if self.at_bound else ''}")
        expected, known = self.expected, self.expected_std
        facts = {
            "value": alone if self.stated_std is None else stated(self.value, std, self.unit),
            "95 % interval": plain_letters(f"{interval(lower, upper, std)}{unit}"),
            "meaning": self.meaning,
            "expected": "" if expected is None else stated(expected, 0.0 if known is None else known, self.unit),
            "not to be used": self.doubt,
        }
        return Summary(title=self.name, facts=facts)

    @property
    def deviations_from_expected(self) -> float | None:
        """How many standard deviations of both it is from what was expected; None where that is not known."""
        spread = math.hypot(self.std, self.expected_std or 0.0)
        if self.expected is None or not 0.0 < spread < math.inf:
            return None
        return abs(self.value - self.expected) / spread

    @property
    def stated_std(self) -> float | None:
        """The standard deviation where it tells what the interval tells; None where only the interval should be shown.

        To first order a standard deviation at a bound, or where the likelihood is far from a parabola, is several times
        too large or too small, and says nothing about the side on which most of the interval lies.
        """
        if self.at_bound:
            return None
        if self.interval_95 is None or not math.isfinite(self.std):
            return self.std
        lower, upper = self.interval_95
        tolerance = ENDS_ALIKE * (upper - lower)
        alike = (
            abs(self.value - NORMAL_95 * self.std - lower) <= tolerance
            and abs(self.value + NORMAL_95 * self.std - upper) <= tolerance
        )
        return self.std if alike else None

    @property
    def interval_std(self) -> float:
        """The standard deviation that the digits follow: that of the interval, where there is one."""
        if self.interval_95 is None:
            return self.std
        lower, upper = self.interval_95
        width = 0.5 * (upper - lower) / NORMAL_95
        return width if math.isfinite(width) and width > 0.0 else self.std

    @property
    def in_words(self) -> str:
        """Its value with the 95 % interval, or with the standard deviation where there is no interval."""
        if self.interval_95 is None:
            return stated(self.value, self.std, self.unit)
        return stated_interval(self.value, *self.interval_95, self.interval_std, self.unit)

    @property
    def limits_95(self) -> tuple[float, float]:
        """95 % interval: of the profile likelihood where there is one, else to first order; nan for an open end."""
        ends = zip(self.ends_95, self.interval_open, strict=True)
        lower, upper = (math.nan if is_open else end for end, is_open in ends)
        return lower, upper

    @property
    def ends_95(self) -> tuple[float, float]:
        """95 % interval, of the profile likelihood where there is one, or to first order; an open end is its bound."""
        half = NORMAL_95 * self.std
        return self.interval_95 or (self.value - half, self.value + half)

    @property
    def trusted(self) -> bool:
        """Whether nothing speaks against the number itself; the verdict of a test says more."""
        return not self.doubt
