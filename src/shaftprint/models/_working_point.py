"""The same line at another working point."""

from shaftprint.errors import StructureError
from shaftprint.models._structure import Structure


def at_working_point(
    structure: Structure,
    *,
    speed_share: float,
    torque_share: float | None = None,
    shown_share: float | None = None,
    rack_share: float | None = None,
) -> Structure:
    """Return a structure as it is normalised at another working point; its parameters keep their values at the first.

    A parameter whose role is ``over_torque`` is a physical value times the speed over the torque, so it goes with
    ``speed_share / torque_share`` (thesis eqs 2.14-2.25); delays and lags stay. What a parameter lacks to the ``law``
    of its role goes with one over the torque that is shown: a gauge whose zero is ``z`` shows ``M = Q n^2 + z``, and
    the slope ``n / M dM/dn`` is ``2 (1 - z / M)``. What is ``over_speed`` acts with the speed that is added.

    Parameters
    ----------
    speed_share
        Speed of the other working point over that of the first.
    torque_share
        The same of the torque; the square of the speed's in bollard pull, where it is not given.
    shown_share
        The same of the mean torque that is shown, in which a swinging speed has no part of a zero; ``torque_share``
        where it is not given.
    rack_share
        The same of the fuel rack, where it is logged: gains are then over the rack, and the slope of the engine is
        that of the torque over it. Not given, both go as if the rack were the torque.

    Raises
    ------
    StructureError
        If a share is not positive.
    """
    torque = speed_share**2 if torque_share is None else torque_share
    shown = torque if shown_share is None else shown_share
    rack = torque if rack_share is None else rack_share
    if not (speed_share > 0.0 and torque > 0.0 and shown > 0.0 and rack > 0.0):
        raise StructureError(
            f"structure {structure.name} at another working point: expected positive shares of speed, torque and rack, "
            f"found {speed_share:g}, {torque:g} and {rack:g}."
        )
    factors = {
        name: (speed_share / torque if role.over_torque else 1.0) * (rack / torque) ** role.rack_power
        for name, role in structure.roles.items()
        if role.over_torque or (role.rack_power and rack_share is not None)
    }
    factors |= {name: speed_share - 1.0 for name, role in structure.roles.items() if role.over_speed}
    laws = {name: role.law for name, role in structure.roles.items() if role.law is not None}
    moved = structure.scaled(**factors, **dict.fromkeys(laws, 1.0 / shown))
    return moved.offset(**{name: law * (1.0 - 1.0 / shown) for name, law in laws.items()})
