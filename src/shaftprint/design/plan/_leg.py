"""The noun ``Leg``: one multisine about one speed."""

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field

from shaftprint.arrays import ComplexArray, FloatArray, frozen_complex
from shaftprint.errors import DesignError
from shaftprint.notebook._shown import Shown
from shaftprint.notebook._summary import Summary
from shaftprint.records import MOST, NotNegativeNumber, PositiveNumber, TwoRows

# Lines weaker than this share of the strongest one of their leg are left out.
WEAKEST = 1e-3


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Leg(Shown):
    """Whole periods of a sum of sines about a speed of its own."""

    speed_share: PositiveNumber
    """Mean speed over that of the first working point."""
    level_rpm: PositiveNumber
    """The same as engine speed [rpm]."""
    period_s: PositiveNumber
    """Period [s]; the lines are multiples of its reciprocal."""
    harmonics: Annotated[tuple[int, ...], Field(max_length=MOST)]
    """Number of periods of each line in one period of the sum, ascending and odd."""
    amplitudes: TwoRows
    """Complex amplitudes ``c_k`` of the set point over the leg's mean speed, ``Re sum_k c_k exp(j 2 pi h_k t / T)``
    from the start of the first period on, shape (lines,)."""
    periods: Annotated[int, Field(gt=0, le=MOST)]
    """Whole periods of the window."""
    settle_s: NotNegativeNumber
    """Time that the multisine runs before the window begins [s]."""

    def __post_init__(self) -> None:
        """Check the lines and make the amplitudes read-only.

        Raises DesignError if the harmonics are not positive and ascending, or have not as many amplitudes.
        """
        harmonics = self.harmonics
        ascending = all(0 < earlier < later for earlier, later in pairwise((*harmonics, np.inf)))
        if not (harmonics and ascending) or np.shape(self.amplitudes) != (len(harmonics),):
            raise DesignError(
                "leg: expected ascending harmonics and an amplitude of each, found "
                f"{len(harmonics)} harmonics and amplitudes of shape {np.shape(self.amplitudes)}."
            )
        object.__setattr__(self, "amplitudes", frozen_complex(self.amplitudes))

    def summary(self) -> Summary:
        """Return speed, lines and length."""
        hertz = self.frequency_hz
        facts = {
            "speed": f"{self.level_rpm:.0f} rpm, {self.speed_share:.3g} of the working point",
            "lines": f"{len(self.harmonics)} from {hertz[0]:.3g} to {hertz[-1]:.3g} Hz",
            "window": f"{self.periods} periods of {self.period_s:.4g} s",
            "set point": f"+/- {self.peak_rpm:.0f} rpm",
        }
        return Summary(title="Leg", facts=facts)

    @property
    def window_s(self) -> float:
        """Length of the window [s]."""
        return self.periods * self.period_s

    @property
    def duration_s(self) -> float:
        """Length of the multisine [s]."""
        return self.settle_s + self.window_s

    @cached_property
    def frequency_hz(self) -> FloatArray:
        """Frequencies of the lines [Hz], shape (lines,)."""
        return np.array(self.harmonics) / self.period_s

    @property
    def amplitudes_rpm(self) -> FloatArray:
        """Amplitude of each line [rpm], half of peak to peak, shape (lines,)."""
        return self.level_rpm * np.abs(self.amplitudes)

    @property
    def phases_rad(self) -> FloatArray:
        """Phase of each line at the start [rad], 0 for a sine that rises through its middle, shape (lines,)."""
        turned = np.angle(self.amplitudes) + 0.5 * np.pi
        return np.asarray(np.mod(turned + np.pi, 2.0 * np.pi) - np.pi)

    @property
    def peak_rpm(self) -> float:
        """Largest deviation of the set point from its level [rpm], on a fine grid of one period."""
        time = np.linspace(0.0, self.period_s, 32 * self.harmonics[-1], endpoint=False)
        return float(np.abs(self.set_point_rpm(time) - self.level_rpm).max())

    def set_point_rpm(self, time_s: ArrayLike) -> FloatArray:
        """Return the set point [rpm] at times since the start of the first period [s], any shape."""
        turn = (2.0 * np.pi / self.period_s) * np.asarray(time_s, dtype=np.float64)
        value = np.full(turn.shape, self.level_rpm)
        for harmonic, amplitude, phase in zip(self.harmonics, self.amplitudes_rpm, self.phases_rad, strict=True):
            value += amplitude * np.sin(harmonic * turn + phase)
        return value


def strong_lines(harmonics: tuple[int, ...], amplitudes: ComplexArray) -> tuple[tuple[int, ...], ComplexArray]:
    """Return the lines of a leg without those that are too weak to be seen."""
    size = np.abs(amplitudes)
    kept = np.flatnonzero(size > WEAKEST * size.max())
    return tuple(harmonics[place] for place in kept), amplitudes[kept]


def odd_harmonics(period_s: float, highest_hz: float, most: int) -> tuple[int, ...]:
    """Return odd harmonics up to a frequency, all of them or, where they are too many, sparser towards the highest.

    Even ones stay free: there the quadratic propeller torque puts what it makes of the odd ones.
    """
    highest = int(np.floor(highest_hz * period_s * (1.0 + 1e-9)))
    every = np.arange(1, highest + 1, 2)
    if every.size <= most:
        return tuple(every.tolist())
    for count in range(most, 40 * most):
        sparse = np.unique(2 * np.round((np.geomspace(1.0, every[-1], count) - 1.0) / 2.0).astype(int) + 1)
        if sparse.size >= most:
            break
    return tuple(sparse.tolist())
