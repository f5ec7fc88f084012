"""The channels of a controllable pitch: what it is asked for, and what it is."""

from typing import Literal, Self

from pydantic import model_validator

from shaftprint.settings import Name, NotNegativeNumber, Number, PositiveNumber, Settings
from shaftprint.vessel._latency import LatencySeconds
from shaftprint.vessel._usual import PITCH_SENSOR_STD


class PitchSetPointSensor(Settings):
    """The voltage that asks a controllable-pitch propeller for its pitch."""

    channel: Name
    """Name of the channel in the recording."""
    unit: Literal["V"]
    """Unit of the channel."""
    pitch_ratio_per_v: Number
    """Pitch over diameter for one volt [1/V]."""
    pitch_ratio_at_zero_v: Number
    """Pitch over diameter at no voltage [-]."""
    scale_std_fraction: NotNegativeNumber = 0.0
    """Relative standard deviation of the pitch for one volt."""


class PitchSensor(Settings):
    """The feedback of a controllable-pitch propeller: what its pitch is, as the piston or a feedback rod shows it."""

    channel: Name
    """Name of the channel in the recording."""
    unit: Literal["V"]
    """Unit of the channel."""
    pitch_ratio_per_v: Number
    """Pitch over diameter for one volt [1/V]."""
    pitch_ratio_at_zero_v: Number
    """Pitch over diameter at no voltage [-]."""
    latency_s: LatencySeconds = 0.0
    """Time by which it is late [s]."""
    scale_std_fraction: PositiveNumber | None = None
    """Relative standard deviation of a change of pitch over the pitch, as it shows them; see ``scale_std`` where it is
    not stated."""

    @property
    def scale_std(self) -> float:
        """Relative standard deviation of a change of pitch over the pitch, as stated or as usual."""
        return PITCH_SENSOR_STD if self.scale_std_fraction is None else self.scale_std_fraction

    @model_validator(mode="after")
    def _has_a_slope(self) -> Self:
        if self.pitch_ratio_per_v == 0.0:
            raise ValueError("expected pitch_ratio_per_v other than 0, found 0.")
        return self
