"""The set point of the speed: what is put out to the governor, as it was recorded."""

from typing import Literal

from shaftprint.settings import Name, NotNegativeNumber, PositiveNumber, Settings


class SetPointSensor(Settings):
    """The voltage that asks the governor for a speed."""

    channel: Name
    """Name of the channel in the recording."""
    unit: Literal["V"]
    """Unit of the channel."""
    noise_v: NotNegativeNumber | None = None
    """Standard deviation of the logger's noise [V]."""
    latency_s: NotNegativeNumber | None = None
    """Time from the voltage to the demanded speed that the engine's control unit has [s]; None where not measured."""
    latency_std_s: PositiveNumber | None = None
    """Standard deviation of that time [s]."""
