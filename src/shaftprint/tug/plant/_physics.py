"""From the normalised truth of a tug to the physical constants of its propulsion line."""

import math
from typing import NamedTuple

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import SettingsError
from shaftprint.tug._coupling import Coupling
from shaftprint.tug._sailing import AT_THE_QUAY, steady_ship_speed_m_s, steady_torque_nm, way_of
from shaftprint.tug._tug import USUAL_MOTORING_NM, Tug
from shaftprint.tug.plant._constants import Plant
from shaftprint.tug.plant._plant import ENGINE, INTEGRAL, RACK, SLIPSTREAM, SPEED, STATES, TWIST, WAY
from shaftprint.units import rev_s_from_rpm
from shaftprint.vessel._vessel import Vessel

# Speed over that of the working point up to which friction grows in proportion; no engine gets there.
_FASTEST_SHARE = 10.0
# Speed over base speed up to which the field of a motor is weakened, and the points at which its torque is stated.
_FASTEST_MOTOR_SHARE, _POWER_CHORDS = 2.0, 80


def build_plant(tug: Tug, vessel: Vessel) -> Plant:
    """Convert the normalised truth of a tug to physical constants, so that its working point is an equilibrium.

    ``A_1 = g M_b0 / n_e0``, ``A_2 X_0 = v M_b0``, ``A_3 = (1 - g - v) M_b0`` with rack 1 at rated torque and speed;
    ``K_p = K_p* X_0 / n_e0`` and ``K_i`` alike (thesis "Fingerprinting II", equations 2.4, 2.6 and 2.13 to 2.20).

    Parameters
    ----------
    tug
        The truth.
    vessel
        Ratio, efficiency, full-load curve and, where the truth does not give them, the inertias.

    Returns
    -------
    plant
        Constants in SI units, speeds in rev/s.

    Raises
    ------
    SettingsError
        If the truth is not physical.
    """
    _check(tug)
    if vessel.motor is not None:
        _check_motor(tug)
    if tug.pitch is not None and tug.sailing is not None:
        raise SettingsError("tug: expected pitch of a tug at the quay, found it beside sailing, which has its own lag.")
    speed, torque = working_point(tug, vessel)
    ratio, efficiency = vessel.gearbox.ratio, vessel.gearbox.efficiency
    machine_nm = _machine_nm(tug, vessel, torque)
    brake = (torque - machine_nm) / (ratio * efficiency)
    # a gearbox that reverses: the engine turns as ever
    turning = vessel.working_point.turning
    speed_slope = tug.g * brake / speed
    offset = (1.0 - tug.g - tug.v) * brake
    rated = rev_s_from_rpm(vessel.machine.rated_speed_rpm)
    rack_slope = vessel.machine.rated_torque_nm - speed_slope * rated - offset
    rack = tug.v * brake / rack_slope
    limits = _torque_limits(tug, vessel, speed)
    coupling = tug.coupling
    upstream, downstream = tug.inertia_upstream_kg_m2, tug.inertia_downstream_kg_m2
    upstream = vessel.inertia_upstream_kg_m2 if upstream is None else upstream
    if coupling is not None:
        _check_coupling(coupling, upstream)
    downstream = vessel.inertia_downstream_kg_m2 if downstream is None else downstream
    return Plant(
        inertia_upstream_kg_m2=upstream,
        inertia_downstream_kg_m2=downstream + tug.entrained_water_kg_m2,
        gear_ratio=turning * ratio,
        efficiency=efficiency,
        propeller_nm_s2=torque / (speed / ratio) ** 2,
        inflow_gain=tug.inflow_gain,
        inflow_per_rev=ratio / (2.0 * speed * tug.inflow_time_s),
        speed_slope_nm_s=speed_slope,
        rack_slope_nm=rack_slope,
        rack_offset_nm=offset,
        proportional_s=tug.proportional_gain * rack / speed,
        integral=tug.integral_gain_per_s * rack / speed,
        anti_windup_s=tug.anti_windup_s,
        delay_s=tug.governor_delay_s,
        natural_frequency_rad_s=tug.natural_frequency_rad_s if vessel.motor is None else 0.0,
        damping_ratio=tug.damping_ratio,
        point_speed_rev_s=speed,
        gain_exponent=tug.governor_gain_exponent,
        delay_exponent=tug.governor_delay_exponent,
        limit_speed_rev_s=limits.highest[0],
        limit_torque_nm=limits.highest[1],
        motoring_speed_rev_s=limits.lowest[0],
        motoring_torque_nm=limits.lowest[1],
        torque_per_s=0.0 if vessel.motor is None else 1.0 / tug.torque_time_s,
        deadband_rev_s=rev_s_from_rpm(tug.governor_deadband_rpm),
        rack_rate_limit_per_s=np.inf if tug.rack_rate_limit_per_s is None else tug.rack_rate_limit_per_s,
        air_share=tug.unboosted_torque_share,
        turbocharger_lag_s=tug.turbocharger_lag_s,
        coupling_nm_rev=0.0 if coupling is None else 2.0 * math.pi * coupling.stiffness_nm_rad,
        coupling_nm_s_rev=0.0 if coupling is None else 2.0 * math.pi * coupling.damping_nm_s_rad,
        inertia_driven_kg_m2=0.0 if coupling is None else coupling.driven_kg_m2,
        machine_nm=machine_nm,
        sails=tug.sailing is not None,
        way=AT_THE_QUAY if tug.sailing is None else way_of(tug.sailing, vessel),
    )


