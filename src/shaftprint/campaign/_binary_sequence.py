"""A pseudo-random binary sequence that repeats itself, at a level of its own."""

from typing import Annotated, Self

import numpy as np
from pydantic import Field, model_validator

from shaftprint.arrays import FloatArray
from shaftprint.campaign._leg import Leg
from shaftprint.settings import PositiveNumber

# Stages of the shift register that are fed back, by its length: primitive polynomials (Golomb, "Shift Register
# Sequences", table of primitive trinomials and pentanomials).
_FED_BACK = {
    3: (3, 2),
    4: (4, 3),
    5: (5, 3),
    6: (6, 5),
    7: (7, 6),
    8: (8, 6, 5, 4),
    9: (9, 5),
    10: (10, 7),
    11: (11, 9),
    12: (12, 11, 10, 4),
}
# Lines are taken up to where the held values have lost 3 dB.
_HIGHEST_SHARE_OF_CLOCK = 0.44
# A harmonic below this share of the amplitude is the rounding of one that is zero.
_NOTHING = 1e-6
_ROUNDING = 1e-9


class BinarySequence(Leg):
    """The set point jumps between two values, as a shift register says (PRBS), once a clock at most.

    A sequence of maximal length ``N = 2^order - 1`` whose every second value is turned over (inverse-repeat sequence;
    Godfrey, "Perturbation Signals for System Identification", chapter on pseudo-random signals). It repeats itself
    after ``2 N`` clocks and has odd harmonics alone, so that the square of the speed falls between its lines.
    """

    amplitude_v: PositiveNumber
    """Half of the distance between its two values [V]."""
    clock_s: PositiveNumber
    """Time for which each value is held at least [s]."""
    order: Annotated[int, Field(strict=True, ge=min(_FED_BACK), le=max(_FED_BACK))]
    """Length of the shift register."""
    first_clock: Annotated[int, Field(strict=True, ge=0)] = 0
    """Clock of the period with which it begins. Half a period later, ``2^order - 1``, it is upside down."""

    @model_validator(mode="after")
    def _begins_within_its_period(self) -> Self:
        clocks = 2 * ((1 << self.order) - 1)
        if self.first_clock >= clocks:
            raise ValueError(f"expected first_clock below the {clocks} clocks of a period, found {self.first_clock}.")
        return self

    @property
    def length_of_period_s(self) -> float:
        """Time after which it repeats itself [s]."""
        return 2.0 * self.clock_s * ((1 << self.order) - 1)

    @property
    def signs(self) -> FloatArray:
        """The values of one period from the start on, 1 or -1, shape (2 N,)."""
        return np.roll(_inverse_repeat(self.order), -self.first_clock)

    @property
    def lines(self) -> dict[int, float]:
        """Amplitude [V] of each harmonic up to 0.44 of the clock's rate, ascending."""
        signs = self.signs
        harmonic = np.arange(1, int(_HIGHEST_SHARE_OF_CLOCK * signs.size) + 1)
        spectrum = np.abs(np.fft.fft(signs))[harmonic] * (2.0 / signs.size)
        amplitude = self.amplitude_v * spectrum * np.sinc(harmonic / signs.size)
        return {
            int(number): float(size)
            for number, size in zip(harmonic, amplitude, strict=True)
            if size > _NOTHING * self.amplitude_v
        }

    def value_at(self, time_s: FloatArray) -> FloatArray:
        """Return the set point [V], the level included, shape of ``time_s``."""
        signs = self.signs
        clocks = np.floor((np.asarray(time_s) - self.start_s) / self.clock_s + _ROUNDING).astype(np.int64)
        value: FloatArray = self.level_v + self.amplitude_v * signs[clocks % signs.size]
        return value


def _inverse_repeat(order: int) -> FloatArray:
    """Return two periods of the sequence of maximal length, every second value turned over."""
    length = 2**order - 1
    register = [1] * order
    bits = []
    for _ in range(length):
        bits.append(register[-1])
        fed_back = sum(register[stage - 1] for stage in _FED_BACK[order]) % 2
        register = [fed_back, *register[:-1]]
    sequence = 1.0 - 2.0 * np.array(bits * 2)
    alternating: FloatArray = sequence * np.where(np.arange(2 * length) % 2, -1.0, 1.0)
    return alternating
