"""What every speed channel gives, whether it holds pulses or a speed."""

from dataclasses import dataclass

from shaftprint.signals._signals import StripAngles
from shaftprint.signals.conditioning._condition import Reading

# Values of a channel that is slower than the grid are joined by a spline.
LONGEST_GAP_VALUES = 3
"""Over a gap longer than so many values it says nothing."""
REACH_VALUES = 4
"""The end of a spline is felt so many values further on: by half a per cent."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SpeedReading(Reading):
    """The engine-side speed on the grid [rev/s]."""

    name: str
    """Name of the sensor."""
    channel: str
    """Name of the channel."""
    pulse_rate_hz: float
    """Mean number of pulses a second, or of values of an instrument [Hz]."""
    period_s: float = 0.0
    """Time over which a value is a mean and is held, and by which it is late [s]; 0 where the spline removes it."""
    strips: StripAngles | None = None
    """Angles between the strips, where there are several."""
