"""What repeats itself at a level of its own: the contract of multisines and binary sequences."""

import math
import re
from abc import abstractmethod
from collections.abc import Collection
from typing import Self

import numpy as np
from pydantic import model_validator

from shaftprint.arrays import FloatArray
from shaftprint.settings import Name, NotNegativeNumber, Number, PositiveNumber, Settings

FEWEST_PERIODS = 2
"""The noise under the lines of a leg is what differs from period to period."""

# A window of a whole number of periods may fall short by rounding of its decimal stop time.
_PERIOD_ROUNDING = 1e-9
# So many values in a period of the fastest line miss its crest by less than a per cent.
_VALUES_A_PERIOD = 24

_AGAIN = re.compile(r"-([2-9]|[1-9]\d+)$")


def first_name(name: str) -> str:
    """Return the name of a test that was played first under it: ``M1`` of ``M1-2``."""
    return _AGAIN.sub("", name)


def name_again(name: str, names: Collection[str]) -> str:
    """Return the name of a test that is played once more: ``M1-2`` of ``M1``, or the next that is not among others."""
    first = first_name(name)
    return next(again for number in range(2, len(names) + 3) if (again := f"{first}-{number}") not in names)


class Leg(Settings):
    """A periodic excitation at a level of its own, analysed over whole periods once it has settled.

    Several levels in one campaign are several working points.
    """

    name: Name
    """Name of the leg, such as ``M1``; its lines are called ``M1/7`` by their harmonics."""
    level_v: Number
    """Set point about which it moves [V], the working point of this leg; not relative to the campaign's offset."""
    start_s: NotNegativeNumber
    """When the first period begins [s]."""
    settled_s: NotNegativeNumber
    """When the analysis may begin [s]: the response to the start has died out."""
    stop_s: PositiveNumber
    """When it ends [s]."""

    @property
    @abstractmethod
    def length_of_period_s(self) -> float:
        """Time after which it repeats itself [s]."""

    @property
    @abstractmethod
    def lines(self) -> dict[int, float]:
        """Amplitude [V] of each harmonic of the period at which a response is measured, ascending."""

    @abstractmethod
    def value_at(self, time_s: FloatArray) -> FloatArray:
        """Return the set point.

        ``time_s``: times since the start of the recording [s], any shape; the leg is continued periodically beyond its
        ends. Returns set point [V], the level included, shape of ``time_s``.
        """

    @property
    def extremes_v(self) -> tuple[float, float]:
        """Lowest and highest set point of one period [V], to a per cent of its motion."""
        count = _VALUES_A_PERIOD * max(self.lines)
        step_s = self.length_of_period_s / count
        values = self.value_at(self.start_s + step_s * np.arange(count, dtype=np.float64))
        return float(values.min()), float(values.max())

    @model_validator(mode="after")
    def _window_holds_periods(self) -> Self:
        if not self.start_s <= self.settled_s < self.stop_s:
            raise ValueError(
                f"expected start_s <= settled_s < stop_s, found {self.start_s:g}, {self.settled_s:g}, {self.stop_s:g}."
            )
        if self.periods < FEWEST_PERIODS:
            raise ValueError(
                f"expected at least {FEWEST_PERIODS} periods of {self.length_of_period_s:g} s between settled_s and "
                f"stop_s, since what differs between them is the noise, found {self.stop_s - self.settled_s:g} s."
            )
        return self

    @property
    def periods(self) -> int:
        """Whole periods between settled_s and stop_s."""
        return math.floor((self.stop_s - self.settled_s) / self.length_of_period_s + _PERIOD_ROUNDING)

    @property
    def window_s(self) -> float:
        """Length of those periods [s]."""
        return self.periods * self.length_of_period_s

    @property
    def window_stop_s(self) -> float:
        """End of those periods [s]."""
        return self.settled_s + self.window_s
