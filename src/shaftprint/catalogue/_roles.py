"""Roles of the parameters of a ship's line: what each stands for stands here, once."""

from collections.abc import Mapping
from typing import Final

from shaftprint.models import Basis, PhysicalForm, Role


def _inertia(name: str, symbol: str, meaning: str, *basis: Basis) -> Role:
    """Return the role of an inertia time, ``2 pi I n_s0 / M_s0`` (thesis eq. 2.23)."""
    form = PhysicalForm(
        name=symbol, unit="kg m2", meaning=f"{meaning}, at the propeller shaft", scale=lambda point: point.inertia_kg_m2
    )
    return Role(name=name, unit="s", basis=frozenset(basis), over_torque=True, physical=form)


def _gain(term: str, unit: str, physical_unit: str, change: str) -> Role:
    """Return the role of a governor gain, ``v K M_s0 / n_e0`` on the shaft torque."""
    form = PhysicalForm(
        name=f"governor {term} action",
        unit=physical_unit,
        meaning=f"{change}, at the propeller shaft, for one rpm of engine-speed error",
        scale=lambda point: point.torque_nm_per_rpm,
    )
    basis: frozenset[Basis] = frozenset(("governor",))
    return Role(name=f"{term} gain", unit=unit, basis=basis, over_torque=True, rack_power=-1, physical=form)


def _line(name: str, unit: str, *basis: Basis) -> Role:
    return Role(name=name, unit=unit, basis=frozenset(basis))


def _sensor(name: str, unit: str, *basis: Basis) -> Role:
    return Role(name=name, unit=unit, basis=frozenset(basis), of_sensor=True)


class ShipRole:
    """Roles of the parameters of a ship's line, to be given as ``Parameter(..., role=ShipRole.INERTIA_DOWNSTREAM)``."""

    INERTIA_DOWNSTREAM: Final = _inertia(
        "inertia downstream", "I_dn", "inertia downstream of the torque gauge", "inertia"
    )
    INERTIA_UPSTREAM: Final = _inertia("inertia upstream", "I_up", "inertia upstream of the torque gauge", "torque")
    INERTIA: Final = _inertia("inertia", "I", "inertia that the thesis' shaft loop implies", "inertia")
    PROPORTIONAL_GAIN: Final = _gain("proportional", "-", "N m/rpm", "change of torque")
    INTEGRAL_GAIN: Final = _gain("integral", "1/s", "N m/(rpm s)", "rate of change of torque")
    DERIVATIVE_GAIN: Final = Role(name="derivative gain", unit="s", over_torque=True, rack_power=-1)
    ENGINE_SPEED_SLOPE: Final = Role(
        name="engine slope with speed", unit="-", basis=frozenset(("governor",)), over_torque=True
    )
    ENGINE_RACK_SLOPE: Final = Role(name="engine slope with rack", unit="-", rack_power=1)
    LOAD_SLOPE: Final = Role(name="load slope", unit="-", basis=frozenset(("load",)), loaded=True)
    INFLOW_SLOPE: Final = Role(name="inflow slope", unit="-", loaded=True)
    LOOP_DELAY: Final = _line("loop delay", "s", "delay", "governor")
    SET_POINT_LATENCY: Final = _line("set-point latency", "s", "delay", "governor")
    TOTAL_DELAY: Final = _line("total delay", "s", "delay")
    ACTUATOR_FREQUENCY: Final = _line("actuator frequency", "rad/s", "governor")
    ACTUATOR_DAMPING: Final = _line("actuator damping", "-", "governor")
    LOOP_GAIN: Final = _line("loop gain", "", "governor")
    SET_POINT_SCALE: Final = _sensor("set-point scale", "-", "set point")
    SET_POINT_OFFSET: Final = _sensor("set-point offset", "-", "set point")
    TORQUE_LATENCY: Final = _sensor("torque latency", "s", "latency")
    RACK_LATENCY: Final = _sensor("rack latency", "s")
    PICK_UP_AVERAGE: Final = _sensor("pick-up average", "s", "speed")
    PICK_UP_HOLD: Final = _sensor("pick-up hold", "s", "speed")
    PICK_UP_DELAY: Final = _sensor("pick-up delay", "s", "speed")
    TORQUE: Final = _line("torque", "", "torque")
    SPEED: Final = _line("speed", "", "speed")


ROLES: Mapping[str, Role] = {role.name: role for role in vars(ShipRole).values() if isinstance(role, Role)}
"""The roles of ``ShipRole`` by name, as files name them."""
