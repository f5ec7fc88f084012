"""The limited governor and its engine on the measured speed: no law of the propeller, no disturbance of the speed.

Upstream of the gauge the torque of the engine is known without any propeller, ``M_b = M_s + tau_up dn/dt``. The
governor of ``_limited``, fed with the measured speed, predicts the same torque, here over the load::

    y = (1 + M_b) / (1 + n)^2 - 1

What disturbs the speed, inflow or uneven combustion, is in the measured speed as the governor felt it: it carries an
error out of a deadband, or a rack into its rate limit, in the model as it did in the ship. The noise of the torque
grows with the load, hence ``y``. An observer draws the integrator towards the measured
torque, slowly, because an offset of the set point would otherwise pile up without end.

As in the closed loop the latency of the set point stands behind everything, so that jumps of the set point keep their
places on the grid of the simulation. Speed and torque are given ``AHEAD_S`` early and delayed by ``AHEAD_S - t_sp``.
"""

from collections.abc import Mapping
from typing import Any

from shaftprint.catalogue._gauge import C_SET, GAUGE_K_I, GAUGE_K_P, GAUGE_OMEGA_N, GAUGE_ZETA, T_D, T_SP, V_ONE, G
from shaftprint.catalogue._limited import (
    A_0,
    D_E,
    DROOP,
    M_MAX,
    M_MIN,
    R_S,
    R_X,
    T_AW,
    TAU_TC,
    LimitedEngine,
    parameters_of,
)
from shaftprint.catalogue._roles import ShipRole
from shaftprint.models._delays import Delay
from shaftprint.models._diagram import Diagram
from shaftprint.models._parameter import Parameter
from shaftprint.models._structure import Structure
from shaftprint.models.equations._flow import Flow
from shaftprint.models.equations._formula import Formula, maximum

AHEAD_S = T_SP.upper
"""How early ``limited_governor`` is given speed and torque, in s: the largest latency of the set point."""
OBSERVER_PER_S = 0.1
# Below this speed, over that of the working point, the load counts as that of this speed.
LEAST_SPEED = 0.1
E_SET = Parameter("e_set", "-", -0.05, 0.05, 0.0, "offset of the measured set point", role=ShipRole.SET_POINT_OFFSET)


class GovernorSymbol:
    """Symbols of the parameters of ``limited_governor``, and of the limits of ``limited``, by what they are."""

    PROPORTIONAL_GAIN = GAUGE_K_P.name
    INTEGRAL_GAIN = GAUGE_K_I.name
    LOOP_DELAY = T_D.name
    ACTUATOR_FREQUENCY = GAUGE_OMEGA_N.name
    ACTUATOR_DAMPING = GAUGE_ZETA.name
    SET_POINT_LATENCY = T_SP.name
    SET_POINT_SCALE = C_SET.name
    SET_POINT_OFFSET = E_SET.name
    ENGINE_SPEED_SLOPE = G.name
    TORQUE_LIMIT = M_MAX.name
    MOTORING_LIMIT = M_MIN.name
    ANTI_WINDUP = T_AW.name
    RACK_RATE = R_X.name
    SET_POINT_RATE = R_S.name
    DEADBAND = D_E.name
    UNBOOSTED_TORQUE = A_0.name
    TURBOCHARGER_LAG = TAU_TC.name


def limited_governor(*limits: str, period_s: float = 0.0, name: str = "") -> Structure:
    """Return governor and engine with some limits, from set point, speed and torque to the torque over the load.

    Inputs are the set point ``n_set`` and, ``AHEAD_S`` early, speed ``n``, engine torque ``M_b`` and the full-load
    torque at the measured speed over that at the working-point speed, less one, ``c``: the speed is known, and so no
    curve is compiled into the equations.

    Parameters
    ----------
    limits, period_s
        As in ``limited``. The rate limit ``"ramp"`` is a parameter that no equation has: it acts on the set point
        before the governor, and whoever drives the model gives ``n_set`` as the limit leaves it.
    name
        What to call it; from the limits if not given.

    Raises
    ------
    StructureError
        If there is no limit of a name, or a smoke limit without a torque limit.
    """
    extra = parameters_of(limits)
    inside = tuple(limit for limit in limits if limit != "ramp")
    diagram = Diagram(
        name="limited governor",
        input="n_set",
        outputs=("y",),
        equations=_PredictedTorque(LimitedEngine(inside, _measured_shape, period_s)),
        of=(C_SET, E_SET, GAUGE_K_P, GAUGE_K_I, V_ONE, T_D, GAUGE_OMEGA_N, GAUGE_ZETA, G, T_SP, DROOP, *extra),
        further=("n", "M_b", "c"),
    )
    return Structure(
        name=name or f"GOVERNOR-{'-'.join(limits).upper() or 'UNLIMITED'}",
        title=f"governor and engine on the measured speed{''.join(f', {limit}' for limit in limits)}",
        inputs=diagram.inputs,
        outputs={"y": {source: port * Delay(T_SP) for source, port in diagram.paths("y").items()}},
    )


def _late(flow: Flow, name: str) -> Formula:
    """Return an input that is given early, as it is at the demand of the governor."""
    return flow.delayed(flow.input(name), AHEAD_S - flow.parameter(T_SP.name))


def _measured_shape(flow: Flow, speed: Formula) -> Formula:
    return 1.0 + _late(flow, "c")


class _PredictedTorque:
    """Equations of the torque at the gauge over the load."""

    def __init__(self, engine: LimitedEngine) -> None:
        self._engine = engine

    def __call__(self, flow: Flow, set_point: Formula, p: Any) -> Mapping[str, Formula]:
        """Return the torque at the gauge over the load of the propeller, a deviation."""
        speed, torque = _late(flow, "n"), _late(flow, "M_b")
        demand = p.c_set * set_point + p.e_set
        brake, _ = self._engine(flow, demand, speed, p, observer=lambda burnt: OBSERVER_PER_S * (torque - burnt))
        turned = maximum(1.0 + speed, LEAST_SPEED)
        return {"y": (1.0 + brake) / (turned * turned) - 1.0}
