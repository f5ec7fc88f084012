"""What a set point does for a while: stands, goes straight, swings, sweeps, repeats itself, or jumps."""

import math
from abc import abstractmethod
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray, IntArray


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Piece:
    """A stretch of the set point that one rule makes."""

    begin_s: float
    """When it begins [s]."""
    end_s: float
    """When it ends [s]."""

    @abstractmethod
    def value_at(self, time_s: FloatArray) -> FloatArray:
        """Return the set point [V], beyond both ends too, shape of ``time_s``."""

    @property
    def length_s(self) -> float:
        """How long it lasts [s]."""
        return self.end_s - self.begin_s


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Straight(Piece):
    """A level, or a ramp."""

    middle_s: float
    """Time at which it has its middle value [s]."""
    middle_v: float
    """Value there [V]."""
    slope_v_per_s: float
    """Slope [V/s]; 0 for a level."""

    def value_at(self, time_s: FloatArray) -> FloatArray:
        """Return the set point [V], shape of ``time_s``."""
        return self.middle_v + self.slope_v_per_s * (time_s - self.middle_s)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Wave(Piece):
    """A sine or a sweep about the offset: ``offset + cosine cos(phase) + sine sin(phase)``."""

    offset_v: float
    """Its middle [V]."""
    sine_v: float
    """Part that rises through the middle where the phase is zero [V]."""
    cosine_v: float
    """Part that is largest there [V]."""
    zero_s: float
    """Time from which its phase counts [s]."""
    frequency_hz: float
    """Frequency at that time [Hz]."""
    rate: float = 0.0
    """Growth of the frequency: [Hz/s] of a linear sweep, [1/s] of its logarithm in a logarithmic one; 0 for a sine."""
    is_logarithmic: bool = False
    """Whether the frequency grows exponentially."""

    @property
    def amplitude_v(self) -> float:
        """Amplitude [V]."""
        return math.hypot(self.sine_v, self.cosine_v)

    def turn_rad(self, time_s: FloatArray) -> FloatArray:
        """Return the phase since the zero [rad], shape of ``time_s``."""
        elapsed_s = np.asarray(time_s) - self.zero_s
        if self.rate == 0.0:
            return 2.0 * math.pi * self.frequency_hz * elapsed_s
        if self.is_logarithmic:
            growth: FloatArray = np.expm1(np.clip(self.rate * elapsed_s, -50.0, 50.0))
            return 2.0 * math.pi * self.frequency_hz / self.rate * growth
        return 2.0 * math.pi * (self.frequency_hz + 0.5 * self.rate * elapsed_s) * elapsed_s

    def frequency_at(self, time_s: float) -> float:
        """Return the frequency at a time [Hz]."""
        elapsed_s = time_s - self.zero_s
        if self.is_logarithmic:
            return self.frequency_hz * math.exp(self.rate * elapsed_s)
        return self.frequency_hz + self.rate * elapsed_s

    def phase_at(self, time_s: float) -> float:
        """Return the phase of the whole, 0 where it rises through its middle, at a time [rad], -pi to pi."""
        turn = float(self.turn_rad(np.array([time_s]))[0])
        return math.remainder(turn + math.atan2(self.cosine_v, self.sine_v), 2.0 * math.pi)

    def value_at(self, time_s: FloatArray) -> FloatArray:
        """Return the set point [V], shape of ``time_s``."""
        turn = self.turn_rad(time_s)
        value: FloatArray = self.offset_v + self.sine_v * np.sin(turn) + self.cosine_v * np.cos(turn)
        return value


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Repeated(Piece):
    """A sum of harmonics about a level of its own."""

    level_v: float
    """Its mean [V]."""
    period_s: float
    """Time after which it repeats itself [s]."""
    zero_s: float
    """Time from which its phases count [s]."""
    harmonics: IntArray
    """Harmonics of the period that it has, shape (lines,)."""
    phasors_v: "np.typing.NDArray[np.complex128]"
    """Amplitude and phase of each line as that of a cosine [V], shape (lines,)."""

    def value_at(self, time_s: FloatArray) -> FloatArray:
        """Return the set point [V], shape of ``time_s``."""
        turn = np.exp(2j * np.pi / self.period_s * (np.asarray(time_s) - self.zero_s))
        value = np.full(turn.shape, self.level_v)
        power, last = np.ones_like(turn), 0
        for harmonic, phasor in zip(self.harmonics.tolist(), self.phasors_v.tolist(), strict=True):
            power = power * turn ** (harmonic - last)
            last = harmonic
            value += (phasor * power).real
        return value


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Stairs(Piece):
    """Levels with jumps between them."""

    jumps_s: tuple[float, ...]
    """When it jumps [s], inside its ends, shape (levels - 1,)."""
    levels_v: tuple[float, ...]
    """The levels [V], shape (levels,)."""

    def value_at(self, time_s: FloatArray) -> FloatArray:
        """Return the set point [V], shape of ``time_s``."""
        place = np.searchsorted(np.asarray(self.jumps_s), time_s, side="right")
        return np.asarray(self.levels_v)[place]
