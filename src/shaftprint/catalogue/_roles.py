"""Roles of the parameters of a ship's line: what each stands for stands here, once."""

from collections.abc import Mapping
from typing import Final

from shaftprint.models import Basis, PhysicalForm, Role


def _inertia(name: str, symbol: str, meaning: str, *basis: Basis) -> Role:
    """Return the role of an inertia time, ``2 pi I n_s0 / M_s0`` (thesis eq. 2.23)."""
    form = PhysicalForm(
        name=symbol, unit="kg m2", meaning=f"{meaning}, at the propeller shaft", scale=lambda point: point.inertia_kg_m2
    )
    return Role(name=name, basis=frozenset(basis), over_torque=True, physical=form)


def _gain(term: str, unit: str, change: str) -> Role:
    """Return the role of a governor gain, ``v K M_s0 / n_e0`` on the shaft torque."""
    form = PhysicalForm(
        name=f"governor {term} action",
        unit=unit,
        meaning=f"{change}, at the propeller shaft, for one rpm of engine-speed error",
        scale=lambda point: point.torque_nm_per_rpm,
    )
    basis: frozenset[Basis] = frozenset(("governor",))
    return Role(name=f"{term} gain", basis=basis, over_torque=True, rack_power=-1, physical=form)


def _line(name: str, *basis: Basis) -> Role:
    return Role(name=name, basis=frozenset(basis))


def _sensor(name: str, *basis: Basis) -> Role:
    return Role(name=name, basis=frozenset(basis), of_sensor=True)


class ShipRole:
    """Roles of the parameters of a ship's line, to be given as ``Parameter(..., role=ShipRole.INERTIA_DOWNSTREAM)``."""

    INERTIA: Final = _inertia("inertia", "I", "inertia that the thesis' shaft loop implies", "inertia")
    INERTIA_UPSTREAM: Final = _inertia("inertia upstream", "I_up", "inertia upstream of the torque gauge", "torque")
    INERTIA_DOWNSTREAM: Final = _inertia(
        "inertia downstream", "I_dn", "inertia downstream of the torque gauge", "inertia"
    )
    PROPORTIONAL_GAIN: Final = _gain("proportional", "N m/rpm", "change of torque")
    INTEGRAL_GAIN: Final = _gain("integral", "N m/(rpm s)", "rate of change of torque")
    DERIVATIVE_GAIN: Final = Role(name="derivative gain", over_torque=True, rack_power=-1)
    ENGINE_SPEED_SLOPE: Final = Role(name="engine slope with speed", basis=frozenset(("governor",)), over_torque=True)
    ENGINE_RACK_SLOPE: Final = Role(name="engine slope with rack", rack_power=1)
    LOAD_SLOPE: Final = Role(name="load slope", basis=frozenset(("load",)), loaded=True)
    INFLOW_SLOPE: Final = Role(name="inflow slope", loaded=True)
    LOOP_DELAY: Final = _line("loop delay", "delay", "governor")
    SET_POINT_LATENCY: Final = _line("set-point latency", "delay", "governor")
    TOTAL_DELAY: Final = _line("total delay", "delay")
    ACTUATOR: Final = Role(name="actuator", basis=frozenset(("governor",)), is_single=False)
    LOOP_GAIN: Final = _line("loop gain", "governor")
    SET_POINT_SCALE: Final = _sensor("set-point scale", "set point")
    TORQUE_LATENCY: Final = _sensor("torque latency", "latency")
    RACK_LATENCY: Final = _sensor("rack latency")
    PICK_UP_AVERAGE: Final = _sensor("pick-up average", "speed")
    PICK_UP_HOLD: Final = _sensor("pick-up hold", "speed")
    PICK_UP_DELAY: Final = _sensor("pick-up delay", "speed")
    TORQUE: Final = Role(name="torque", basis=frozenset(("torque",)), over_torque=True, is_single=False)
    SPEED: Final = Role(name="speed", basis=frozenset(("speed",)), over_torque=True, is_single=False)


ROLES: Mapping[str, Role] = {role.name: role for role in vars(ShipRole).values() if isinstance(role, Role)}
"""The roles of ``ShipRole`` by name, as files name them."""
