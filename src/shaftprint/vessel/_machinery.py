"""Engine, gearbox, propeller, and the point at which they were tested."""

import math
from itertools import pairwise
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from shaftprint.settings import (
    Name,
    NotNegativeNumber,
    Number,
    PositiveInteger,
    PositiveNumber,
    Settings,
)
from shaftprint.units import rev_s_from_rpm
from shaftprint.vessel._usual import PITCH_STD

Fraction = Annotated[float, Field(strict=True, gt=0.0, le=1.0)]


class RackMap(Settings):
    """Brake torque over engine speed and fuel rack, ``M_b = A_1 n_e + A_2 X + A_3`` (thesis eq. 2.6).

    The rack ``X`` is a fraction: 1 gives rated torque at rated speed.
    """

    speed_slope_nm_per_rev_s: Number
    """``A_1`` [N m per rev/s], engine side."""
    rack_slope_nm: PositiveNumber
    """``A_2`` [N m per full rack]."""
    intercept_nm: Number
    """``A_3`` [N m]."""


class Engine(Settings):
    """One engine of the propulsion line."""

    rated_power_kw: PositiveNumber
    """Maximum brake power [kW] at rated speed."""
    rated_speed_rpm: PositiveNumber
    """Rated speed [rpm]."""
    idle_speed_rpm: PositiveNumber
    """Lowest governed speed [rpm]."""
    cylinders: PositiveInteger
    """Number of cylinders."""
    strokes_per_cycle: Annotated[int, Field(strict=True)]
    """2 or 4."""
    full_load_speed_rpm: tuple[PositiveNumber, ...]
    """Speeds of the full-load curve [rpm], ascending, shape (points,)."""
    full_load_torque_nm: tuple[PositiveNumber, ...]
    """Highest brake torque at those speeds [N m], shape (points,)."""
    rack_map: RackMap | None = None
    """Brake torque over speed and rack, where it is known."""

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        errors = []
        if self.idle_speed_rpm >= self.rated_speed_rpm:
            errors.append(
                f"expected idle_speed_rpm below rated_speed_rpm = {self.rated_speed_rpm:g}, "
                f"found {self.idle_speed_rpm:g}."
            )
        if self.strokes_per_cycle not in (2, 4):
            errors.append(f"expected strokes_per_cycle 2 or 4, found {self.strokes_per_cycle}.")
        speeds, torques = len(self.full_load_speed_rpm), len(self.full_load_torque_nm)
        if speeds != torques or speeds < 2:
            errors.append(
                "expected full_load_speed_rpm and full_load_torque_nm of equal length, at least 2, "
                f"found {speeds} and {torques}."
            )
        if any(later <= earlier for earlier, later in pairwise(self.full_load_speed_rpm)):
            errors.append("expected ascending speeds in full_load_speed_rpm.")
        if errors:
            raise ValueError(" ".join(errors))
        return self

    @property
    def rated_torque_nm(self) -> float:
        """Brake torque [N m] at rated power and speed."""
        omega = 2.0 * math.pi * rev_s_from_rpm(self.rated_speed_rpm)
        return 1000.0 * self.rated_power_kw / omega


class Gearbox(Settings):
    """Reduction gear between engine and propeller shaft."""

    ratio: PositiveNumber
    """Engine speed over propeller-shaft speed."""
    efficiency: Fraction
    """Power out over power in, from engine flange to torque gauge."""
    propeller_rated_rpm: PositiveNumber | None = None
    """Speed of the propeller shaft at rated engine speed as the papers state it [rpm]; the ratio is held against it."""

    def engine_over(self, shaft: Literal["engine", "propeller"]) -> float:
        """Return the speed of the engine over that of a shaft."""
        return self.ratio if shaft == "propeller" else 1.0

    def over_propeller(self, shaft: Literal["engine", "propeller"]) -> float:
        """Return the speed of a shaft over that of the propeller shaft."""
        return self.ratio if shaft == "engine" else 1.0


class Propeller(Settings):
    """The propeller on the instrumented shaft."""

    diameter_m: PositiveNumber
    """Diameter [m]."""
    pitch_ratio: PositiveNumber
    """Pitch over diameter."""
    blades: PositiveInteger
    """Number of blades."""
    area_ratio: Fraction | None = None
    """Expanded blade area over disc area ``A_E / A_0``."""
    torque_coefficient: PositiveNumber
    """Effective ``K_Q`` at zero advance: ``M_s0 eta_R / (rho n_s0^2 D^5)``."""
    relative_rotative_efficiency: PositiveNumber = 1.0
    """``eta_R``, open-water torque over torque behind the ship."""
    series: Name | None = None
    """Propeller series and nozzle to which it is compared."""
    pitch_std_fraction: NotNegativeNumber | None = None
    """Relative standard deviation of the pitch; see ``pitch_std`` where it is not stated."""

    @property
    def pitch_std(self) -> float:
        """Relative standard deviation of the pitch, as stated or as usual."""
        return PITCH_STD if self.pitch_std_fraction is None else self.pitch_std_fraction


class WorkingPoint(Settings):
    """The steady state that is expected between the test signals."""

    engine_speed_rpm: PositiveNumber
    """Engine speed ``n_0`` [rpm]."""
    shaft_torque_nm: PositiveNumber
    """Shaft torque ``M_s0`` [N m] at the gauge."""
    ship_speed_m_s: PositiveNumber | None = None
    """Speed of the ship through the water [m/s] where the test is made underway; None at the quay."""
