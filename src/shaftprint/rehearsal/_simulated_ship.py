"""The simulated tug that has the numbers which a plan assumes of its ship, and the limits that it was planned for."""

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from shaftprint.catalogue._known_propeller import OF_THE_SHIP, sails_free
from shaftprint.catalogue._roles import ShipRole
from shaftprint.choices import CLOSED_LOOPS
from shaftprint.design.operation._limit_use import stated_limits
from shaftprint.errors import DesignError
from shaftprint.normalisation import Normalisation
from shaftprint.tug._like_stan_tug import like_stan_tug_1205
from shaftprint.tug._tug import Tug
from shaftprint.units import rev_s_from_rpm

if TYPE_CHECKING:
    from shaftprint.design.plan._plan import Plan
    from shaftprint.design.planned_test._planned_test import PlannedTest
    from shaftprint.models._role import Role
    from shaftprint.vessel._vessel import Vessel

# The propeller of the simulated tug takes the square of its speed.
_LOAD_SLOPE = 2.0
_NEEDED = {
    "proportional_gain": ShipRole.PROPORTIONAL_GAIN,
    "integral_gain_per_s": ShipRole.INTEGRAL_GAIN,
    "governor_delay_s": ShipRole.LOOP_DELAY,
    "inertia_upstream_kg_m2": ShipRole.INERTIA_UPSTREAM,
    "inertia_downstream_kg_m2": ShipRole.INERTIA_DOWNSTREAM,
}
_OF_ENGINE = {
    "natural_frequency_rad_s": ShipRole.ACTUATOR_FREQUENCY,
    "damping_ratio": ShipRole.ACTUATOR_DAMPING,
}
_OF_MOTOR = {"torque_time_s": ShipRole.TORQUE_TIME}
_OPTIONAL = {
    "g": ShipRole.ENGINE_SPEED_SLOPE,
    "v": ShipRole.ENGINE_RACK_SLOPE,
    "set_point_latency_s": ShipRole.SET_POINT_LATENCY,
}
_INERTIAS = ("inertia_upstream_kg_m2", "inertia_downstream_kg_m2")
_IDEAL = {
    ShipRole.SET_POINT_SCALE: 1.0,
    ShipRole.SET_POINT_BEND: 0.0,
    ShipRole.TORQUE_LATENCY: 0.0,
    ShipRole.LOAD_SLOPE: _LOAD_SLOPE,
    ShipRole.LOG_LATENCY: 0.0,
}


def tug_of_plan(test: "PlannedTest", vessel: "Vessel") -> Tug:
    """Return the simulated ship that a plan assumes, with its limits of demand and motoring.

    Underway it sails free as the ship of the vessel file does, with its mass, resistance, wake and thrust deduction.

    ``test``: what is sailed. ``vessel``: the installation. Raises DesignError if the structure of the plan lacks a
    number that the simulated ship needs.
    """
    plan, limits = test.plan, test.plan.limits
    needed = _NEEDED | (_OF_ENGINE if vessel.motor is None else _OF_MOTOR)
    values = {name: _value(plan, role) for name, role in needed.items()}
    missing = [needed[name].name for name, value in values.items() if value is None]
    if missing:
        raise DesignError(
            f"rehearsal of {plan.ship.structure.name}: expected a closed loop such as "
            f"{CLOSED_LOOPS[vessel.drive]}, which is what can be simulated, found one without "
            f"{', '.join(missing)}; plan it without --rehearse."
        )
    torque_nm = limits.brake_torque_nm * vessel.gearbox.shaft_over_brake
    point = Normalisation(
        engine_speed_rev_s=rev_s_from_rpm(limits.engine_speed_rpm),
        gear_ratio=vessel.gearbox.ratio,
        shaft_torque_nm=torque_nm,
    )
    optional = {name: _value(plan, role) for name, role in _OPTIONAL.items()}
    motoring_nm = float(np.interp(limits.engine_speed_rpm, *np.array(limits.motoring).T))
    tug = Tug(
        engine_speed_rpm=limits.engine_speed_rpm,
        # underway it follows from propeller and resistance
        shaft_torque_nm=None if vessel.is_underway else torque_nm,
        set_point_slope_rpm_per_v=test.line.slope_rpm_per_v,
        set_point_intercept_rpm=limits.engine_speed_rpm - test.line.slope_rpm_per_v * test.line.offset_v,
        set_point_offset_v=0.0,
        demand_resolution_rpm=limits.demand_resolution_rpm,
        demand_cycle_s=limits.demand_cycle_s,
        demand_rate_limit_rpm_per_s=limits.demand_rate_limit_rpm_per_s,
        sailing=like_stan_tug_1205(vessel, offset_v=test.line.offset_v).sailing,
    )
    # without a statement of the user's the curve of the vessel file holds, at all speeds
    if motoring_nm > 0.0 and limits.motoring != stated_limits(vessel).motoring:
        tug = replace(tug, motoring_torque_nm=motoring_nm)
    stated = {name: value for name, value in (values | optional).items() if value is not None}
    numbers: dict[str, Any] = {
        name: value * point.inertia_kg_m2 if name in _INERTIAS else value for name, value in stated.items()
    }
    return replace(tug, **numbers)


def simulated_truth(plan: "Plan", sailed: Mapping[str, float] | None = None) -> dict[str, float]:
    """Return what an identification of the simulated ship is to find: parameters and combinations by name.

    Sensors are ideal, the propeller takes the square of its speed, and what holds and quantises the demand adds to the
    latency of the set point. Underway the scale of the set point is left out: the volts of one speed are made rpm by
    slow lines, whose speed the ship bends, and what that errs by is what the fit finds.

    ``plan``: what is sailed. ``sailed``: ``normalised_truth`` of the simulated ship, for slopes and times of one that
    sails free; those of the plan where it is not given.
    """
    structure, values = plan.ship.structure, plan.ship.by_name
    for role, ideal in _IDEAL.items():
        name = structure.named_as(role)
        if name in values:
            values[name] = ideal
    values |= {name: value for name, value in (sailed or {}).items() if name in OF_THE_SHIP and name in values}
    if sails_free(structure):
        values = {name: value for name, value in values.items() if name != structure.named_as(ShipRole.SET_POINT_SCALE)}
    latency = structure.named_as(ShipRole.SET_POINT_LATENCY)
    if latency in values:
        values[latency] += plan.limits.demand_delay_s
    arrays = {name: np.array(value) for name, value in values.items()}
    combinations = {one.name: float(one.of(arrays)) for one in structure.combinations if one.is_defined_by(arrays)}
    return values | combinations


def _value(plan: "Plan", role: "Role") -> float | None:
    name = plan.ship.structure.named_as(role)
    return None if name is None else plan.ship.by_name.get(name)
