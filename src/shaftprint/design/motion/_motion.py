"""What shaft and engine do when the set point moves: speed, torques, and their noise, at one working point.

Upstream of the gauge ``M_b - M_s = tau_up s n``: brake torque follows from the speed and the shaft torque that a
structure gives, whatever lies in its loop. The control unit limits what the governor asks for, ``v X + g n``, before
the delay and lag of the engine have made it smoother. All are deviations over their values at the working point.
"""

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.catalogue._roles import ShipRole
from shaftprint.catalogue._thesis import structure as structure_of
from shaftprint.errors import DesignError
from shaftprint.identify.prediction._noise_levels import NoiseLevels
from shaftprint.models._role import Role
from shaftprint.models._structure import Structure

SIGNALS = ("set point", "rate", "speed", "brake torque", "torque demand", "shaft torque")
"""What limits are stated of, in the order of ``motion``; the rate is the set point's, over the working point [1/s], and
the shaft torque that at the gauge."""

_SPEED, _TORQUE = "n", "M_s"
_GOVERNOR = structure_of("GOVERNOR")


def expect_motion(structure: Structure) -> None:
    """Check that a structure shows what limits are stated of.

    Raises DesignError if it has several inputs, or not both speed and shaft torque as outputs.
    """
    if len(structure.inputs) != 1 or not {_SPEED, _TORQUE} <= set(structure.outputs):
        raise DesignError(
            f"structure {structure.name}: expected {_SPEED} and {_TORQUE} from one input, found "
            f"{', '.join(structure.outputs)} from {', '.join(structure.inputs)}; a plan needs the closed loop, such as "
            "GAUGE-CLOSED."
        )


def motion(structure: Structure, table: FloatArray, omega_rad_s: FloatArray) -> ComplexArray:
    """Return the responses of ``SIGNALS`` to the set point, shape (rows, signals, lines).

    Sensors are ideal as long as the structure's own parameters of them are held at zero, as they are by default.

    ``structure``: the structure as it is normalised at the working point of the leg. ``table``: parameter values, shape
    (rows, parameters). ``omega_rad_s``: angular frequencies of the lines [rad/s], shape (lines,).
    """
    s = np.asarray(1j * omega_rad_s, dtype=np.complex128)
    outputs = [output for output, _ in structure.channels]
    response = structure.response(table, s)
    speed, shaft_torque = response[:, outputs.index(_SPEED)], response[:, outputs.index(_TORQUE)]
    one = np.ones_like(speed)
    brake_torque = shaft_torque + _upstream_time_s(structure, table) * s * speed
    demand = brake_torque
    if structure.named_as(ShipRole.PROPORTIONAL_GAIN) is not None:
        of_set_point, of_speed = _demand(structure, table, s)
        demand = of_set_point + of_speed * speed
    return np.stack([one, s * one, speed, brake_torque, demand, shaft_torque], axis=1)


def motion_noise(structure: Structure, values: FloatArray, noise: NoiseLevels) -> FloatArray:
    """Return the covariance of the noise of ``SIGNALS``, which a limit has to leave room for, shape (signals, signals).

    The integral of the stated densities of speed and shaft torque over their frequencies, by the trapezoidal rule; the
    set point has none, and the governor asks for torque because of that of the speed.
    """
    hertz = noise.frequency_hz
    s = np.asarray(2j * np.pi * hertz, dtype=np.complex128)
    density = noise.of_outputs(_SPEED, _TORQUE).density
    rows = np.zeros((hertz.size, len(SIGNALS), 2), dtype=np.complex128)
    rows[:, 2, 0] = 1.0
    rows[:, 3, 0] = _upstream_time_s(structure, values[None, :])[0] * s
    rows[:, 3, 1] = 1.0
    rows[:, 4] = rows[:, 3]
    if structure.named_as(ShipRole.PROPORTIONAL_GAIN) is not None:
        rows[:, 4] = 0.0
        rows[:, 4, 0] = _demand(structure, values[None, :], s)[1][0]
    rows[:, 5, 1] = 1.0
    spread = rows @ density @ rows.conj().swapaxes(1, 2)
    return np.asarray(np.trapezoid(spread.real, hertz, axis=0))


def _upstream_time_s(structure: Structure, table: FloatArray) -> FloatArray:
    """Return the inertia time upstream of the gauge [s], shape (rows, 1); zero for structures that know none."""
    return _values_of(structure, ShipRole.INERTIA_UPSTREAM, table, otherwise=0.0)


def _demand(structure: Structure, table: FloatArray, s: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
    """Return the torque that the governor asks for, from the set point and from the speed, each (rows, lines).

    The governor of the catalogue with the parameters of the same roles; what is not logged has no latency.
    """
    columns = [
        _values_of(structure, p.role, table, otherwise=p.value)
        if p.role is not None and p.role != ShipRole.RACK_LATENCY
        else np.full((table.shape[0], 1), p.value)
        for p in _GOVERNOR.parameters
    ]
    rack = _GOVERNOR.response(np.concatenate(columns, axis=1), s)
    slope = _values_of(structure, ShipRole.ENGINE_RACK_SLOPE, table, otherwise=1.0)
    with_speed = _values_of(structure, ShipRole.ENGINE_SPEED_SLOPE, table, otherwise=0.0)
    return slope * rack[:, 0], slope * rack[:, 1] + with_speed


def _values_of(structure: Structure, role: Role, table: FloatArray, *, otherwise: float) -> FloatArray:
    """Return the parameter of a role as the blocks take it, shape (rows, 1); a number where there is none."""
    name = structure.named_as(role)
    values = np.full((table.shape[0], 1), otherwise)
    return values if name is None else values * 0.0 + structure.columns(table)[name]
