"""The noun ``Lever``: what the channel of the set point shows for volts of a campaign, where it is none of volts."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arrays import FloatArray
from shaftprint.errors import DesignError
from shaftprint.notebook._shown import Shown

if TYPE_CHECKING:
    from shaftprint.vessel._set_point import SetPointSensor


@dataclass(frozen=True, kw_only=True, slots=True, repr=False)
class Lever(Shown):
    """From volts of the campaign to what is set and seen on board: ``U = v_per_unit * reading + v_at_zero``."""

    unit: Literal["mA", "%", "rpm", "counts"]
    """Unit of the channel."""
    v_per_unit: float
    """Volts of the campaign for one unit of the channel [V per unit]."""
    v_at_zero: float = 0.0
    """Volts of the campaign where the channel shows 0 [V]."""

    def __post_init__(self) -> None:
        """Check that a voltage has a reading. Raises DesignError if the scale is zero, or a number is not finite."""
        if self.v_per_unit == 0.0 or not all(map(math.isfinite, (self.v_per_unit, self.v_at_zero))):
            raise DesignError(
                f"lever in {self.unit}: expected a finite scale other than 0 V for one {self.unit} and a finite "
                f"voltage, found {self.v_per_unit:g} V and {self.v_at_zero:g} V."
            )

    def reading(self, volts: ArrayLike) -> FloatArray:
        """Return what the channel shows, in its unit, for volts of the campaign, of any shape."""
        return (np.asarray(volts, dtype=np.float64) - self.v_at_zero) / self.v_per_unit


def lever_of_sensor(sensor: "SetPointSensor") -> Lever | None:
    """Return the lever of a vessel file; None where it is moved in volts, which the campaign's are."""
    if sensor.unit == "V":
        return None
    return Lever(unit=sensor.unit, v_per_unit=sensor.slope_v, v_at_zero=sensor.v_at_zero or 0.0)
