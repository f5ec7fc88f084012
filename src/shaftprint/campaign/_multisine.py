"""A sum of sines that are harmonics of one period, at a level of its own."""

import math
from itertools import pairwise
from typing import Annotated, Self

import numpy as np
from pydantic import Field, model_validator

from shaftprint.arrays import FloatArray
from shaftprint.campaign._excitations import SPEED_SET_POINT
from shaftprint.campaign._leg import Leg
from shaftprint.settings import Name, Number, PositiveInteger, PositiveNumber

# So many samples are summed at a time: their phasors stay in the processor's cache.
_BLOCK = 8192


class Multisine(Leg):
    """All lines at once, and their phases chosen so that the sum stays small.

    ``U = level_v + sum_k amplitudes_v[k] sin(2 pi harmonics[k] (t - start_s) / period_s + phases_rad[k])``.

    With odd harmonics alone the square of the speed, which the propeller's torque follows, falls between the lines.
    """

    input: Name = SPEED_SET_POINT
    """What it moves: a table of the vessel file's sensors. What moves something else than the set point of the speed
    runs beside a leg of that, in the same periods, on lines of its own."""
    period_s: PositiveNumber
    """Period [s]; the lines are multiples of its reciprocal."""
    harmonics: Annotated[tuple[PositiveInteger, ...], Field(min_length=1)]
    """Number of periods of each line in one period of the sum, ascending, shape (lines,)."""
    amplitudes_v: tuple[PositiveNumber, ...]
    """Amplitude of each line [V], half of peak to peak, shape (lines,)."""
    phases_rad: tuple[Number, ...]
    """Phase of each line at the start [rad], 0 for a sine that rises through its middle, shape (lines,)."""

    @model_validator(mode="after")
    def _one_amplitude_and_phase_a_line(self) -> Self:
        sizes = len(self.harmonics), len(self.amplitudes_v), len(self.phases_rad)
        errors = []
        if len(set(sizes)) > 1:
            errors.append(
                f"expected as many amplitudes_v and phases_rad as harmonics, found {sizes[1]} and {sizes[2]} for "
                f"{sizes[0]}."
            )
        errors += [
            f"expected harmonics to ascend, found {second} after {first}."
            for first, second in pairwise(self.harmonics)
            if second <= first
        ]
        if errors:
            raise ValueError(" ".join(errors))
        return self

    @property
    def length_of_period_s(self) -> float:
        """Time after which it repeats itself [s]."""
        return self.period_s

    @property
    def lines(self) -> dict[int, float]:
        """Amplitude [V] of each harmonic, ascending."""
        return dict(zip(self.harmonics, self.amplitudes_v, strict=True))

    def value_at(self, time_s: FloatArray) -> FloatArray:
        """Return the set point [V], the level included, shape of ``time_s``."""
        turn_rad = (2.0 * math.pi / self.period_s) * (np.asarray(time_s, dtype=np.float64) - self.start_s)
        flat = turn_rad.reshape(-1)
        blocks = (flat[first : first + _BLOCK] for first in range(0, flat.size, _BLOCK))
        values = [self.level_v + self._sum_of_lines(block) for block in blocks]
        return np.concatenate([np.empty(0), *values]).reshape(turn_rad.shape)

    def _sum_of_lines(self, turn_rad: FloatArray) -> FloatArray:
        """Return what all lines give [V] at phases of the period [rad], shape (samples,).

        The phasor of each line is the one before it, turned by the gap between their harmonics. Gaps repeat, and a
        product takes a tenth of the time of a sine: a simulated test of minutes has millions of samples.
        """
        gaps = np.diff(self.harmonics, prepend=0).tolist()
        turns = {gap: np.exp(1j * gap * turn_rad) for gap in set(gaps)}
        phasor = np.ones(turn_rad.shape, dtype=np.complex128)
        total = np.zeros(turn_rad.shape)
        for gap, amplitude_v, phase_rad in zip(gaps, self.amplitudes_v, self.phases_rad, strict=True):
            phasor *= turns[gap]
            total += amplitude_v * (math.cos(phase_rad) * phasor.imag + math.sin(phase_rad) * phasor.real)
        return total
