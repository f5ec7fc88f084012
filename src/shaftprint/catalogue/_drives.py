"""Drives that are no ship's: a motor, a servo axis in position control, two masses on a shaft that twists.

Inputs and outputs are whole values in the units of ``SIGNAL_UNITS``, not deviations: dry friction knows where
standstill is. With friction held at zero all of them are linear.
"""

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any

from shaftprint.models._combination import Combination
from shaftprint.models._diagram import Diagram
from shaftprint.models._parameter import Parameter
from shaftprint.models._structure import Structure
from shaftprint.models.equations._flow import Flow
from shaftprint.models.equations._formula import Formula
from shaftprint.models.equations._friction import coulomb_friction

SIGNAL_UNITS: Mapping[str, str] = MappingProxyType(
    {
        "u": "V",
        "i": "A",
        "T_L": "N m",
        "T_m": "N m",
        "omega": "rad/s",
        "omega_1": "rad/s",
        "omega_2": "rad/s",
        "theta": "rad",
        "theta_set": "rad",
    }
)
"""Unit of each input and output of the drives."""

SIGNAL_MEANINGS: Mapping[str, str] = MappingProxyType(
    {
        "u": "voltage at the terminals",
        "i": "current of the motor",
        "T_L": "torque of the load, positive against the motor",
        "T_m": "torque of the motor",
        "omega": "speed of the shaft",
        "omega_1": "speed at the motor",
        "omega_2": "speed at the load",
        "theta": "angle of the axis",
        "theta_set": "angle that is asked for",
    }
)
"""What each of them is."""

INERTIA = Parameter("J", "kg m2", 1e-6, 1.0, 1e-3, "inertia of the rotor and what is fixed to it")
VISCOUS = Parameter("d", "N m s/rad", 0.0, 1.0, 1e-3, "friction that grows with the speed")
DRY = Parameter("T_C", "N m", 0.0, 5.0, 0.02, "dry friction")
YIELDING = Parameter("theta_y", "rad", 1e-6, 0.1, 5e-4, "angle by which what friction holds yields", held=True)
WITHIN = Parameter("t_y", "s", 1e-6, 0.1, 1e-3, "time within which friction follows the direction", held=True)

RESISTANCE = Parameter("R", "ohm", 0.01, 100.0, 1.0, "resistance of winding and leads")
INDUCTANCE = Parameter("L", "H", 1e-5, 1.0, 1e-3, "inductance of the winding")
MOTOR_CONSTANT = Parameter("K_m", "N m/A", 1e-3, 10.0, 0.1, "torque for one ampere, and voltage for one rad/s")

POSITION_GAIN = Parameter("K_x", "1/s", 0.1, 500.0, 20.0, "gain of the position controller")
SPEED_GAIN = Parameter("K_v", "N m s/rad", 1e-3, 100.0, 0.2, "proportional gain of the speed controller")
INTEGRAL_GAIN = Parameter("K_iv", "N m/rad", 0.0, 1000.0, 2.0, "integral gain of the speed controller")
LOOP_DELAY = Parameter("t_u", "s", 0.0, 0.05, 0.002, "delay of computer and amplifier")

INERTIA_1 = Parameter("J_1", "kg m2", 1e-6, 10.0, 1e-3, "inertia at the motor")
INERTIA_2 = Parameter("J_2", "kg m2", 1e-6, 10.0, 2e-3, "inertia at the load")
STIFFNESS = Parameter("k_s", "N m/rad", 1e-2, 1e5, 20.0, "stiffness of the shaft between")
DAMPING = Parameter("d_s", "N m s/rad", 0.0, 10.0, 2e-3, "damping of the shaft between")
VISCOUS_1 = Parameter("d_1", "N m s/rad", 0.0, 1.0, 1e-3, "friction at the motor that grows with the speed")
VISCOUS_2 = Parameter("d_2", "N m s/rad", 0.0, 1.0, 1e-3, "friction at the load that grows with the speed")


def _motor(flow: Flow, voltage: Formula, p: Any, load: Formula | None) -> dict[str, Formula]:
    """Return speed and current of a motor with a constant field."""
    speed, current = flow.state("omega"), flow.state("i")
    friction = _friction(flow, speed, p)
    torque = p.K_m * current - friction
    flow.rate(current, (voltage - p.R * current - p.K_m * speed) / p.L)
    flow.rate(speed, (torque if load is None else torque - load) / p.J)
    return {"omega": speed, "i": current}


