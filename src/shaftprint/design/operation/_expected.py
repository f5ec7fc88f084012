"""What a campaign will ask of ship and engine, as far as the ship is known."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.campaign._setpoint import setpoint
from shaftprint.catalogue._limited import limited
from shaftprint.catalogue._pitch import pitched_with_rack
from shaftprint.catalogue._roles import ShipRole
from shaftprint.catalogue._sailing import sailing_with_rack
from shaftprint.design.operation._operation import Operation
from shaftprint.errors import DesignError
from shaftprint.models._structure import Structure
from shaftprint.signals._moved_beside import MovedBeside, moved_beside
from shaftprint.simulation._simulate import simulate

if TYPE_CHECKING:
    from shaftprint.campaign._campaign import Campaign
    from shaftprint.vessel._vessel import Vessel

# Fine enough for lines of 10 Hz: their peaks are met within half a per cent, and so is a derivative.
_RATE_HZ = 200.0
# A line whose speed goes further than so many times that of the working point from it does not run any more.
_FARTHEST = 1.0
_PITCH = "theta_set"
_ROLES = {ShipRole.INERTIA_UPSTREAM: 0.0, ShipRole.ENGINE_RACK_SLOPE: 1.0, ShipRole.ENGINE_SPEED_SLOPE: 0.0}


def expected_operation(
    campaign: "Campaign", vessel: "Vessel", values: Mapping[str, float], *, slope_rpm_per_v: float
) -> Operation:
    """Return what a campaign makes a line do: the closed loop with the quadratic propeller, without noise or limits.

    Upstream of the gauge ``M_b - M_s = tau_up dn/dt``. Underway it is the linear loop of the ship that sails free,
    FREE-CLOSED; a controllable pitch that is moved adds what GAUGE-PITCH says of it. Without the limits it shows how
    far beyond them the engine would have to go; what happens there is another question (``simulate``).

    Parameters
    ----------
    campaign
        What is asked of the ship.
    vessel
        Working point; the campaign's offset asks for its speed, or for ``offset_rpm`` where the campaign states that.
    values
        Assumed values by name, normalised at that working point, of the closed loop of the ship; the structure's own
        where not given.
    slope_rpm_per_v
        Change of the engine speed for one volt [rpm/V], negative where a lower voltage asks for more speed.

    Raises
    ------
    DesignError
        If the line stops or runs away with these values: its loop is unstable, or it is asked for too much.
    """
    is_motor = vessel.motor is not None
    line = sailing_with_rack() if vessel.is_underway and not is_motor else limited(with_rack=True, by_motor=is_motor)
    vector = _vector(line, values)
    point = vessel.working_point
    time_s = np.arange(round(campaign.duration_s * _RATE_HZ) + 1) / _RATE_HZ
    offset_rpm = point.engine_speed_rpm if campaign.offset_rpm is None else campaign.offset_rpm
    set_point_rpm = offset_rpm + slope_rpm_per_v * (setpoint(campaign, time_s) - campaign.offset_v)
    with np.errstate(over="ignore", invalid="ignore"):
        trace = simulate(line, vector, time_s, {"n_set": set_point_rpm / point.engine_speed_rpm - 1.0})
    asked = _pitch_asked(campaign, vessel, time_s, set_point_rpm)
    outputs = _with_pitch(trace.outputs, values, time_s, asked)
    if not np.all(np.abs(outputs["n"]) < _FARTHEST):
        raise DesignError(
            f"campaign {campaign.name}: expected speeds between 0 and {1.0 + _FARTHEST:g} times the working point, "
            f"found others with a set point of {set_point_rpm.min():.0f} to {set_point_rpm.max():.0f} rpm: the loop is "
            f"unstable with the assumed values, or {slope_rpm_per_v:g} rpm for one volt are not those of this lever; "
            "give other values, or the lever's with --rpm-per-volt or slope_rpm_per_v in the campaign file."
        )
    brake, demand = _torques(line, vector, outputs, time_s)
    brake_nm = point.driving_torque_nm / vessel.gearbox.shaft_over_brake
    return Operation(
        campaign=campaign,
        time_s=time_s,
        set_point_rpm=set_point_rpm,
        speed_rpm=point.engine_speed_rpm * (1.0 + outputs["n"]),
        brake_torque_nm=brake_nm * (1.0 + brake),
        torque_demand_nm=brake_nm * (1.0 + demand),
        shaft_torque_nm=point.driving_torque_nm * (1.0 + outputs["M_s"]),
    )


def _vector(line: Structure, values: Mapping[str, float]) -> FloatArray:
    return line.vector({name: value for name, value in values.items() if name in line.names})


def inputs_left_out(campaign: "Campaign", vessel: "Vessel") -> tuple[str, ...]:
    """Return the inputs that a campaign moves and ``expected_operation`` does not, by the names of their sensors."""
    return tuple(one.input for one in moved_beside(vessel, campaign) if not _is_known(one, vessel))


def _is_known(moved: MovedBeside, vessel: "Vessel") -> bool:
    """Return whether there is a structure of what an input does to engine and gauge: a pitch at the quay."""
    return moved.symbol == _PITCH and not vessel.is_underway and vessel.motor is None


def _pitch_asked(
    campaign: "Campaign", vessel: "Vessel", time_s: FloatArray, set_point_rpm: FloatArray
) -> FloatArray | None:
    """Return the change of pitch over the pitch that is asked for; None where nothing moves the pitch."""
    combinator = vessel.combinator
    if combinator is not None:
        asked: FloatArray = combinator.combined_ratio(set_point_rpm) / vessel.propeller.pitch_ratio - 1.0
        return asked
    moved = next((one for one in moved_beside(vessel, campaign) if _is_known(one, vessel)), None)
    if moved is None:
        return None
    return moved.share_per_v * (setpoint(campaign, time_s, input=moved.input) - campaign.middle_v(moved.input))


def _with_pitch(
    outputs: Mapping[str, FloatArray],
    values: Mapping[str, float],
    time_s: FloatArray,
    asked: FloatArray | None,
) -> Mapping[str, FloatArray]:
    """Return outputs with what the motion of a controllable pitch adds to them."""
    if asked is None:
        return outputs
    line = pitched_with_rack()
    late = line.named_as(ShipRole.BLADE_LATENESS)
    # an estimate of some milliseconds either way: no line moves before it is asked
    causal = {name: max(value, 0.0) if name == late else value for name, value in values.items()}
    trace = simulate(line, _vector(line, causal), time_s, {_PITCH: asked})
    return {name: alone + trace.outputs[name] for name, alone in outputs.items()}


def _torques(
    line: Structure, values: FloatArray, outputs: Mapping[str, FloatArray], time_s: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return brake torque and that which the governor asks for, ``v X + g n``, over the working point's."""
    named = dict(zip(line.names, values.tolist(), strict=True))
    # a motor gives what is asked for, whatever the speed
    inertia_s, with_rack, with_speed = (
        otherwise if (name := line.named_as(role)) is None else named[name] for role, otherwise in _ROLES.items()
    )
    speed = outputs["n"]
    brake = outputs["M_s"] + inertia_s * np.gradient(speed, time_s)
    return brake, with_rack * outputs["X"] + with_speed * speed
