"""Engine or motor, gearbox and propeller."""

import math
from fractions import Fraction as Ratio
from itertools import pairwise
from typing import Annotated, ClassVar, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from shaftprint.settings import Name, NotNegativeNumber, Number, PositiveInteger, PositiveNumber, Settings
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


Curve = tuple[tuple[float, ...], tuple[float, ...]]
"""Ascending speeds [rpm] and the torques that belong to them [N m]."""

# Points by which constant power is drawn from base speed on: chords over 4 % of the speed are off by 0.02 %.
_POWER_POINTS, _POWER_STEP = 16, 1.04

# A power that is off by a thousand within such a factor is in another unit.
_LIKE = 3.0


class Machine(Settings):
    """What turns the line and what all of shaftprint asks of it, whether it burns fuel or takes current."""

    word: ClassVar[str]
    """What it is called in a sentence."""

    rated_power_kw: PositiveNumber
    """Maximum brake power [kW] at rated speed."""
    rated_speed_rpm: PositiveNumber
    """Rated speed [rpm]."""

    @property
    def rated_torque_nm(self) -> float:
        """Brake torque [N m] at rated power and speed."""
        omega = 2.0 * math.pi * rev_s_from_rpm(self.rated_speed_rpm)
        return 1000.0 * self.rated_power_kw / omega

    @property
    def lowest_governed_rpm(self) -> float:
        """Lowest speed that it is asked for [rpm]."""
        raise NotImplementedError

    @property
    def full_load(self) -> Curve:
        """Highest torque over speed, straight between the points and flat beyond them."""
        raise NotImplementedError

    def full_load_nm(self, speed_rpm: float) -> float:
        """Return the highest torque at a speed [N m]."""
        return float(np.interp(speed_rpm, *self.full_load))

    def full_load_shape(self, speed_rev_s: float) -> tuple[tuple[float, float], ...]:
        """Return corners of ``full_load``: deviations from a speed [rev/s], and torque over that at this speed."""
        speed_rpm, torque_nm = self.full_load
        deviation = rev_s_from_rpm(np.array(speed_rpm)) / speed_rev_s - 1.0
        share = np.array(torque_nm) / np.interp(0.0, deviation, torque_nm)
        return tuple((float(a), float(b)) for a, b in zip(deviation, share, strict=True))

    @property
    def torque_orders(self) -> tuple[Ratio, ...]:
        """What its torque repeats in one of its turns, lowest first; none where nothing fires."""
        raise NotImplementedError


class Engine(Machine):
    """One engine of the propulsion line."""

    word: ClassVar[str] = "engine"

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
        turn = 2.0 * math.pi * rev_s_from_rpm(self.rated_speed_rpm)
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
        elif speeds == torques:
            in_thousands = self.full_load_nm(self.rated_speed_rpm) / self.rated_torque_nm
            for factor, unit in ((1e-3, "W"), (1e3, "MW")):
                if 1.0 / _LIKE < in_thousands / factor < _LIKE:
                    errors.append(
                        f"expected rated_power_kw near {1e-3 * self.full_load_nm(self.rated_speed_rpm) * turn:.4g} kW, "
                        f"as full_load_torque_nm gives at rated speed, found {self.rated_power_kw:g}; in {unit}?"
                    )
        if errors:
            raise ValueError(" ".join(errors))
        return self

    @property
    def lowest_governed_rpm(self) -> float:
        """Idle speed [rpm]."""
        return self.idle_speed_rpm

    @property
    def full_load(self) -> Curve:
        """The full-load curve."""
        return self.full_load_speed_rpm, self.full_load_torque_nm

    @property
    def torque_orders(self) -> tuple[Ratio, ...]:
        """Working cycle of a cylinder and its multiples, up to the firing of all."""
        cycle = Ratio(2, self.strokes_per_cycle)
        return tuple(cycle * multiple for multiple in range(1, self.cylinders + 1))


