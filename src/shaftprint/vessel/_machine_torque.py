"""The channel in which a converter shows the torque of an electric machine on the gearbox."""

from typing import Literal, Self

from pydantic import model_validator

from shaftprint.settings import Name, Number, PositiveNumber, Settings
from shaftprint.vessel._latency import LatencySeconds
from shaftprint.vessel._usual import MACHINE_TORQUE_STD


class MachineTorqueSensor(Settings):
    """The torque of an electric machine on the gearbox as its converter shows it, and how it is asked for.

    The voltage of a campaign asks for a torque on the same line on which the channel shows what is reached.
    """

    channel: Name
    """Name of the channel in the recording."""
    unit: Literal["V"]
    """Unit of the channel."""
    torque_nm_per_v: Number
    """Torque at the shaft of the machine for one volt [N m/V]."""
    torque_nm_at_zero_v: Number = 0.0
    """Torque at no voltage [N m]."""
    latency_s: LatencySeconds = 0.0
    """Time by which the channel is late [s]."""
    scale_std_fraction: PositiveNumber | None = None
    """Relative standard deviation of the torque it shows; see ``scale_std`` where it is not stated."""

    @property
    def scale_std(self) -> float:
        """Relative standard deviation of the torque it shows, as stated or as usual."""
        return MACHINE_TORQUE_STD if self.scale_std_fraction is None else self.scale_std_fraction

    @model_validator(mode="after")
    def _has_a_slope(self) -> Self:
        if self.torque_nm_per_v == 0.0:
            raise ValueError("expected torque_nm_per_v other than 0, found 0.")
        return self
