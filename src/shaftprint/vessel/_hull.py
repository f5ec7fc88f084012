"""The ship around the shaft lines, as far as it answers their thrust."""

import math
from typing import Annotated

from pydantic import Field

from shaftprint.settings import NotNegativeNumber, PositiveInteger, PositiveNumber, Settings
from shaftprint.vessel._usual import MASS_STD, WASH_SHARE_STD

WakeFraction = Annotated[float, Field(strict=True, gt=-0.2, lt=0.6)]


class Hull(Settings):
    """Mass and resistance of the ship, for tests underway."""

    displacement_kg: PositiveNumber
    """Mass of the ship [kg]."""
    displacement_std_kg: NotNegativeNumber | None = None
    """Standard deviation of the mass [kg]; 3 % of it where it is not stated."""
    added_mass_fraction: Annotated[float, Field(strict=True, ge=0.0, le=1.0)]
    """Water that surges with the ship, as a fraction of its mass."""
    shafts: PositiveInteger
    """Number of equal shaft lines."""
    resistance_n: PositiveNumber
    """Resistance of the ship at one speed [N]."""
    resistance_std_n: NotNegativeNumber | None = None
    """Standard deviation of the resistance [N]."""
    resistance_speed_m_s: PositiveNumber
    """Speed through the water at which it has that resistance [m/s]."""
    resistance_exponent: PositiveNumber
    """``e = d ln R / d ln v`` around that speed."""
    wake_fraction: WakeFraction | None = None
    """``w``: the propellers see ``v (1 - w)``; None where nobody states it."""
    wake_fraction_std: NotNegativeNumber | None = None
    """Standard deviation of the wake fraction."""
    thrust_deduction: WakeFraction | None = None
    """``t``: of the thrust ``T (1 - t)`` pulls the ship; None where nobody states it."""
    thrust_deduction_std: NotNegativeNumber | None = None
    """Standard deviation of the thrust deduction."""
    wash_share: Annotated[float, Field(strict=True, ge=-0.5, le=0.5)] = 0.0
    """Share of its torque that this propeller loses at the quay where the wash of the other one is twice as fast."""
    wash_share_std: PositiveNumber | None = None
    """Standard deviation of that share; 0.02 where it is not stated."""

    @property
    def surging_mass_kg(self) -> float:
        """Mass of the ship with the water that surges with it [kg]."""
        return self.displacement_kg * (1.0 + self.added_mass_fraction)

    @property
    def surging_mass_std_kg(self) -> float:
        """Standard deviation of that mass [kg], as stated or as usual."""
        stated = self.displacement_std_kg
        share = MASS_STD if stated is None else stated / self.displacement_kg
        return share * self.surging_mass_kg

    @property
    def wash_std(self) -> float:
        """Standard deviation of the share of the wash, as stated or as usual."""
        return WASH_SHARE_STD if self.wash_share_std is None else self.wash_share_std

    def surge_time_s(self, speed_m_s: float) -> tuple[float, float]:
        """Return ``m v / R`` [s], in which the ship would lose a speed [m/s], and its standard deviation."""
        time_s = self.surging_mass_kg * speed_m_s / self.resistance_at_n(speed_m_s)
        of_mass = self.surging_mass_std_kg / self.surging_mass_kg
        return time_s, time_s * math.hypot(of_mass, (self.resistance_std_n or 0.0) / self.resistance_n)

    def resistance_at_n(self, speed_m_s: float) -> float:
        """Return the resistance [N] at a speed [m/s], ``R = R_0 (v / v_0)^e``."""
        return self.resistance_n * float((speed_m_s / self.resistance_speed_m_s) ** self.resistance_exponent)
