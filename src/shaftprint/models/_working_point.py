"""One line at several working points: what its parameters are at another one."""

from shaftprint.models._structure import Structure
from shaftprint.normalisation import inertia_time_s


def at_working_point(structure: Structure, *, speed_ratio: float, torque_ratio: float) -> Structure:
    """Return a structure at another working point, with its parameters still those of the first.

    What is a physical value over the torque and times the speed, as an inertia time is, goes with ``n_0 / M_0`` (thesis
    eqs 2.14-2.25). For a line whose governor and engine are the same there, and whose torque follows a power of the
    speed.

    Parameters
    ----------
    structure
        A structure whose parameters have roles.
    speed_ratio, torque_ratio
        Speed and shaft torque of the other working point over those of the first.
    """
    factor = inertia_time_s(1.0, shaft_speed_rev_s=speed_ratio, shaft_torque_nm=torque_ratio) / inertia_time_s(
        1.0, shaft_speed_rev_s=1.0, shaft_torque_nm=1.0
    )
    moved = [name for name, role in structure.roles.items() if role.over_torque]
    return structure.scaled(**dict.fromkeys(moved, factor)) if moved else structure
