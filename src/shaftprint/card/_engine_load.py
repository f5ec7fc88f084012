"""Does the propeller of a vessel file belong to its engine? Its load at the working point, and at rated speed."""

import math
from collections.abc import Iterator

import numpy as np

from shaftprint.card._disagreement import Disagreement
from shaftprint.digits import in_nm
from shaftprint.units import rev_s_from_rpm
from shaftprint.vessel._vessel import Vessel

CURVE_TOLERANCE = 1.1
"""Factor to which full-load curves and efficiencies are known."""

# Shares of the rated power at rated speed by the propeller law that contradict the engine and that are strange. A
# propeller chosen for free sailing takes about twice its torque at zero advance (Wageningen B4-55, pitch ratios 0.7 to
# 1.4, at 0.85 of the advance of best efficiency: 1.9 to 2.3); underway a test may be made at little thrust.
_AT_BOLLARD_PULL = (0.2, 0.4, 1.8, 3.0)
_UNDERWAY = (0.1, 0.2, 1.3, 2.0)
_SPEEDS = 2001


def engine_load(vessel: Vessel) -> Iterator[Disagreement]:
    """Hold the working torque against the full-load curve; where that has room, its power against the rated one."""
    point, machine, brake_nm = vessel.working_point, vessel.machine, _brake_nm(vessel)
    power_kw = 2.0 * math.pi * rev_s_from_rpm(point.engine_speed_rpm) * brake_nm / 1000.0
    highest_nm = machine.full_load_nm(point.engine_speed_rpm)
    if brake_nm > highest_nm:
        load, expected = (
            brake_nm / highest_nm,
            f"at most {in_nm(highest_nm)} at the {machine.word}, its full load",
        )
        found = f"{in_nm(brake_nm)} there"
    elif power_kw > machine.rated_power_kw and vessel.motor is None:
        load, expected = power_kw / machine.rated_power_kw, f"at most the rated power of {machine.rated_power_kw:g} kW"
        found = f"{power_kw:.4g} kW at the {machine.word}"
    else:
        return
    limit = "the full-load curve" if vessel.motor is None else "motor.maximum_torque_nm"
    yield Disagreement(
        field="working_point.shaft_torque_nm",
        expected=f"{expected} at {point.engine_speed_rpm:g} rpm",
        found=f"{found} with {point.shaft_torque_nm:g} N m at the shaft",
        advice="correct the torque (N m at the propeller shaft) or what it was worked out from (diameter_m and "
        f"pitch_ratio of [propeller]), gearbox.ratio, {limit} or rated_power_kw",
        is_contradiction=load > CURVE_TOLERANCE,
    )


def propeller_law(vessel: Vessel) -> Iterator[Disagreement]:
    """Hold what the propeller asks for at rated speed, ``M (n_rated / n)^2``, against the rated power."""
    point, machine, brake_nm = vessel.working_point, vessel.machine, _brake_nm(vessel)
    rated_rpm = machine.rated_speed_rpm
    share = brake_nm / machine.rated_torque_nm * (rated_rpm / point.engine_speed_rpm) ** 2
    too_light, light, heavy, too_heavy = _UNDERWAY if vessel.is_underway else _AT_BOLLARD_PULL
    # a controllable pitch may be small in the test
    if share <= heavy and (share >= light or vessel.pitch is not None):
        return
    asked = f"{share:.3g} times as much, {share * machine.rated_power_kw:.4g} kW,"
    if share > heavy:
        asked += f" and is turned at no more than {_reached_rpm(vessel):.0f} rpm of the {machine.word}"
    sailing = "underway" if vessel.is_underway else "at bollard pull"
    free = (
        "; a propeller chosen for free sailing asks for about twice the power at bollard pull: state "
        "working_point.ship_speed_m_s where the test is made underway"
        if share > heavy and not vessel.is_underway
        else ""
    )
    yield Disagreement(
        field="propeller",
        expected=f"one that asks for about the {machine.rated_power_kw:g} kW of the {machine.word} at the rated "
        f"{rated_rpm:g} rpm",
        found=f"one that asks there for {asked} {sailing} by the propeller law through the working point",
        advice="correct gearbox.ratio, propeller.diameter_m, shaft_torque_nm (with it torque_coefficient) and "
        f"{machine.word}_speed_rpm of the working point, or rated_power_kw{free}",
        is_contradiction=not too_light <= share <= too_heavy,
    )


def _reached_rpm(vessel: Vessel) -> float:
    """Return the highest speed up to the rated one at which the engine still turns the propeller [rpm]."""
    machine, working_rpm = vessel.machine, vessel.working_point.engine_speed_rpm
    speeds_rpm = np.linspace(working_rpm, max(machine.rated_speed_rpm, working_rpm), _SPEEDS)
    asked_nm = _brake_nm(vessel) * (speeds_rpm / working_rpm) ** 2
    return float(speeds_rpm[asked_nm <= np.interp(speeds_rpm, *machine.full_load)][-1])


def _brake_nm(vessel: Vessel) -> float:
    """Return the torque of one engine at the working point [N m]."""
    return vessel.engine_share * vessel.working_point.driving_torque_nm / vessel.gearbox.shaft_over_brake
