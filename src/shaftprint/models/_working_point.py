"""The same line at another working point."""

from shaftprint.errors import StructureError
from shaftprint.models._structure import Structure


def at_working_point(structure: Structure, *, speed_share: float, torque_share: float | None = None) -> Structure:
    """Return a structure as it is normalised at another working point; its parameters keep their values at the first.

    A parameter whose role is ``over_torque`` is a physical value times the speed over the torque, so it goes with
    ``speed_share / torque_share`` (thesis eqs 2.14-2.25); delays and lags stay.

    Parameters
    ----------
    speed_share
        Speed of the other working point over that of the first.
    torque_share
        The same of the torque; the square of the speed's in bollard pull, where it is not given.

    Raises
    ------
    StructureError
        If a share is not positive.
    """
    torque = speed_share**2 if torque_share is None else torque_share
    if not (speed_share > 0.0 and torque > 0.0):
        raise StructureError(
            f"structure {structure.name} at another working point: expected positive shares of speed and torque, "
            f"found {speed_share:g} and {torque:g}."
        )
    factor = speed_share / torque
    return structure.scaled(**{name: factor for name, role in structure.roles.items() if role.over_torque})