def _friction(flow: Flow, speed: Formula, p: Any) -> Formula:
    """Return the torque of dry and viscous friction."""
    dry = coulomb_friction(flow, speed, p.T_C, yielding=p.theta_y, within_s=p.t_y)
    viscous: Formula = p.d * speed
    return viscous + dry


def motor() -> Structure:
    """Return MOTOR: a motor with constant field, from its voltage to speed and current."""
    return _motor_structure("MOTOR", "motor with dry friction", ())


def loaded_motor() -> Structure:
    """Return LOADED-MOTOR: a motor whose load is measured too."""
    return _motor_structure("LOADED-MOTOR", "motor with dry friction and a measured load", ("T_L",))


def _motor_structure(name: str, title: str, further: tuple[str, ...]) -> Structure:
    def equations(flow: Flow, voltage: Formula, p: Any) -> dict[str, Formula]:
        return _motor(flow, voltage, p, flow.input("T_L") if further else None)

    parameters = (RESISTANCE, INDUCTANCE, MOTOR_CONSTANT, INERTIA, VISCOUS, DRY, YIELDING, WITHIN)
    diagram = Diagram(name, "u", ("omega", "i"), equations, parameters, further=further)
    constant = Combination(
        name="J R / K_m^2",
        unit="s",
        of=lambda p: p["J"] * p["R"] / p["K_m"] ** 2,
        meaning="mechanical time constant without friction",
    )
    return _structure(diagram, title, (constant,))


def servo() -> Structure:
    """Return SERVO: an axis with dry friction under a position controller with a PI controller of the speed in it."""

    def equations(flow: Flow, asked: Formula, p: Any) -> dict[str, Formula]:
        angle, speed, integral = flow.state("theta"), flow.state("omega"), flow.state("speed integral")
        error = p.K_x * (asked - angle) - speed
        torque = p.K_v * error + integral
        flow.rate(integral, p.K_iv * error)
        friction = _friction(flow, speed, p)
        flow.rate(speed, (flow.delayed(torque, p.t_u) - friction) / p.J)
        flow.rate(angle, speed)
        return {"theta": angle, "T_m": torque}

    parameters = (INERTIA, VISCOUS, DRY, YIELDING, WITHIN, POSITION_GAIN, SPEED_GAIN, INTEGRAL_GAIN, LOOP_DELAY)
    diagram = Diagram("SERVO", "theta_set", ("theta", "T_m"), equations, parameters)
    return _structure(diagram, "servo axis with dry friction in position control", ())


def two_masses_on_a_shaft() -> Structure:
    """Return TWO-MASS: motor and load on a shaft that twists, from the motor's torque to both speeds."""

    def equations(flow: Flow, torque: Formula, p: Any) -> dict[str, Formula]:
        first, second, twist = flow.state("omega_1"), flow.state("omega_2"), flow.state("twist")
        between = p.k_s * twist + p.d_s * (first - second)
        flow.rate(twist, first - second)
        flow.rate(first, (torque - between - p.d_1 * first) / p.J_1)
        flow.rate(second, (between - p.d_2 * second) / p.J_2)
        return {"omega_1": first, "omega_2": second}

    parameters = (INERTIA_1, INERTIA_2, STIFFNESS, DAMPING, VISCOUS_1, VISCOUS_2)
    diagram = Diagram("TWO-MASS", "T_m", ("omega_1", "omega_2"), equations, parameters)
    resonance = Combination(
        name="sqrt(k_s (1/J_1 + 1/J_2))",
        unit="rad/s",
        of=lambda p: (p["k_s"] * (1.0 / p["J_1"] + 1.0 / p["J_2"])) ** 0.5,
        meaning="natural frequency of the shaft without damping",
    )
    return _structure(diagram, "motor and load on a shaft that twists", (resonance,))


def _structure(diagram: Diagram, title: str, combinations: tuple[Combination, ...]) -> Structure:
    """Return a structure of one diagram."""
    outputs = {output: diagram.paths(output) for output in diagram.outputs}
    return Structure(name=diagram.name, title=title, inputs=diagram.inputs, outputs=outputs, combinations=combinations)


DRIVES: Mapping[str, Callable[[], Structure]] = MappingProxyType(
    {"MOTOR": motor, "LOADED-MOTOR": loaded_motor, "SERVO": servo, "TWO-MASS": two_masses_on_a_shaft}
)
"""Structures of drives by name."""