class Motor(Machine):
    """One electric motor of the propulsion line, fed by a converter that controls its torque."""

    word: ClassVar[str] = "motor"

    lowest_speed_rpm: PositiveNumber
    """Lowest speed that the lever asks for [rpm]."""
    base_speed_rpm: PositiveNumber | None = None
    """Speed from which on power and not torque is limited [rpm]; the rated speed where not given."""
    maximum_torque_nm: PositiveNumber | None = None
    """Highest torque that the converter allows up to base speed [N m]; rated power at base speed where not given."""
    regenerating_torque_nm: NotNegativeNumber = 0.0
    """Highest braking torque up to base speed [N m]; 0 where converter and mains take nothing back."""

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        errors = []
        if self.lowest_speed_rpm >= self.rated_speed_rpm:
            errors.append(
                f"expected lowest_speed_rpm below rated_speed_rpm = {self.rated_speed_rpm:g}, "
                f"found {self.lowest_speed_rpm:g}."
            )
        if self.base_rpm > self.rated_speed_rpm:
            errors.append(
                f"expected base_speed_rpm of at most rated_speed_rpm = {self.rated_speed_rpm:g}, "
                f"found {self.base_rpm:g}."
            )
        if errors:
            raise ValueError(" ".join(errors))
        return self

    @property
    def base_rpm(self) -> float:
        """Speed from which on the power is limited [rpm]."""
        return self.rated_speed_rpm if self.base_speed_rpm is None else self.base_speed_rpm

    @property
    def highest_torque_nm(self) -> float:
        """Highest torque up to base speed [N m]."""
        if self.maximum_torque_nm is not None:
            return self.maximum_torque_nm
        return self.rated_torque_nm * self.rated_speed_rpm / self.base_rpm

    @property
    def lowest_governed_rpm(self) -> float:
        """Lowest speed that the lever asks for [rpm]."""
        return self.lowest_speed_rpm

    @property
    def full_load(self) -> Curve:
        """Torque constant up to base speed, power constant above."""
        return self._weakened(self.highest_torque_nm)

    @property
    def regenerating(self) -> Curve:
        """Braking torque, as positive numbers; its power is constant above base speed too."""
        return self._weakened(self.regenerating_torque_nm)

    @property
    def torque_orders(self) -> tuple[Ratio, ...]:
        """None: the orders of slots and currents are far above what a line moves with."""
        return ()

    def _weakened(self, torque_nm: float) -> Curve:
        shares = [_POWER_STEP**point for point in range(_POWER_POINTS)]
        return tuple(self.base_rpm * share for share in shares), tuple(torque_nm / share for share in shares)


class Gearbox(Settings):
    """Reduction gear between engine or motor and propeller shaft; a ratio of 1 where there is none."""

    ratio: PositiveNumber
    """Engine speed over propeller-shaft speed."""
    efficiency: Fraction
    """Power out over power in, from engine flange to torque gauge."""
    astern_ratio: PositiveNumber | None = None
    """The same with the clutch of astern closed, above 0; None where nobody states it."""
    clutch_torque_nm: PositiveNumber | None = None
    """Torque at the engine's side at which a closed clutch slips [N m]; None where nobody states it."""
    propeller_rated_rpm: PositiveNumber | None = None
    """Speed of the propeller shaft at rated engine speed as the papers state it [rpm]; the ratio is held against it."""

    @property
    def shaft_over_brake(self) -> float:
        """Torque at the gauge over the torque at the engine flange."""
        return self.ratio * self.efficiency

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
    """Effective ``K_Q`` at zero advance, turning ahead: ``M_s0 eta_R / (rho n_s0^2 D^5)``."""
    torque_coefficient_std: NotNegativeNumber | None = None
    """Its standard deviation; None where it is not stated."""
    astern_torque_coefficient: PositiveNumber | None = None
    """The same of a shaft that turns astern, positive too; a test astern needs it."""
    astern_torque_coefficient_std: NotNegativeNumber | None = None
    """Its standard deviation; None where it is not stated."""
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
