"""What line and engine do when the set point moves: speed, brake torque, and their noise, at one working point.

Upstream of the gauge ``M_b - M_s = tau_up s n``: brake torque follows from the speed and the shaft torque that a
structure gives, whatever lies in its loop. All are deviations over their values at the working point.
"""

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.catalogue import ShipRole
from shaftprint.errors import DesignError
from shaftprint.identify import NoiseLevels
from shaftprint.models import Structure

SIGNALS = ("set point", "rate", "speed", "brake torque")
"""What limits are stated of, in the order of ``motion``; the rate is the set point's, over the working point [1/s]."""

_SPEED, _TORQUE = "n", "M_s"


def expect_motion(structure: Structure) -> None:
    """Check that a structure shows what limits are stated of.

    Raises
    ------
    DesignError
        If it has several inputs, or not both speed and shaft torque as outputs.
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

    Parameters
    ----------
    structure
        The structure as it is normalised at the working point of the leg.
    table
        Parameter values, shape (rows, parameters).
    omega_rad_s
        Angular frequencies of the lines [rad/s], shape (lines,).
    """
    s = 1j * omega_rad_s
    outputs = [output for output, _ in structure.channels]
    response = structure.response(table, s)
    speed, shaft_torque = response[:, outputs.index(_SPEED)], response[:, outputs.index(_TORQUE)]
    one = np.ones_like(speed)
    brake_torque = shaft_torque + _upstream_time_s(structure, table) * s * speed
    return np.stack([one, s * one, speed, brake_torque], axis=1)


def motion_noise(structure: Structure, values: FloatArray, noise: NoiseLevels) -> FloatArray:
    """Return the covariance of the noise of ``SIGNALS``, which a limit has to leave room for, shape (signals, signals).

    The integral of the stated densities of speed and shaft torque over their frequencies, by the trapezoidal rule; the
    set point has none.
    """
    hertz = noise.frequency_hz
    density = noise.of_outputs(_SPEED, _TORQUE).density
    upstream = float(_upstream_time_s(structure, values[None, :])[0, 0])
    rows = np.zeros((hertz.size, len(SIGNALS), 2), dtype=np.complex128)
    rows[:, 2, 0] = 1.0
    rows[:, 3, 0] = upstream * 2j * np.pi * hertz
    rows[:, 3, 1] = 1.0
    spread = rows @ density @ rows.conj().swapaxes(1, 2)
    return np.asarray(np.trapezoid(spread.real, hertz, axis=0))


def _upstream_time_s(structure: Structure, table: FloatArray) -> FloatArray:
    """Return the inertia time upstream of the gauge [s], shape (rows, 1); zero for structures that know none."""
    name = structure.named_as(ShipRole.INERTIA_UPSTREAM)
    return np.zeros((table.shape[0], 1)) if name is None else np.asarray(structure.columns(table)[name])
