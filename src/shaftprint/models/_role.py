"""What a parameter stands for: its role, from which follows all about it that is not in an equation.

A name is free; the role says what a number is. From it follow the physical value and its unit, what the load of a test
line and the working point do to it, whether it belongs to the line or to a sensor, and what it rests on when something
about a recording is in doubt. The roles of a ship's line are those of ``catalogue.ShipRole``.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal, TypeAlias

from shaftprint.normalisation import Normalisation

Basis: TypeAlias = Literal[
    "torque", "level", "inertia", "load", "governor", "delay", "clock", "pitch clock", "latency", "speed", "set point",
    "size",
]  # fmt: skip
"""What a number is made of: torque in N m; its level at the working point, which its changes do not tell; inertia over
torque; slope of the load; governor and engine, which are told apart with the upstream inertia; the sum of the delays;
the clock of the logged set point; that of the logged pitch beside what asks for it; the latency of the gauge; the
speed; the set-point line; the propeller's diameter."""


@dataclass(frozen=True, kw_only=True, slots=True)
class PhysicalForm:
    """The same number in the units of the line."""

    name: str
    """Symbol or field term, such as ``I_dn``."""
    unit: str
    """Unit."""
    meaning: str
    """What it stands for."""
    scale: Callable[[Normalisation], float] = field(compare=False)
    """Its value over that of the parameter; a gain on a logged rack is multiplied by the rack's slope first."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Role:
    """What a parameter, or a combination of parameters, stands for."""

    name: str
    """Field term, such as ``inertia downstream``; it is how files name the role."""
    unit: str = ""
    """Unit that a parameter of this role must have; empty where it may have any."""
    basis: frozenset[Basis] = frozenset()
    """What it is made of; empty where that is everything."""
    over_torque: bool = False
    """Whether it is a physical value over the torque and times the speed of the working point, and so moves with it."""
    law: float | None = None
    """Value that a law gives it whatever the torque. What it lacks to that is a constant torque over the torque of the
    working point, such as a zero of the gauge, and so moves with that; None where there is no such law."""
    loaded: bool = False
    """Whether it is a slope of the propeller torque, which grows with the load of a test line."""
    over_speed: bool = False
    """Whether it acts with the share by which the speed is above that of the working point of the parameters, and so
    not at all there."""
    rack_power: int = 0
    """Power of the rack of the working point with which it goes, where the rack is logged."""
    of_sensor: bool = False
    """Whether it belongs to a sensor, not to the line."""
    physical: PhysicalForm | None = None
    """The same in the units of the line; None where it is in SI units already, or has no such form."""

    @property
    def is_of_line(self) -> bool:
        """Whether it stays as it is when the line is tested at another load: neither normalised nor of a sensor."""
        return not (self.over_torque or self.loaded or self.rack_power or self.of_sensor)
