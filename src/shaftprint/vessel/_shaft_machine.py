"""An electric machine on the gearbox beside the engine: a motor (power take in) or a shaft generator (take out)."""

import math
from itertools import pairwise
from typing import TYPE_CHECKING, Annotated

from pydantic import Field

from shaftprint.settings import NotNegativeNumber, PositiveNumber, Settings
from shaftprint.units import rev_s_from_rpm
from shaftprint.vessel._usual import INERTIA_STD, MACHINE_SHARE_STD

if TYPE_CHECKING:
    from shaftprint.vessel._machinery import Engine, Gearbox
    from shaftprint.vessel._working_point import WorkingPoint

_ROUNDING = 1e-6


class ShaftMachine(Settings):
    """An electric machine on the gearbox of a diesel, upstream of the torque gauge.

    Its converter controls its torque; the governor of the engine keeps the speed.
    """

    rated_power_kw: PositiveNumber
    """Power on its plate [kW]."""
    rated_speed_rpm: PositiveNumber
    """Rated speed of its own shaft [rpm]."""
    ratio: PositiveNumber
    """Speed of the machine over that of the propeller shaft."""
    efficiency: Annotated[float, Field(strict=True, gt=0.0, le=1.0)] = 1.0
    """Power out over power in between machine and torque gauge, in either direction."""
    inertia_kg_m2: NotNegativeNumber
    """Mass moment of inertia of its rotor [kg m2] at the speed of its own shaft, beside the rows of ``inertia``."""
    std_kg_m2: NotNegativeNumber | None = None
    """Standard deviation of that [kg m2]; 5 % is taken where nobody has judged it."""
    share: Annotated[float, Field(strict=True, ge=-1.0, lt=1.0)]
    """Its torque at the working point over the whole torque of the propeller shaft; negative where it generates."""
    share_std: PositiveNumber = MACHINE_SHARE_STD
    """Standard deviation of the share, where no channel shows the torque."""

    def shaft_nm(self, machine_nm: float) -> float:
        """Return what a torque of the machine is at the propeller shaft [N m], in the direction of the share."""
        passed = self.efficiency if self.share >= 0.0 else 1.0 / self.efficiency
        return self.ratio * passed * machine_nm

    @property
    def referred_kg_m2(self) -> float:
        """Inertia referred to the propeller shaft [kg m2]."""
        return self.ratio**2 * self.inertia_kg_m2

    @property
    def referred_std_kg_m2(self) -> float:
        """Standard deviation of that [kg m2], as stated or as usual."""
        std = INERTIA_STD * self.inertia_kg_m2 if self.std_kg_m2 is None else self.std_kg_m2
        return self.ratio**2 * std


def wrong_shaft_machine(
    machine: ShaftMachine | None,
    engine: "Engine | None",
    gearbox: "Gearbox",
    point: "WorkingPoint",
    *,
    is_shown: bool,
) -> list[str]:
    """Return what is wrong with a machine on the gearbox beside the rest of a vessel file, one sentence each.

    ``machine``: the table; None where there is none. ``engine``, ``gearbox``, ``point``: what it works with, and where.
    ``is_shown``: whether there is a channel of its torque.
    """
    if machine is None:
        return ["expected [shaft_machine] beside sensors.machine_torque, found none."] if is_shown else []
    if engine is None:
        return [
            "expected no [shaft_machine] beside [motor], found one; it is an electric machine beside an engine, give "
            "[engine]."
        ]
    errors, torque_nm = [], point.driving_torque_nm
    # what the machine gives at its own shaft, over what it may
    machine_nm = abs(machine.share) * torque_nm / abs(machine.shaft_nm(1.0))
    # torque up to rated speed, power above
    limit_rpm = max(machine.ratio * point.engine_speed_rpm / gearbox.ratio, machine.rated_speed_rpm)
    limit_nm = 1000.0 * machine.rated_power_kw / (2.0 * math.pi * rev_s_from_rpm(limit_rpm))
    if machine_nm > (1.0 + _ROUNDING) * limit_nm:
        errors.append(
            f"expected shaft_machine.share within the machine's highest torque of {limit_nm:.4g} N m, found "
            f"{machine.share:g}, {machine_nm:.4g} N m at its shaft; correct the share, its ratio or its rated power."
        )
    engine_nm = (1.0 - machine.share) * torque_nm / gearbox.shaft_over_brake
    full_nm = _on_curve(point.engine_speed_rpm, *engine.full_load)
    if engine_nm > (1.0 + _ROUNDING) * full_nm:
        taken = "generator takes out and the propeller needs" if machine.share < 0.0 else "machine leaves"
        errors.append(
            f"expected at most {full_nm:.4g} N m of the engine at {point.engine_speed_rpm:g} rpm, its full-load "
            f"curve, found {engine_nm:.4g} N m, what the {taken} at shaft_machine.share = {machine.share:g}; correct "
            "the share or the working point."
        )
    return errors


def _on_curve(speed_rpm: float, speeds_rpm: tuple[float, ...], torques_nm: tuple[float, ...]) -> float:
    """Return the torque of a curve, straight between its points and flat beyond them."""
    if speed_rpm <= speeds_rpm[0]:
        return torques_nm[0]
    for (slow, low), (fast, high) in pairwise(zip(speeds_rpm, torques_nm, strict=True)):
        if speed_rpm <= fast:
            return low + (high - low) * (speed_rpm - slow) / (fast - slow)
    return torques_nm[-1]
