"""How the torque follows what the governor asks for, at large: the fuel of an engine, the current of a motor."""

from abc import ABC, abstractmethod
from typing import Any, ClassVar, Final

from shaftprint.catalogue._gauge import (
    GAUGE_K_I,
    GAUGE_K_P,
    GAUGE_OMEGA_N,
    GAUGE_ZETA,
    MOTOR_K_I,
    MOTOR_K_P,
    T_CONVERTER,
    T_D,
    T_M,
    V_ONE,
    G,
)
from shaftprint.catalogue._gauge_combinations import gauge_combinations, motor_combinations
from shaftprint.models._combination import Combination
from shaftprint.models._parameter import Parameter
from shaftprint.models.equations._flow import Flow
from shaftprint.models.equations._formula import Formula, Number
from shaftprint.models.equations._limits import first_order_lag, second_order_lag


class Actuation(ABC):
    """Governor and torque source of a limited line."""

    parameters: ClassVar[tuple[Parameter, ...]]
    """Those of the governor first, then those of the torque source ahead of the shaft."""
    speed_slope: ClassVar[tuple[Parameter, ...]]
    """The slope of the torque with speed, where there is one."""
    combinations: ClassVar[tuple[Combination, ...]]
    """What a test of the closed loop finds better than the parameters."""

    @abstractmethod
    def torque(self, flow: Flow, rack: Formula, speed: Formula, p: Any) -> Formula:
        """Return the torque that belongs to what was asked for a delay ago."""

    @abstractmethod
    def rack(self, torque: Formula, speed: Formula, p: Any) -> Formula:
        """Return what is asked for to have a torque in steady running."""

    @abstractmethod
    def lowest(self, level: Formula, speed: Formula, shape: Number) -> Formula:
        """Return the lowest torque over the working point's, for a level there and the shape of the highest."""


class _Engine(Actuation):
    """Fuel by a second-order lag; torque that may change with the speed."""

    parameters = (GAUGE_K_P, GAUGE_K_I, V_ONE, T_D, GAUGE_OMEGA_N, GAUGE_ZETA)
    speed_slope = (G,)
    combinations = gauge_combinations()

    def torque(self, flow: Flow, rack: Formula, speed: Formula, p: Any) -> Formula:
        late = second_order_lag(flow, flow.delayed(rack, p.t_d), p.omega_n, p.zeta)
        return p.v * late + p.g * speed  # type: ignore[no-any-return]

    def rack(self, torque: Formula, speed: Formula, p: Any) -> Formula:
        return (torque - p.g * speed) / p.v  # type: ignore[no-any-return]

    def lowest(self, level: Formula, speed: Formula, shape: Number) -> Formula:
        # friction of a motored engine: half of it independent of speed, half proportional
        return level * (1.0 + 0.5 * speed)


class _Motor(Actuation):
    """Torque by a converter: dead time and a first-order lag, whatever the speed."""

    parameters = (MOTOR_K_P, MOTOR_K_I, T_CONVERTER, T_M)
    speed_slope = ()
    combinations = motor_combinations()

    def torque(self, flow: Flow, rack: Formula, speed: Formula, p: Any) -> Formula:
        return first_order_lag(flow, flow.delayed(rack, p.t_d), p.T_m)

    def rack(self, torque: Formula, speed: Formula, p: Any) -> Formula:
        return torque

    def lowest(self, level: Formula, speed: Formula, shape: Number) -> Formula:
        # the current that brakes is limited as that which drives, and so is the power
        return level * shape


ENGINE: Final[Actuation] = _Engine()
MOTOR: Final[Actuation] = _Motor()
