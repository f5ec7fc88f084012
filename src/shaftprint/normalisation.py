"""Speed and torque of a working point, by which models are normalised: the one place of ``tau = 2 pi I n_s0 / M_s0``.

Models know deviations over their values at the working point (thesis eqs 2.14-2.25). An inertia of ``I`` kg m2 on the
propeller shaft is there a time, ``2 pi I n_s0 / M_s0`` (thesis eq. 2.23).
"""

import math
from dataclasses import dataclass

from shaftprint.units import SECONDS_PER_MINUTE


def inertia_time_s(inertia_kg_m2: float, *, shaft_speed_rev_s: float, shaft_torque_nm: float) -> float:
    """Return ``tau = 2 pi I n_s0 / M_s0`` [s] of an inertia on the propeller shaft [kg m2] (thesis eq. 2.23)."""
    return 2.0 * math.pi * inertia_kg_m2 * shaft_speed_rev_s / shaft_torque_nm


@dataclass(frozen=True, kw_only=True, slots=True)
class Normalisation:
    """What one unit of a normalised number is in the units of the ship."""

    engine_speed_rev_s: float
    """Engine speed of the working point [rev/s]."""
    gear_ratio: float
    """Engine speed over shaft speed [-]."""
    shaft_torque_nm: float
    """Shaft torque of the working point at the gauge [N m]."""

    @property
    def shaft_speed_rev_s(self) -> float:
        """Speed of the propeller shaft [rev/s]."""
        return self.engine_speed_rev_s / self.gear_ratio

    def inertia_time_s(self, inertia_kg_m2: float) -> float:
        """Return the inertia time [s] of an inertia on the propeller shaft [kg m2]."""
        return inertia_time_s(
            inertia_kg_m2, shaft_speed_rev_s=self.shaft_speed_rev_s, shaft_torque_nm=self.shaft_torque_nm
        )

    @property
    def inertia_kg_m2(self) -> float:
        """Inertia on the propeller shaft whose inertia time is 1 s [kg m2]."""
        return 1.0 / self.inertia_time_s(1.0)

    @property
    def torque_nm_per_rpm(self) -> float:
        """Torque at the propeller shaft for one rpm of engine speed, of a gain of 1 [N m/rpm]."""
        return self.shaft_torque_nm / (self.engine_speed_rev_s * SECONDS_PER_MINUTE)
