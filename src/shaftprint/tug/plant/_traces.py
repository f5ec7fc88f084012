"""What the kernel of the propulsion line is given beside its constants, what it carries on, and what it fills."""

from typing import NamedTuple

from shaftprint.arrays import BoolArray, FloatArray, IntArray


class Carried(NamedTuple):
    """What the kernel carries from chunk to chunk."""

    state: FloatArray
    """Shaft speed, integrator, rack, rack rate, slipstream, angle and speed of the ship, shape (7,)."""
    history: FloatArray
    """Ring of the racks given at the nodes; its size is a power of two."""
    counter: IntArray
    """Nodes passed, shape (1,)."""
    boost: FloatArray
    """Boost as the share of the full-load torque to which it belongs in steady running, shape (1,)."""


class DelayTaps(NamedTuple):
    """Where the delayed rack is found at the start, middle and end of a step."""

    first: IntArray
    """First of four nodes, relative to the node of the step, shape (3,)."""
    weights: FloatArray
    """Interpolation weights, shape (3, 4)."""
    steps: float
    """The delay at the working point, in steps."""


class Traces(NamedTuple):
    """Values at the START of each step, all of shape (steps,), filled by the kernel."""

    shaft_speed_rev_s: FloatArray
    shaft_angle_rev: FloatArray
    shaft_torque_nm: FloatArray
    brake_torque_nm: FloatArray
    rack_given: FloatArray
    limited: BoolArray
    ship_speed_m_s: FloatArray
    engine_speed_rev_s: FloatArray
    engine_angle_rev: FloatArray
