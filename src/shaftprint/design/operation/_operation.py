"""The noun ``Operation``: what engine and shaft do over a whole test, in the units of the limits."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray, frozen_float
from shaftprint.notebook._shown import Shown

if TYPE_CHECKING:
    from shaftprint.campaign._campaign import Campaign


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class Operation(Shown):
    """Set point, speed and torque of the engine over a test, on one uniform grid."""

    campaign: "Campaign"
    """What was asked of the ship."""
    time_s: FloatArray
    """Time [s], shape (samples,)."""
    set_point_rpm: FloatArray
    """Set point of the engine speed [rpm], shape (samples,)."""
    speed_rpm: FloatArray
    """Engine speed [rpm], shape (samples,)."""
    brake_torque_nm: FloatArray
    """Brake torque of the engine [N m], negative when it is motored, shape (samples,)."""
    torque_demand_nm: FloatArray | None = None
    """Brake torque that the governor asks for, before delay and lag of the engine [N m], shape (samples,); None where
    it is not known."""
    shaft_torque_nm: FloatArray | None = None
    """Shaft torque at the gauge without orders and noise [N m], shape (samples,); None where they are not apart."""

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for name in ("time_s", "set_point_rpm", "speed_rpm", "brake_torque_nm"):
            object.__setattr__(self, name, frozen_float(getattr(self, name)))
        for name in ("torque_demand_nm", "shaft_torque_nm"):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, frozen_float(getattr(self, name)))

    @property
    def rate_rpm_per_s(self) -> FloatArray:
        """Change of the set point [rpm/s], shape (samples,)."""
        return np.asarray(np.gradient(self.set_point_rpm, self.time_s))

    @property
    def stretches(self) -> dict[str, BoolArray]:
        """When each excitation runs, by its name, and what follows it, as ``after`` its name; shape (samples,)."""
        stretches: dict[str, BoolArray] = {}
        name, stop_s = "before the first excitation", -np.inf
        for one in (*self.campaign.excitations, None):
            start_s = np.inf if one is None else one.start_s
            stretches[name] = (self.time_s >= stop_s) & (self.time_s < start_s)
            if one is not None:
                name, stop_s = f"after {one.name}", one.stop_s
                stretches[one.name] = (self.time_s >= start_s) & (self.time_s < stop_s)
        return {name: inside for name, inside in stretches.items() if inside.any()}
