"""The lever of a ship in ordinary service: no test, but a course that somebody's hand has gone."""

from itertools import pairwise
from typing import Self

import numpy as np
from pydantic import model_validator

from shaftprint.arrays import FloatArray
from shaftprint.campaign._campaign import Campaign
from shaftprint.settings import Number


class LeverCourse(Campaign):
    """A set point that goes straight from corner to corner; nobody asked for it as a test."""

    corner_s: tuple[Number, ...]
    """Times of the corners [s], ascending, shape (corners,)."""
    corner_v: tuple[Number, ...]
    """Set point there [V], shape (corners,); before the first and after the last it stands still."""
    declutched_s: tuple[tuple[Number, Number], ...] = ()
    """From when to when the clutch is out [s], in order of time, shape (stretches, 2)."""

    def voltage(self, time_s: FloatArray) -> FloatArray:
        """Return the set point [V], shape of the times [s]."""
        return np.interp(time_s, self.corner_s, self.corner_v)

    def _without_excitations(self) -> list[str]:
        return []

    @model_validator(mode="after")
    def _is_a_course(self) -> Self:
        if not self.corner_s or len(self.corner_s) != len(self.corner_v):
            raise ValueError(
                f"expected corner_s and corner_v of one length, found {len(self.corner_s)} and {len(self.corner_v)}."
            )
        if any(later <= earlier for earlier, later in pairwise(self.corner_s)):
            raise ValueError("expected ascending times in corner_s.")
        ends = [end for stretch in self.declutched_s for end in stretch]
        if any(later <= earlier for earlier, later in pairwise(ends)):
            raise ValueError("expected stretches in declutched_s in order of time, which do not touch.")
        return self
