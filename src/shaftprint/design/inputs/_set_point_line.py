"""The noun ``SetPointLine``: which engine speed a voltage asks for."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from shaftprint.arrays import FloatArray
from shaftprint.design.inputs._lever import Lever
from shaftprint.errors import DesignError
from shaftprint.notebook._shown import Shown

if TYPE_CHECKING:
    from shaftprint.fingerprint._fingerprint import Fingerprint
    from shaftprint.vessel._vessel import Vessel


@dataclass(frozen=True, kw_only=True, slots=True, repr=False)
class SetPointLine(Shown):
    """A straight line from volts to engine speed."""

    slope_rpm_per_v: float
    """Change of the engine speed for one volt [rpm/V], negative where a lower voltage asks for more speed."""
    offset_v: float
    """Set point at the speed of the first working point [V]."""
    lever: Lever | None = None
    """What the channel of the set point shows for these volts; None where it shows them."""

    def __post_init__(self) -> None:
        """Check that a voltage asks for a speed.

        Raises DesignError if the slope is zero, or a number is not finite.
        """
        if self.slope_rpm_per_v == 0.0 or not all(map(math.isfinite, (self.slope_rpm_per_v, self.offset_v))):
            raise DesignError(
                "line of the set point: expected a finite slope other than 0 rpm/V and a finite voltage, found "
                f"{self.slope_rpm_per_v:g} rpm/V and {self.offset_v:g} V."
            )

    def speed_rpm(self, volts: FloatArray, *, working_point_rpm: float) -> FloatArray:
        """Return the engine speed that voltages ask for [rpm], shape of ``volts``."""
        return working_point_rpm + self.slope_rpm_per_v * (volts - self.offset_v)


def line_of_fingerprint(fingerprint: "Fingerprint") -> SetPointLine:
    """Return the line of the set point that a first test has measured.

    Raises FingerprintError if the fingerprint does not have it.
    """
    slope = fingerprint.quantity("set-point slope").value
    intercept = fingerprint.quantity("set-point intercept").value
    offset_v = (fingerprint.conditions.engine_speed.value - intercept) / slope if slope else math.nan
    return SetPointLine(slope_rpm_per_v=slope, offset_v=offset_v)


def line_of_sensor(vessel: "Vessel") -> SetPointLine | None:
    """Return the line that the vessel file states of the lever about its working point; None where it states none."""
    sensor = vessel.sensors.set_point
    offset_v = sensor.volts_for(vessel.working_point.engine_speed_rpm)
    slope = None if offset_v is None else sensor.slope_rpm_per_v(offset_v)
    return None if offset_v is None or slope is None else SetPointLine(slope_rpm_per_v=slope, offset_v=offset_v)
