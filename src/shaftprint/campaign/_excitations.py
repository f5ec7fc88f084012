"""The three kinds of excitation and what makes each of them possible."""

import math
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from shaftprint.settings import Name, NotNegativeNumber, Number, PositiveNumber, Settings

SPEED_SET_POINT = "set_point"
"""What an excitation moves where nothing else is said: the set point of the speed."""

# A window of a whole number of periods may fall short by rounding of its decimal stop time.
_PERIOD_ROUNDING = 1e-9


class Sine(Settings):
    """A sine of constant frequency, analysed over a whole number of periods once it has settled."""

    name: Name
    """Name of the line, such as ``S1``."""
    input: Name = SPEED_SET_POINT
    """What it moves: a table of the vessel file's sensors."""
    frequency_hz: PositiveNumber
    """Frequency [Hz]."""
    amplitude_v: PositiveNumber
    """Amplitude [V], half of peak to peak."""
    phase_rad: Number = 0.0
    """Phase at the start [rad]: 0 for a sine that rises through its middle, pi for one that falls."""
    start_s: NotNegativeNumber
    """When the sine begins [s]."""
    settled_s: NotNegativeNumber
    """When the analysis may begin [s]: the response to the start has died out."""
    stop_s: PositiveNumber
    """When the sine ends [s]."""

    @model_validator(mode="after")
    def _window_holds_a_period(self) -> Self:
        if not self.start_s <= self.settled_s < self.stop_s:
            raise ValueError(
                f"expected start_s <= settled_s < stop_s, found {self.start_s:g}, {self.settled_s:g}, {self.stop_s:g}."
            )
        if self.periods < 1:
            raise ValueError(
                f"expected at least one period of {1.0 / self.frequency_hz:g} s between settled_s and "
                f"stop_s, found {self.stop_s - self.settled_s:g} s."
            )
        return self

    @property
    def periods(self) -> int:
        """Whole periods between settled_s and stop_s, the ``i`` of thesis table 3.5."""
        length = self.stop_s - self.settled_s
        return math.floor(length * self.frequency_hz + _PERIOD_ROUNDING)

    @property
    def window_s(self) -> float:
        """Length of those periods [s], ``T = i / f`` (thesis eq. 3.8)."""
        return self.periods / self.frequency_hz

    @property
    def window_stop_s(self) -> float:
        """End of those periods [s], the stop of thesis table 3.5."""
        return self.settled_s + self.window_s


class Chirp(Settings):
    """A sine whose frequency grows or falls, exponentially with time (logarithmic sweep) or linearly."""

    name: Name
    """Name of the chirp, such as ``C11``."""
    start_frequency_hz: PositiveNumber
    """Frequency at its start [Hz]."""
    stop_frequency_hz: PositiveNumber
    """Frequency at its end [Hz]."""
    amplitude_v: PositiveNumber
    """Amplitude [V], half of peak to peak."""
    sweep: Literal["logarithmic", "linear"] = "logarithmic"
    """How the frequency goes with time: a linear one stays as long in each hertz, a logarithmic one in each octave."""
    phase_rad: Number = 0.0
    """Phase at the start [rad]: 0 for a chirp that rises through its middle, pi for one that falls."""
    start_s: NotNegativeNumber
    """When it begins [s]."""
    stop_s: PositiveNumber
    """When it ends [s]."""

    @model_validator(mode="after")
    def _sweeps(self) -> Self:
        errors = []
        if not self.start_s < self.stop_s:
            errors.append(f"expected start_s < stop_s, found {self.start_s:g}, {self.stop_s:g}.")
        if self.start_frequency_hz == self.stop_frequency_hz:
            errors.append(
                f"expected two different frequencies, found {self.start_frequency_hz:g} Hz twice; "
                "a constant frequency belongs under [[sines]]."
            )
        if errors:
            raise ValueError(" ".join(errors))
        return self

    def passes_s(self, frequency_hz: float) -> float:
        """Return when it passes a frequency [s], not before its start or after its end."""
        first_hz, last_hz = self.start_frequency_hz, self.stop_frequency_hz
        if self.sweep == "linear":
            share = (frequency_hz - first_hz) / (last_hz - first_hz)
        else:
            share = math.log(frequency_hz / first_hz) / math.log(last_hz / first_hz)
        return self.start_s + min(max(share, 0.0), 1.0) * (self.stop_s - self.start_s)


class Staircase(Settings):
    """Constant set points, one after the other, with sudden jumps between them."""

    name: Name
    """Name of the staircase, such as ``St1``."""
    levels_v: Annotated[tuple[Number, ...], Field(min_length=1)]
    """Set points in the order of time [V], not relative to the offset, shape (levels,)."""
    dwell_s: PositiveNumber
    """Time on each level [s]."""
    start_s: NotNegativeNumber
    """When the first level begins [s]."""

    @property
    def stop_s(self) -> float:
        """When the last level ends [s]."""
        return self.start_s + self.dwell_s * len(self.levels_v)