def _machine_nm(tug: Tug, vessel: Vessel, torque_nm: float) -> float:
    """Return the torque of the electric machine on the gearbox at the propeller shaft [N m]; 0 where there is none.

    Raises SettingsError if vessel and truth do not both have one, or the engine has nothing left to give.
    """
    machine = tug.shaft_machine
    if (machine is None) != (vessel.shaft_machine is None):
        have, lack = ("vessel", "tug") if machine is None else ("tug", "vessel")
        raise SettingsError(
            f"{lack}: expected a shaft_machine, as the {have} has one on its gearbox, found none; give both or neither."
        )
    if machine is None:
        return 0.0
    if vessel.working_point.is_astern:
        raise SettingsError(
            f"vessel {vessel.name}: expected a shaft that turns ahead where an electric machine is on the gearbox of a "
            "simulated ship, found one that turns astern; leave out working_point.direction or [shaft_machine]."
        )
    if not -1.0 <= machine.share < 1.0:
        raise SettingsError(
            f"tug: expected shaft_machine.share from -1 to below 1, found {machine.share:g}; the engine gives the rest "
            "of the torque."
        )
    return machine.share * torque_nm


class _TorqueLimits(NamedTuple):
    """Highest and lowest torque over speed, the lowest as positive numbers [rev/s, N m]."""

    highest: tuple[FloatArray, FloatArray]
    lowest: tuple[FloatArray, FloatArray]


def _torque_limits(tug: Tug, vessel: Vessel, speed_rev_s: float) -> _TorqueLimits:
    """Return what engine or motor can give and take."""
    motor = vessel.motor
    if motor is None:
        speeds_rpm, torques_nm = vessel.machine.full_load
        highest = rev_s_from_rpm(np.array(speeds_rpm)), np.array(torques_nm)
        return _TorqueLimits(highest, _motoring(tug, vessel, speed_rev_s))
    base = rev_s_from_rpm(motor.base_rpm)
    braking = motor.regenerating_torque_nm if tug.motoring_torque_nm is None else tug.motoring_torque_nm
    # constant power above base speed, by chords that are at most a hundred-thousandth off
    share = np.geomspace(1.0, _FASTEST_MOTOR_SHARE, _POWER_CHORDS)
    return _TorqueLimits((base * share, motor.highest_torque_nm / share), (base * share, braking / share))


