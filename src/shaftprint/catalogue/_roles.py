"""Roles of the parameters of a ship's line: what each stands for stands here, once."""

from collections.abc import Mapping
from typing import Final

from shaftprint.models._role import Basis, PhysicalForm, Role


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
        meaning=f"{change}, at the propeller shaft, for one rpm of speed error ahead of the gearbox",
        scale=lambda point: point.torque_nm_per_rpm,
    )
    basis: frozenset[Basis] = frozenset(("governor",))
    return Role(name=f"{term} gain", unit=unit, basis=basis, over_torque=True, rack_power=-1, physical=form)


def _coupling(name: str, unit: str, symbol: str, physical_unit: str) -> Role:
    """Return the role of what a coupling answers a twist with, normalised as an inertia is: torque over speed."""
    form = PhysicalForm(
        name=symbol,
        unit=physical_unit,
        meaning=f"{name} of the coupling, at the propeller shaft",
        scale=lambda point: point.inertia_kg_m2,
    )
    basis: frozenset[Basis] = frozenset(("inertia",))
    return Role(name=f"coupling {name}", unit=unit, basis=basis, over_torque=True, physical=form)


def _line(name: str, unit: str, *basis: Basis) -> Role:
    return Role(name=name, unit=unit, basis=frozenset(basis))


def _sensor(name: str, unit: str, *basis: Basis) -> Role:
    return Role(name=name, unit=unit, basis=frozenset(basis), of_sensor=True)


