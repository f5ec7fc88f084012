"""What a plan lets the assumed ship do over time: set point, speed, brake torque, each with its noise and limits."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.design.motion._motion import SIGNALS, motion, motion_noise
from shaftprint.design.plan._plan import Plan

if TYPE_CHECKING:
    from shaftprint.design.plan._leg import Leg

# Samples a period of the fastest line.
_SAMPLES = 16


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class PlannedMotion:
    """One period of a leg, in the units of the ship."""

    leg: "Leg"
    """The leg."""
    time_s: FloatArray
    """Time in the period [s], shape (samples,)."""
    set_point_rpm: FloatArray
    """Set point [rpm], shape (samples,)."""
    speed_rpm: FloatArray
    """Engine speed of the assumed ship [rpm], shape (samples,)."""
    brake_torque_nm: FloatArray
    """Its brake torque [N m], shape (samples,)."""
    speed_std_rpm: float
    """Standard deviation of the noise of the speed [rpm]."""
    torque_std_nm: float
    """The same of the brake torque [N m]."""
    full_load_nm: FloatArray
    """Highest brake torque at that speed [N m], shape (samples,)."""
    motoring_nm: FloatArray
    """Lowest brake torque at that speed [N m], shape (samples,)."""


def planned_motion(plan: Plan) -> tuple[PlannedMotion, ...]:
    """Return one period of each leg, once it has settled, at the assumed values."""
    return tuple(_of_leg(plan, number) for number in range(len(plan.legs)))


def _of_leg(plan: Plan, number: int) -> PlannedMotion:
    leg, structure, limits = plan.legs[number], plan.structures[number], plan.limits
    time_s = leg.period_s * np.linspace(0.0, 1.0, _SAMPLES * leg.harmonics[-1] + 1)
    omega = 2.0 * np.pi * leg.frequency_hz
    responses = motion(structure, plan.ship.values[None, :], omega)[0]
    amplitudes = responses * leg.amplitudes
    about = np.zeros((len(SIGNALS), time_s.size))
    for frequency, column in zip(omega, amplitudes.T, strict=True):
        about += (column[:, None] * np.exp(1j * frequency * time_s)).real
    std = np.sqrt(np.diag(motion_noise(structure, plan.ship.values, plan.noise[number])))
    torque_nm = leg.speed_share**2 * limits.brake_torque_nm
    signals = {name: place for place, name in enumerate(SIGNALS)}
    speed_rpm = leg.level_rpm * (1.0 + about[signals["speed"]])
    return PlannedMotion(
        leg=leg,
        time_s=frozen_float(time_s),
        set_point_rpm=frozen_float(leg.level_rpm * (1.0 + about[signals["set point"]])),
        speed_rpm=frozen_float(speed_rpm),
        brake_torque_nm=frozen_float(torque_nm * (1.0 + about[signals["brake torque"]])),
        speed_std_rpm=leg.level_rpm * float(std[signals["speed"]]),
        torque_std_nm=torque_nm * float(std[signals["brake torque"]]),
        full_load_nm=frozen_float(np.interp(speed_rpm, *np.array(limits.full_load).T)),
        motoring_nm=frozen_float(-np.interp(speed_rpm, *np.array(limits.motoring).T)),
    )
