"""Levels, rates and widths of limits in the units of the ship, with all of their uncertainty."""

from collections.abc import Iterator

import numpy as np

from shaftprint.catalogue._limited_governor import GovernorSymbol
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.identify.fit._identification import Identification
from shaftprint.signals._working_points import WorkingPoint
from shaftprint.units import rpm_from_rev_s
from shaftprint.vessel._vessel import Vessel


def limit_numbers(fit: Identification, working_point: WorkingPoint, vessel: Vessel) -> tuple[Estimate, ...]:
    """Return the numbers of the limits of a fit.

    With the working point ``M_s0`` wrong by a share ``e``, deviations are right in N m: ``m_max = 1 + dM / M_s0`` is
    wrong by ``(m_max - 1) e``, ``M_s0 m_max`` by ``M_s0 e``, and ``r_x`` by ``r_x e``. A torque gauge that shows too
    much by a share shifts levels in N m by it, and nothing else.

    ``fit``: a fit of a limited structure. ``working_point``, ``vessel``: what the data were divided by, gear and
    full-load curve.
    """
    estimates = {estimate.name: estimate for estimate in fit.parameters}
    return tuple(number for name in estimates for number in _numbers(estimates[name], working_point, vessel))


def _numbers(estimate: Estimate, point: WorkingPoint, vessel: Vessel) -> Iterator[Estimate]:
    doubt = point.shaft_torque_std_nm / point.shaft_torque_nm
    gauge = vessel.sensors.shaft_torque.scale_std
    brake_nm = point.shaft_torque_nm / vessel.gearbox.shaft_over_brake
    speed = point.engine_speed_rev_s
    curve = vessel.machine.full_load
    full_nm = float(np.interp(rpm_from_rev_s(speed), *curve))

    def number(name: str, unit: str, meaning: str, *, scale: float = 1.0, shares: tuple[float, ...] = ()) -> Estimate:
        parts = (scale * estimate.std, *(scale * share for share in shares))
        return Estimate(
            name=name,
            unit=unit,
            value=scale * estimate.value,
            std=float(np.linalg.norm(parts)) if np.isfinite(estimate.std) else float(np.inf),
            meaning=meaning,
            at_bound=estimate.at_bound,
        )

    in_nm = (doubt, estimate.value * gauge)
    match estimate.name:
        case GovernorSymbol.TORQUE_LIMIT:
            relative = ((estimate.value - 1.0) * doubt,)
            yield number(estimate.name, "-", "torque limit over the brake torque of the working point", shares=relative)
            yield number(
                "M_max", "N m", "torque limit of the engine at the working-point speed", scale=brake_nm, shares=in_nm
            )
            share = brake_nm / full_nm
            yield number(
                "share", "-", "the same over the full-load curve of the vessel file", scale=share, shares=in_nm
            )
        case GovernorSymbol.MOTORING_LIMIT:
            relative = ((estimate.value - 1.0) * doubt,)
            yield number(estimate.name, "-", "lowest brake torque over that of the working point", shares=relative)
            yield number(
                "M_min", "N m", "torque of the motored engine at the working-point speed", scale=brake_nm, shares=in_nm
            )
        case GovernorSymbol.RACK_RATE:
            relative = (estimate.value * doubt,)
            yield number(
                estimate.name, "1/s", "fastest change of the fuel rack over that of the working point", shares=relative
            )
            yield number("R_x", "N m/s", "the same as brake torque", scale=brake_nm, shares=(estimate.value * gauge,))
        case GovernorSymbol.DEADBAND:
            rpm = rpm_from_rev_s(speed)
            yield number(estimate.name, "-", "speed error within which the governor does nothing, half of the band")
            yield number("d_e_rpm", "rpm", "the same in engine speed", scale=rpm)
        case GovernorSymbol.ANTI_WINDUP:
            yield number(estimate.name, "s", "time in which the integrator is led back at a limit")
        case GovernorSymbol.UNBOOSTED_TORQUE:
            yield number(estimate.name, "-", "torque without boost over full-load torque")
        case GovernorSymbol.TURBOCHARGER_LAG:
            yield number(estimate.name, "s", "lag of the turbocharger")