def _motoring(tug: Tug, vessel: Vessel, speed_rev_s: float) -> tuple[FloatArray, FloatArray]:
    """Return speeds [rev/s] and torques [N m] of the motoring curve: of the truth, else of the vessel file, else usual.

    Friction of a motored engine of which one number is known at a speed: half of it independent of speed, half
    proportional.
    """
    limits = vessel.limits
    if tug.motoring_torque_nm is None and limits.motoring_speed_rpm:
        return rev_s_from_rpm(np.array(limits.motoring_speed_rpm)), np.array(limits.motoring_torque_nm)
    at_speed_nm = USUAL_MOTORING_NM if tug.motoring_torque_nm is None else tug.motoring_torque_nm
    shares = np.array([0.0, _FASTEST_SHARE])
    return shares * speed_rev_s, at_speed_nm * (0.5 + 0.5 * shares)


def working_point(tug: Tug, vessel: Vessel) -> tuple[float, float]:
    """Return the engine speed [rev/s] and the driving shaft torque [N m] at which the truth is normalised.

    Both are above 0 astern too.
    """
    point = vessel.working_point
    speed_rpm = point.engine_speed_rpm if tug.engine_speed_rpm is None else tug.engine_speed_rpm
    if tug.sailing is not None:
        if point.is_astern:
            raise SettingsError(
                f"tug: expected a tug that stands still where vessel {vessel.name} says astern, found one that sails "
                "free; leave out sailing, or direction of its working point."
            )
        if tug.shaft_torque_nm is not None:
            raise SettingsError(
                f"tug: expected no shaft_torque_nm for a tug that sails free, found {tug.shaft_torque_nm:g}; its "
                "torque follows from propeller and resistance."
            )
        speed_s = rev_s_from_rpm(speed_rpm) / vessel.gearbox.ratio
        return rev_s_from_rpm(speed_rpm), steady_torque_nm(way_of(tug.sailing, vessel), speed_s)
    torque_nm = point.driving_torque_nm if tug.shaft_torque_nm is None else tug.shaft_torque_nm
    return rev_s_from_rpm(speed_rpm), torque_nm


def working_point_rack(tug: Tug, vessel: Vessel) -> float:
    """Return the fuel rack ``X_0`` of the working point [fraction]."""
    speed, _ = working_point(tug, vessel)
    return float(equilibrium(build_plant(tug, vessel), speed)[RACK])


def equilibrium(plant: Plant, engine_speed_rev_s: float) -> FloatArray:
    """Return the state in which the line runs steadily at an engine speed [rev/s], angle zero, shape (states,)."""
    speed_s = engine_speed_rev_s / plant.gear_ratio
    load = steady_load_nm(plant, speed_s)
    brake = (load - plant.machine_nm) / (plant.gear_ratio * plant.efficiency)
    rack = (brake - plant.speed_slope_nm_s * engine_speed_rev_s - plant.rack_offset_nm) / plant.rack_slope_nm
    state = np.zeros(STATES)
    state[SPEED], state[INTEGRAL], state[RACK], state[SLIPSTREAM] = speed_s, rack, rack, speed_s
    state[WAY] = steady_ship_speed_m_s(plant.way, speed_s) if plant.sails else 0.0
    state[ENGINE] = speed_s
    state[TWIST] = load / plant.coupling_nm_rev if plant.coupling_nm_rev else 0.0
    return state


def steady_load_nm(plant: Plant, shaft_speed_rev_s: float) -> float:
    """Return the torque of the propeller [N m] in steady running at a shaft speed [rev/s]."""
    if plant.sails:
        return steady_torque_nm(plant.way, shaft_speed_rev_s)
    return plant.propeller_nm_s2 * shaft_speed_rev_s * abs(shaft_speed_rev_s)


def steady_boost(plant: Plant, engine_speed_rev_s: float) -> float:
    """Return the boost in steady running at an engine speed [rev/s]: the share of the full-load torque, at most 1."""
    speed_s = engine_speed_rev_s / plant.gear_ratio
    brake = (steady_load_nm(plant, speed_s) - plant.machine_nm) / (plant.gear_ratio * plant.efficiency)
    return min(brake / float(np.interp(engine_speed_rev_s, plant.limit_speed_rev_s, plant.limit_torque_nm)), 1.0)


