"""A ship that sails free, at large: open-water curves instead of their slopes, resistance instead of its slope.

With ``n`` and ``v`` the deviations of shaft and ship over their values at the working point, and ``J_0`` the advance
ratio there::

    J = J_0 (1 + v) / (1 + n)
    Q / Q_0 = (1 + n)^2 K_Q(J) / K_Q(J_0)        T / T_0 = (1 + n)^2 K_T(J) / K_T(J_0)        R / R_0 = (1 + v)^e
    tau_u dv/dt = sigma T(n, v) + (1 - sigma) T(0, v) - R(v)

each over its value at the working point (D. Stapersma and A. Vrijdag, Linearisation of a ship propulsion system model,
Ocean Engineering 142, 2017, 441-457, sections 2 and 3, before the linearisation). For small signals the structure is
FREE-LOG with the slopes that the curves have at ``J_0``.
"""

from collections.abc import Mapping
from typing import Any

from shaftprint.catalogue._known_propeller import HIGHEST_WAKE, KnownPropeller
from shaftprint.catalogue._limited import LoadPart, limited
from shaftprint.catalogue._sailing import SIGMA, TAU_U, E
from shaftprint.errors import StructureError
from shaftprint.models import Parameter, Structure, first_order_lag, rate_limited
from shaftprint.models.equations._flow import Flow
from shaftprint.models.equations._formula import Formula, Number, as_formula, number


def sailing_at_large(
    propeller: KnownPropeller,
    *limits: str,
    curve: tuple[tuple[float, float], ...] = (),
    period_s: float = 0.0,
    name: str = "FREE-LARGE",
) -> Structure:
    """Return the closed loop of a free-sailing ship with open-water curves and some limits.

    Parameters
    ----------
    propeller
        Curves and working point.
    limits, curve, period_s
        As in ``limited``.
    name
        What to call it.

    Raises
    ------
    StructureError
        If there is no limit of a name, or the propeller does not pull at its working point.
    PropellerError
        If the curves do not hold the pitch.
    """
    lowest = propeller.lowest_wake()
    wake = Parameter("w", "-", lowest, HIGHEST_WAKE, max(0.2, lowest), "wake fraction")
    ship = LoadPart(equations=SailingLoad(propeller), parameters=(wake, E, TAU_U, SIGMA), shows=("v_s",))
    return limited(*limits, curve=curve, period_s=period_s, name=name, load=ship)


class SailingLoad:
    """The propeller of a ship under way."""

    def __init__(self, propeller: KnownPropeller) -> None:
        pitch = propeller.pitch_ratio
        self._thrust = tuple(propeller.curve.thrust.powers_of_advance(pitch))
        self._torque = tuple(propeller.curve.torque.powers_of_advance(pitch))
        self._advance_without_wake = propeller.ship_speed_m_s / (propeller.shaft_speed_rev_s * propeller.diameter_m)

    def __call__(self, flow: Flow, speed: Formula, p: Any) -> tuple[Formula, Mapping[str, Formula]]:
        """Return the torque of the propeller, a deviation, and the speed of the ship."""
        ship = flow.state("v_s")
        at_rest = self._advance_without_wake * (1.0 - p.w)
        torque = _loaded(self._torque, at_rest, speed, ship)
        thrust = p.sigma * _loaded(self._thrust, at_rest, speed, ship)
        thrust = thrust + (1.0 - p.sigma) * _loaded(self._thrust, at_rest, number(0.0), ship)
        resistance = (p.e * (1.0 + ship).log()).exp()
        flow.rate(ship, (thrust - resistance) / p.tau_u)
        return 0.5 * p.k_q * (torque - 1.0), {"v_s": ship}


def _loaded(powers: tuple[float, ...], at_rest: Formula, speed: Formula, ship: Formula) -> Formula:
    """Return thrust or torque over its value at the working point, ``(1 + n)^2 K(J) / K(J_0)``."""
    turned = 1.0 + speed
    return turned * turned * _polynomial(powers, at_rest * (1.0 + ship) / turned) / _polynomial(powers, at_rest)


def _polynomial(powers: tuple[float, ...], advance: Formula) -> Formula:
    """Return ``c_0 + c_1 J + c_2 J^2 + ...`` by Horner's rule."""
    value: Formula = number(0.0)
    for coefficient in reversed(powers):
        value = value * advance + float(coefficient)
    return value


def pitch_actuator(
    flow: Flow, set_point: Formula, *, lag_s: Number, fastest: Number, period_s: Number = 0.0
) -> Formula:
    """Return the pitch that a hydraulic actuator reaches: behind a lag, and no faster than its pumps allow.

    ``tau_th dtheta/dt = theta_set - theta`` with ``|dtheta_set/dt| <= r``: controllable pitch propellers of ships take
    15 to 30 s from full ahead to full astern.

    Parameters
    ----------
    set_point
        Pitch asked for, in any unit.
    lag_s
        Lag of the actuator [s].
    fastest
        Fastest change [1/s] in units of the set point.
    period_s
        Period of the pitch controller [s]; 0 for every step of the simulation.

    Raises
    ------
    StructureError
        If the fastest change is the number zero.
    """
    if as_formula(fastest).equals(0.0):
        raise StructureError("pitch actuator: expected a fastest change above zero; without one the pitch never moves.")
    return first_order_lag(flow, rate_limited(flow, set_point, fastest, period_s=period_s), lag_s, "pitch")
