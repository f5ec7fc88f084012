"""The ship around the shaft lines, as far as it answers their thrust."""

from typing import Annotated

from pydantic import Field

from shaftprint.settings import NotNegativeNumber, PositiveInteger, PositiveNumber, Settings


class Hull(Settings):
    """Mass and resistance of the ship, for tests underway."""

    displacement_kg: PositiveNumber
    """Mass of the ship [kg]."""
    displacement_std_kg: NotNegativeNumber | None = None
    """Standard deviation of the mass [kg]."""
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

    @property
    def surging_mass_kg(self) -> float:
        """Mass of the ship with the water that surges with it [kg]."""
        return self.displacement_kg * (1.0 + self.added_mass_fraction)

    def resistance_at_n(self, speed_m_s: float) -> float:
        """Return the resistance [N] at a speed [m/s], ``R = R_0 (v / v_0)^e``."""
        return self.resistance_n * float((speed_m_s / self.resistance_speed_m_s) ** self.resistance_exponent)