def shaft_time_constant_s(inertia_kg_m2: float, tug: Tug, vessel: Vessel) -> float:
    """Return ``tau = 2 pi I n_s0 / M_s0`` [s] of an inertia referred to the propeller shaft."""
    speed, torque = working_point(tug, vessel)
    return 2.0 * math.pi * inertia_kg_m2 * speed / (vessel.gearbox.ratio * torque)


def _check_coupling(coupling: Coupling, upstream_kg_m2: float) -> None:
    """Refuse a coupling that holds nothing, gives energy, or drives more than there is ahead of the gauge.

    Raises SettingsError if it is such a one.
    """
    if not coupling.stiffness_nm_rad > 0.0:
        raise SettingsError(
            f"tug: expected a coupling with stiffness_nm_rad above 0, found {coupling.stiffness_nm_rad:g}; "
            "give none for a rigid line."
        )
    if not coupling.damping_nm_s_rad >= 0.0:
        raise SettingsError(
            f"tug: expected a coupling with damping_nm_s_rad of at least 0, found {coupling.damping_nm_s_rad:g}."
        )
    if not 0.0 <= coupling.driven_kg_m2 < upstream_kg_m2:
        raise SettingsError(
            f"tug: expected a coupling with driven_kg_m2 from 0 to below the {upstream_kg_m2:g} kg m2 upstream of the "
            f"gauge, of which it is a part, found {coupling.driven_kg_m2:g}."
        )


def _check_motor(tug: Tug) -> None:
    """Refuse what an engine has and a motor whose torque is controlled has not.

    Raises SettingsError if the truth has it.
    """
    without = {"g": 0.0, "v": 1.0, "unboosted_torque_share": 1.0, "rack_rate_limit_per_s": None}
    for name, value in without.items():
        if getattr(tug, name) != value:
            raise SettingsError(
                f"tug: expected no {name} where a motor drives the line, whose torque is controlled, found "
                f"{getattr(tug, name):g}; leave it out."
            )


def _check(tug: Tug) -> None:
    positive = (
        "engine_speed_rpm",
        "shaft_torque_nm",
        "inertia_upstream_kg_m2",
        "inertia_downstream_kg_m2",
        "v",
        "anti_windup_s",
        "natural_frequency_rad_s",
        "damping_ratio",
        "motoring_torque_nm",
        "generator_step_v",
        "generator_cycle_s",
        "demand_resolution_rpm",
        "demand_cycle_s",
        "demand_rate_limit_rpm_per_s",
        "torque_time_s",
        "inflow_time_s",
        "rack_rate_limit_per_s",
        "unboosted_torque_share",
        "turbocharger_lag_s",
    )
    for name in positive:
        value = getattr(tug, name)
        if value is not None and not value > 0.0:
            raise SettingsError(f"tug: expected {name} above 0, found {value:g}; give a positive value.")
    not_negative = (
        "proportional_gain",
        "integral_gain_per_s",
        "governor_delay_s",
        "set_point_latency_s",
        "entrained_water_kg_m2",
        "inflow_gain",
        "rack_latency_s",
        "governor_deadband_rpm",
    )
    for name in not_negative:
        value = getattr(tug, name)
        if value is not None and not value >= 0.0:
            raise SettingsError(f"tug: expected {name} of at least 0, found {value:g}; give 0 or a positive value.")
    if tug.unboosted_torque_share > 1.0:
        raise SettingsError(
            f"tug: expected unboosted_torque_share of at most 1, found {tug.unboosted_torque_share:g}; "
            "it is a share of the full-load torque."
        )
    if tug.rack_rate_limit_per_s is not None and tug.governor_delay_s == 0.0:
        raise SettingsError(
            "tug: expected a governor_delay_s with rack_rate_limit_per_s, found 0; give a delay or no limit."
        )
