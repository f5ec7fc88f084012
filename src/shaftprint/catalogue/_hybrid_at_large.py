"""A diesel with an electric machine on its gearbox, at large: limits of the diesel, and a clutch that slips.

The machine sits behind the diesel's clutch, so that the diesel may be clutched out of a line that the machine drives.
With ``n`` and ``n_l`` the speeds of diesel and line, ``M_c`` the torque of the clutch over that of the shaft, and
``tau_c = s_c tau_up`` the inertia time behind the clutch::

    diesel  (tau_up - tau_c) dn/dt = (1 - c_m s_m) (1 + M_b) - M_c      M_b as in ``_limited``, with its limits
    clutch  M_c slips at m_c and at n - n_l
    line    (tau_dn + tau_c) dn_l/dt = M_c + c_m (s_m + M_m) - 1 - M_p    M_p = k_q ((1 + n_l) |1 + n_l| - 1) / 2
    gauge   M_s = M_p + tau_dn dn_l/dt

For small signals it is GAUGE-HYBRID where the clutch is left out, or holds and is stiff.
"""

from collections.abc import Mapping
from typing import Any

from shaftprint.catalogue._actuation import ENGINE
from shaftprint.catalogue._clutch import CLUTCH, clutch_torque
from shaftprint.catalogue._gauge import C_SET, K_Q, T_GAUGE, T_SP, TAU_DN, TAU_UP
from shaftprint.catalogue._hybrid import C_M, OWN_K_I, OWN_K_P, SHARE
from shaftprint.catalogue._limited import DROOP, LimitedEngine, bollard_load, parameters_of, shape_of
from shaftprint.models._diagram import Diagram
from shaftprint.models._parameter import Parameter
from shaftprint.models._structure import Structure
from shaftprint.models.equations._flow import Flow
from shaftprint.models.equations._formula import Formula

CLUTCHED = "clutch"
BEHIND_CLUTCH = Parameter("s_c", "-", 0.0, 0.9, 0.1, "share of tau_up that turns behind the clutch", held=True)


def limited_hybrid(
    *limits: str, curve: tuple[tuple[float, float], ...] = (), period_s: float = 0.0, name: str = ""
) -> Structure:
    """Return the closed loop of a diesel with an electric machine, a quadratic propeller and some limits.

    Inputs are ``n_set`` and ``M_m``. Outputs are the speed ``n`` of the diesel, that of the line ``n_l``, ``M_s``, the
    rack ``X`` and the torque ``M_c`` of the clutch over that of the shaft, a deviation.

    ``limits``: names of limits: those of ``limited``, and ``clutch``; without it the clutch is rigid. ``curve``,
    ``period_s``: as in ``limited``. ``name``: what to call it; from the limits if not given. Raises StructureError if
    there is no limit of a name, or a smoke limit without a torque limit.
    """
    of_engine = tuple(limit for limit in limits if limit != CLUTCHED)
    has_clutch = CLUTCHED in limits
    governor = {p.name: p for p in (*ENGINE.parameters, OWN_K_P, OWN_K_I)}
    line = Diagram(
        name="hybrid line",
        input="n_set",
        outputs=("n", "n_l", "M_s", "X", "M_c"),
        equations=_HybridLine(of_engine, curve, period_s, has_clutch=has_clutch),
        of=(
            *(*governor.values(), C_SET, T_SP, T_GAUGE, TAU_DN, TAU_UP, K_Q, *ENGINE.speed_slope),
            *(DROOP, SHARE, C_M),
            *parameters_of(of_engine),
            *((*CLUTCH, BEHIND_CLUTCH) if has_clutch else ()),
        ),
        further=("M_m",),
    )
    return Structure(
        name=name or f"HYBRID-{'-'.join(limits).upper() or 'QUADRATIC'}",
        title="closed loop with an electric machine on the gearbox, " + ", ".join(("quadratic propeller", *limits)),
        inputs=line.inputs,
        outputs={output: line.paths(output) for output in line.outputs},
    )


class _HybridLine:
    """Equations of diesel, clutch, machine and line."""

    def __init__(
        self, limits: tuple[str, ...], curve: tuple[tuple[float, float], ...], period_s: float, *, has_clutch: bool
    ) -> None:
        self._engine = LimitedEngine(limits, shape_of(curve), period_s)
        self._has_clutch = has_clutch

    def __call__(self, flow: Flow, set_point: Formula, p: Any) -> Mapping[str, Formula]:
        """Return speeds, torques and rack."""
        engine = flow.state("n")
        brake, rack = self._engine(flow, p.c_set * flow.delayed(set_point, p.t_sp), engine, p)
        given = (1.0 - p.c_m * p.s_m) * (1.0 + brake)
        machine = p.c_m * (p.s_m + flow.input("M_m"))
        line = flow.state("n_l") if self._has_clutch else engine
        load, _ = bollard_load(flow, line, p)
        if self._has_clutch:
            torque = clutch_torque(flow, engine - line, p.m_c, p)
            flow.rate(engine, (given - torque) / ((1.0 - p.s_c) * p.tau_up))
            acceleration = (torque + machine - 1.0 - load) / (p.tau_dn + p.s_c * p.tau_up)
        else:
            acceleration = (given + machine - 1.0 - load) / (p.tau_dn + p.tau_up)
            torque = given
        flow.rate(line, acceleration)
        return {
            "n": engine,
            "n_l": line,
            "M_s": flow.delayed(load + p.tau_dn * acceleration, p.t_gauge),
            "X": rack,
            "M_c": torque - 1.0 + p.c_m * p.s_m,
        }
