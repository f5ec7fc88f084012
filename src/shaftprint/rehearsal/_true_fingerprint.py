"""The truth of a simulated recording under the names of a fingerprint, to be printed beside the estimates."""

import math
from collections.abc import Mapping

import numpy as np

from shaftprint.catalogue._roles import ShipRole
from shaftprint.models._margins import margins
from shaftprint.models._parameter import Parameter
from shaftprint.models._structure import Structure
from shaftprint.signals._signals import Signals, StripAngles
from shaftprint.tug._truth import StripTruth, Truth
from shaftprint.units import rpm_from_rev_s

DEGREES_PER_REVOLUTION = 360.0
_PHYSICAL = {
    "I_dn": "inertia_downstream_kg_m2",
    "I_up": "inertia_upstream_kg_m2",
    "k": "coupling_stiffness_nm_rad",
    "d": "coupling_damping_nm_s_rad",
}


def fingerprint_truth(truth: Truth, structure: Structure, signals: Signals) -> dict[str, float]:
    """Return what is true by the names of parameters, combinations, physical values, margins and calibration.

    ``truth``: what was put into the recording. ``structure``: the structure that was identified. ``signals``: their
    working point is the one at which the estimates are normalised. What hangs on a free parameter that the truth does
    not have is left out, as are strips of a pick-up that it does not name.
    """
    known = _parameters(truth, structure, signals)
    # sensors are as the vessel file says; of what else was fitted the default is no truth: nan passes through
    unknown = {p.name: math.nan for p in structure.parameters if p.name not in known and _is_of_ship(p)}
    values = structure.vector(known | unknown)
    named = dict(zip(structure.names, values.tolist(), strict=True))
    arrays = {name: np.asarray(value) for name, value in named.items()}
    combinations = {combination.name: float(combination.of(arrays)) for combination in structure.combinations}
    physical = {name: truth.physical[told] for name, told in _PHYSICAL.items() if told in truth.physical}
    found = named | combinations | physical | _calibration(truth, signals)
    if not unknown:
        linear = margins(structure, values)
        found |= {
            "gain margin": linear.gain_margin,
            "phase margin": float(np.degrees(linear.phase_margin_rad)),
            "delay margin": linear.delay_margin_s,
        }
    return {name: value for name, value in found.items() if not math.isnan(value)}


def _is_of_ship(parameter: Parameter) -> bool:
    return not (parameter.held or (parameter.role and parameter.role.of_sensor))


def _parameters(truth: Truth, structure: Structure, signals: Signals) -> dict[str, float]:
    """Return the true parameters, normalised at the working point that was measured.

    The load of the propeller drifts, so the line was tested at a torque that is up to a per cent off the nominal one.
    The scale of the set point is its true slope over the one that the signals have. The latency of the simulated
    torque telemetry is exactly that of the vessel file: no error is left.
    """
    point, line = signals.working_point, signals.calibration
    moved = rpm_from_rev_s(point.engine_speed_rev_s) / truth.engine_speed_rpm
    moved *= truth.shaft_torque_nm / point.shaft_torque_nm
    slope = rpm_from_rev_s(line.slope_rev_s_per_v) * signals.dc_scale
    of_sensors = {
        ShipRole.SET_POINT_SCALE: truth.set_point_slope_rpm_per_v / slope,
        ShipRole.TORQUE_LATENCY: 0.0,
    }
    values = {}
    for parameter in structure.parameters:
        if parameter.role in of_sensors:
            values[parameter.name] = of_sensors[parameter.role]
        elif parameter.name in truth.normalised:
            scale = moved if parameter.role and parameter.role.over_torque else 1.0
            values[parameter.name] = truth.normalised[parameter.name] * scale
    return values | _beside_machine(structure, values, truth.shaft_torque_nm / point.shaft_torque_nm)


def _beside_machine(structure: Structure, values: Mapping[str, float], torque_share: float) -> dict[str, float]:
    """Return what changes where an electric machine keeps its torque while that of the propeller drifts.

    The engine gives the rest, over which its own numbers are.
    """
    share = next((p.name for p in structure.parameters if p.role == ShipRole.MACHINE_SHARE), None)
    if share is None or share not in values:
        return {}
    given = torque_share * values[share]
    own = (1.0 - values[share]) / (1.0 - given)
    of_engine = (ShipRole.OWN_PROPORTIONAL_GAIN, ShipRole.OWN_INTEGRAL_GAIN, ShipRole.ENGINE_SPEED_SLOPE)
    names = [p.name for p in structure.parameters if p.role in of_engine]
    scale = next(values[p.name] for p in structure.parameters if p.role == ShipRole.MACHINE_SCALE)
    return {share: given / scale} | {name: own * values[name] for name in names}


def _calibration(truth: Truth, signals: Signals) -> dict[str, float]:
    true_values = {
        "set-point slope": truth.set_point_slope_rpm_per_v,
        "set-point intercept": truth.set_point_intercept_rpm,
    }
    for strips in signals.strips:
        true = _same_pick_up(truth, strips)
        for number, angle in enumerate([] if true is None else _turned(true, strips), start=1):
            true_values[f"{strips.channel} strip {number}"] = angle
    return true_values


def strips_without_truth(truth: Truth, signals: Signals) -> list[str]:
    """Return a sentence for each pick-up whose strips the truth does not have, by its channel and their number."""
    told = ", ".join(f"{len(strips.angle_deg)} of {strips.channel}" for strips in truth.strips) or "none"
    return [
        f"expected {strips.angle_rev.size} strips of {strips.channel}, found {told}; their angles stand without true "
        "ones. Take the truth file that was written beside this recording, and the names of its channels."
        for strips in signals.strips
        if _same_pick_up(truth, strips) is None
    ]


def _same_pick_up(truth: Truth, strips: StripAngles) -> StripTruth | None:
    """Return the true strips of a pick-up; None where the truth names none such or another number of them."""
    named = (true for true in truth.strips if true.channel == strips.channel)
    return next((true for true in named if len(true.angle_deg) == strips.angle_rev.size), None)


def _turned(true: StripTruth, strips: StripAngles) -> list[float]:
    """Return the true angles from the strip on that was counted first, which no recording shows."""
    identified_deg = DEGREES_PER_REVOLUTION * strips.angle_rev
    turns = [np.roll(true.angle_deg, shift) for shift in range(identified_deg.size)]
    closest: list[float] = min(turns, key=lambda angles: float(np.abs(angles - identified_deg).max())).tolist()
    return closest
