"""The noun ``GaugeRange``: which shaft torque the gauge can show, and how much of it orders and noise need."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeVar

from shaftprint.arrays import FloatArray
from shaftprint.errors import DesignError
from shaftprint.notebook._shown import Shown

if TYPE_CHECKING:
    from shaftprint.vessel._vessel import Vessel

FULL_SCALE = "full scale of the gauge"
"""Name of the limit."""

# What one sample in a hundred passes at the gauge of the simulated Stan Tug, and how many times that one in 10,000
# passes (docs/decisions/0059-full-scale.md).
USUAL_RIPPLE = 0.5
_RARE = 1.3

_Speed = TypeVar("_Speed", float, FloatArray)


@dataclass(frozen=True, kw_only=True, slots=True, repr=False)
class GaugeRange(Shown):
    """The range of the torque gauge of a vessel."""

    vessel: str
    """Name of the vessel, which an error names."""
    lowest_nm: float
    """Lowest shaft torque that it shows [N m], negative."""
    highest_nm: float
    """Highest shaft torque that it shows [N m]."""
    shaft_over_brake: float
    """Shaft torque over brake torque in steady running: ratio and efficiency of the gearbox."""
    ripple: float = USUAL_RIPPLE
    """Torque that orders of shaft, blades and cylinders and the noise of the gauge put on top, over the load at that
    speed: one sample in a hundred passes it."""

    @property
    def rare_ripple(self) -> float:
        """The same of one sample in 10,000."""
        return _RARE * self.ripple

    def shaft_torque_nm(self, brake_torque_nm: float, speed_share: _Speed) -> _Speed:
        """Return the shaft torque of a load at other speeds, with whose square it goes [N m], shape of ``speed_share``.

        ``brake_torque_nm``: brake torque of the load [N m] at a speed of 1. ``speed_share``: speed, over that one.
        """
        return self.shaft_over_brake * speed_share**2 * brake_torque_nm

    def __post_init__(self) -> None:
        """Check the numbers.

        Raises DesignError if the range does not hold zero, or a factor is not positive.
        """
        if not self.lowest_nm < 0.0 < self.highest_nm:
            raise DesignError(
                f"full scale of the gauge: expected torques about zero, found {self.lowest_nm:g} to "
                f"{self.highest_nm:g} N m."
            )
        if not (self.shaft_over_brake > 0.0 and self.ripple >= 0.0):
            raise DesignError(
                "full scale of the gauge: expected a positive shaft_over_brake and a ripple of at least 0, found "
                f"{self.shaft_over_brake:g} and {self.ripple:g}."
            )


def gauge_range_of(vessel: "Vessel") -> GaugeRange:
    """Return what the gauge of a vessel file can show: full scale of what it reads, whose zero is then subtracted."""
    sensor, gearbox = vessel.sensors.shaft_torque, vessel.gearbox
    return GaugeRange(
        vessel=vessel.name,
        lowest_nm=-sensor.full_scale_nm - sensor.zero_nm,
        highest_nm=sensor.full_scale_nm - sensor.zero_nm,
        shaft_over_brake=gearbox.shaft_over_brake,
    )
