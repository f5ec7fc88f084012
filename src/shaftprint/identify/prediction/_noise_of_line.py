"""The noise of one line as another line would show it: what disturbs the torques goes through that line's own loop."""

from collections.abc import Mapping

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.catalogue._roles import ShipRole
from shaftprint.identify.prediction._noise_levels import NoiseLevels
from shaftprint.models._role import Role
from shaftprint.models._structure import Structure

_SPEED, _TORQUE = "n", "M_s"
_NEEDED = (ShipRole.INERTIA_UPSTREAM, ShipRole.SET_POINT_LATENCY)


def noise_of_line(
    levels: NoiseLevels,
    structure: Structure,
    *,
    measured_at: Mapping[str, float],
    values: Mapping[str, float],
) -> NoiseLevels:
    """Return the noise that another line has when the same disturbs its torques.

    On either side of the gauge ``M_s = Z n + d``: downstream ``Z`` is what the load takes, upstream what governor,
    engine and inertia give. What disturbs both, ``d``, follows from the noise of one line and makes that of the other.
    Noise of the gauge alone disturbs both sides alike and stays as it is.

    ``levels``: noise of speed and torque about the structure's working point. ``structure``: the closed loop, as it is
    normalised there. ``measured_at``, ``values``: parameters of the line whose noise it is, and of the other, by name;
    the structure's own where not given. Returns the noise of the other line; the same where the structure is no closed
    loop of speed and torque.
    """
    known = all(structure.named_as(role) is not None for role in _NEEDED)
    if not known or set(levels.outputs) != {_SPEED, _TORQUE} or len(structure.inputs) != 1:
        return levels
    shown = levels.of_outputs(_SPEED, _TORQUE)
    s = np.asarray(2j * np.pi * shown.frequency_hz, dtype=np.complex128)
    ends = [_sides(structure, structure.vector(one), s) for one in (measured_at, values)]
    change = np.asarray(np.linalg.solve(ends[1], ends[0]), dtype=np.complex128)
    density = change @ shown.density @ change.conj().swapaxes(1, 2)
    # rounding leaves an imaginary part on the diagonal
    density = np.asarray(0.5 * (density + density.conj().swapaxes(1, 2)), dtype=np.complex128)
    return NoiseLevels(
        frequency_hz=shown.frequency_hz,
        density=density,
        outputs=shown.outputs,
        set_point_per_v=shown.set_point_per_v,
        orders_hz=shown.orders_hz,
    ).of_outputs(*levels.outputs)


def _sides(structure: Structure, vector: FloatArray, s: ComplexArray) -> ComplexArray:
    """Return what disturbs the downstream and the upstream torque, of speed and shaft torque, shape (lines, 2, 2)."""
    table = vector[None, :]
    outputs = [output for output, _ in structure.channels]
    response = structure.response(table, s)[0]
    speed, torque = response[outputs.index(_SPEED)], response[outputs.index(_TORQUE)]
    upstream_s, late_s, slope = (
        _value(structure, table, role)
        for role in (ShipRole.INERTIA_UPSTREAM, ShipRole.SET_POINT_LATENCY, ShipRole.ENGINE_SPEED_SLOPE)
    )
    late = np.exp(-s * late_s)
    # M_s = G (late r - n) + g n - tau_up s n gives what governor and engine make of an error of the speed
    of_error = (torque + (upstream_s * s - slope) * speed) / (late - speed)
    rows = np.ones((s.size, 2, 2), dtype=np.complex128)
    rows[:, 0, 0] = -torque / speed
    rows[:, 1, 0] = of_error - slope + upstream_s * s
    return rows


def _value(structure: Structure, table: FloatArray, role: Role) -> float:
    """Return the parameter of a role as the blocks take it; zero where there is none."""
    name = structure.named_as(role)
    return 0.0 if name is None else float(structure.columns(table)[name][0, 0])