class ShipRole:
    """Roles of the parameters of a ship's line, to be given as ``Parameter(..., role=ShipRole.INERTIA_DOWNSTREAM)``."""

    INERTIA_DOWNSTREAM: Final = _inertia(
        "inertia downstream", "I_dn", "inertia downstream of the torque gauge", "inertia"
    )
    """Inertia time downstream of the torque gauge."""
    INERTIA_UPSTREAM: Final = _inertia("inertia upstream", "I_up", "inertia upstream of the torque gauge", "torque")
    """Inertia time upstream of the torque gauge; the vessel file gives its prior."""
    INERTIA_DRIVEN: Final = Role(name="inertia driven", unit="s", basis=frozenset(("inertia",)), over_torque=True)
    """Part of the inertia time upstream of the gauge that lies behind an elastic coupling."""
    COUPLING_STIFFNESS: Final = _coupling("stiffness", "1/s", "k", "N m/rad")
    """Stiffness of an elastic coupling, ``2 pi k n_s0 / M_s0``."""
    COUPLING_DAMPING: Final = _coupling("damping", "-", "d", "N m s/rad")
    """Damping of an elastic coupling, ``2 pi d n_s0 / M_s0``."""
    INERTIA: Final = _inertia("inertia", "I", "inertia that the thesis' shaft loop implies", "inertia")
    """Inertia time of the thesis' one shaft."""
    PROPORTIONAL_GAIN: Final = _gain("proportional", "-", "N m/rpm", "change of torque")
    """Proportional gain of the governor."""
    INTEGRAL_GAIN: Final = _gain("integral", "1/s", "N m/(rpm s)", "rate of change of torque")
    """Integral gain of the governor."""
    OWN_PROPORTIONAL_GAIN: Final = Role(
        name="proportional gain of the engine's own torque",
        unit="-",
        basis=frozenset(("governor",)),
        over_torque=True,
        rack_power=-1,
    )
    """Proportional gain of the governor over what the engine alone gives, beside an electric machine."""
    OWN_INTEGRAL_GAIN: Final = Role(
        name="integral gain of the engine's own torque",
        unit="1/s",
        basis=frozenset(("governor",)),
        over_torque=True,
        rack_power=-1,
    )
    """Integral gain of the governor over what the engine alone gives, beside an electric machine."""
    DERIVATIVE_GAIN: Final = Role(name="derivative gain", unit="s", over_torque=True, rack_power=-1)
    """Derivative gain of the governor."""
    ENGINE_SPEED_SLOPE: Final = Role(
        name="engine slope with speed", unit="-", basis=frozenset(("governor",)), over_torque=True
    )
    """Slope of the engine torque with speed at constant rack."""
    ENGINE_RACK_SLOPE: Final = Role(name="engine slope with rack", unit="-", rack_power=1)
    """Slope of the engine torque with fuel rack."""
    LOAD_SLOPE: Final = Role(name="load slope", unit="-", basis=frozenset(("load",)), law=2.0, loaded=True)
    """Slope of the propeller torque with speed, which goes with its square; less where the gauge shows a zero."""
    INFLOW_SLOPE: Final = Role(name="inflow slope", unit="-", loaded=True)
    """Slope of the propeller torque with the speed of the slipstream."""
    LOOP_DELAY: Final = _line("loop delay", "s", "delay", "governor")
    """Delay inside the loop."""
    SET_POINT_LATENCY: Final = _line("set-point latency", "s", "delay", "clock", "governor")
    """Latency of the set point, outside the loop; below nothing where its channel is logged later than that."""
    TOTAL_DELAY: Final = _line("total delay", "s", "delay", "clock")
    """All delays from set point to torque, a combination."""
    ACTUATOR_FREQUENCY: Final = _line("actuator frequency", "rad/s", "governor")
    """Natural frequency of the actuator's lag."""
    ACTUATOR_DAMPING: Final = _line("actuator damping", "-", "governor")
    """Damping ratio of the actuator's lag."""
    TORQUE_TIME: Final = _line("torque time", "s", "governor")
    """Time constant of a motor's torque."""
    MACHINE_SHARE: Final = Role(name="machine share", unit="-")
    """Torque that an electric machine on the gearbox shows at the working point, over that of the shaft."""
    LOOP_GAIN: Final = _line("loop gain", "", "governor")
    """Gains over each other or over the line, a combination in which the working point cancels; a margin."""
    MACHINE_SCALE: Final = _sensor("machine scale", "-", "torque")
    """Torque of an electric machine over that which its converter shows, as the torque gauge shows torques."""
    SET_POINT_SCALE: Final = _sensor("set-point scale", "-", "set point")
    """Scale error of the measured set point."""
    SET_POINT_BEND: Final = Role(
        name="set-point bend", unit="-", basis=frozenset(("set point",)), of_sensor=True, over_speed=True
    )
    """Share by which the slope of the set point's line is larger at twice the speed of the working point."""
    SET_POINT_OFFSET: Final = _sensor("set-point offset", "-", "set point")
    """Offset of the measured set point."""
    TORQUE_LATENCY: Final = _sensor("torque latency", "s", "latency")
    """Error of the known latency of the torque gauge."""
    LOG_LATENCY: Final = _sensor("log latency", "s")
    """Error of the known latency of the speed log."""
    RACK_LATENCY: Final = _sensor("rack latency", "s")
    """Error of the known latency of the rack channel."""
    PICK_UP_AVERAGE: Final = _sensor("pick-up average", "s", "speed")
    """Window of a pick-up's mean."""
    PICK_UP_HOLD: Final = _sensor("pick-up hold", "s", "speed")
    """Time for which a pick-up's value is held."""
    PICK_UP_DELAY: Final = _sensor("pick-up delay", "s", "speed")
    """Delay of a pick-up's value."""
    PITCH_SLOPE: Final = Role(name="pitch slope", unit="-", basis=frozenset(("load",)))
    """Slope of the propeller torque with its pitch, ``d ln K_Q / d ln theta``."""
    PITCH_LAG: Final = _line("pitch lag", "s", "delay")
    """Time constant with which a controllable pitch follows its set point."""
    PITCH_DELAY: Final = _line("pitch delay", "s", "delay", "pitch clock")
    """Time after which it begins to follow."""
    PITCH_TOTAL: Final = _line("total pitch lag", "s", "delay", "pitch clock")
    """Both together, a combination."""
    BLADE_LATENESS: Final = _line("blade lateness", "s", "delay", "latency")
    """Time by which the blades of a controllable pitch follow what is shown of it."""
    PITCH_SCALE: Final = _line("pitch scale", "-", "load")
    """Change of pitch that is reached over that which is asked for."""
    COMBINATOR_SLOPE: Final = _line("combinator slope", "-", "load")
    """Change of pitch that is reached over the change of speed that a lever asks for together with it."""
    ASKED_PITCH_SLOPE: Final = _line("slope of the asked pitch", "-", "load")
    """Slope of the propeller torque with the pitch that is asked for, a combination."""
    PITCH_SENSOR_SCALE: Final = Role(name="pitch sensor scale", unit="-", basis=frozenset(("load",)), of_sensor=True)
    """Change of pitch that is shown over that which is reached."""
    TORQUE: Final = _line("torque", "", "torque")
    """Made of torques in N m, such as the torque coefficient."""
    SPEED: Final = _line("speed", "", "speed")
    """Made of speeds."""


ROLES: Mapping[str, Role] = {role.name: role for role in vars(ShipRole).values() if isinstance(role, Role)}
"""The roles of ``ShipRole`` by name, as files name them."""
