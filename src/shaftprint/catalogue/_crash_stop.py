"""A crash stop: engine, clutches of ahead and astern, shaft, a propeller in four quadrants, and the ship.

With engine ``n``, shaft ``n_s`` and ship ``v`` over their values at the working point, each a deviation, ``T_a`` and
``T_r`` what the clutches of ahead and astern transmit, ``i`` the ratio of the train astern over that of the train
ahead, and ``u = 1 + v``::

    engine      tau_up dn/dt = M_b - T_a - T_r / i          M_b as in ``_limited``, with its limits
    ahead       T_a slips at m_c and at (1 + n) - (1 + n_s)
    astern      T_r slips at m_c i and at (1 + n) / i + (1 + n_s)
    shaft       tau_dn dn_s/dt = T_a - T_r - Q(n_s, v)
    ship        tau_u dv/dt = T(n_s, v) - u |u|^(e - 1)     r T where the thrust pulls the ship astern
    propeller   Q / Q_0 = V^2 C_Q*(beta) / (V_0^2 C_Q*(beta_0)), T alike, tan beta = (1 - w) v_a / (0.7 pi n D)

The gauge sits behind the clutches, ``M_s = T_a - T_r``. Propeller: see ``shaftprint.propeller.FourQuadrantCurve``. The
sums over multiples of ``beta`` are powers of its sine and cosine, so that no angle is worked out.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from shaftprint.catalogue._actuation import ENGINE
from shaftprint.catalogue._clutch import CLUTCH, M_C, clutch_torque
from shaftprint.catalogue._gauge import TAU_DN, TAU_UP
from shaftprint.catalogue._known_propeller import HIGHEST_WAKE
from shaftprint.catalogue._limited import DROOP, M_MAX, M_MIN, LimitedEngine, parameters_of, shape_of
from shaftprint.catalogue._sailing import TAU_U, E
from shaftprint.choices import CRASH_STOP
from shaftprint.errors import StructureError
from shaftprint.models._diagram import Diagram
from shaftprint.models._parameter import Parameter
from shaftprint.models._structure import Structure
from shaftprint.models.equations._flow import Flow
from shaftprint.models.equations._formula import Formula, choose, maximum, number
from shaftprint.models.equations._limits import rate_limited
from shaftprint.propeller._four_quadrants import FourQuadrantCurve

W = Parameter("w", "-", -0.2, HIGHEST_WAKE, 0.2, "wake fraction")
T_C = Parameter("t_c", "s", 0.01, 20.0, 1.0, "time in which a clutch closes or opens")
RATIO_ASTERN = Parameter("i_r", "-", 0.3, 3.0, 1.0, "ratio of the train astern over that of the train ahead", held=True)
THRUST_ASTERN = Parameter(
    "r_t", "-", 0.3, 2.0, 1.0, "share of the thrust astern that reaches the ship, over that share ahead", held=True
)


class CrashStopSymbol:
    """Symbols of the parameters of ``crash_stop`` by what they are."""

    INERTIA_UPSTREAM = TAU_UP.name
    INERTIA_DOWNSTREAM = TAU_DN.name
    TORQUE_LIMIT = M_MAX.name
    MOTORING_LIMIT = M_MIN.name
    WAKE_FRACTION = W.name
    RESISTANCE_EXPONENT = E.name
    SHIP_TIME = TAU_U.name
    CLUTCH_TORQUE = M_C.name
    RATIO_ASTERN = RATIO_ASTERN.name


NOT_OF_THE_LINE = frozenset(p.name for p in (W, E, TAU_U, T_C, RATIO_ASTERN, THRUST_ASTERN, *CLUTCH))
"""Parameters of ship and clutches; all others are those of governor, engine and shaft."""

_LIMITS = ("torque",)
# Of the speeds of shaft and water together, squared: a propeller that stands in water that stands has no torque.
_AT_REST = 1e-9
_STANDING = 1e-12


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class FourQuadrantPropeller:
    """The propeller of a ship and the steady running ahead from which it is stopped."""

    curve: FourQuadrantCurve
    """Thrust and torque in four quadrants."""
    pitch_ratio: float
    """Pitch over diameter."""
    diameter_m: float
    """Diameter [m]."""
    shaft_speed_rev_s: float
    """Speed of the propeller shaft [rev/s]."""
    ship_speed_m_s: float
    """Speed through the water [m/s]."""

    @property
    def pulls(self) -> bool:
        """Whether it pulls at the working point without wake, where it pulls least."""
        thrust, _ = self.curve.at(math.atan(self.slope), self.pitch_ratio)
        return float(thrust) > 0.0

    @property
    def slope(self) -> float:
        """Tangent of the advance angle at the working point, without wake."""
        return self.ship_speed_m_s / (self.curve.around_m(self.diameter_m) * self.shaft_speed_rev_s)


def crash_stop(propeller: FourQuadrantPropeller, *, curve: tuple[tuple[float, float], ...] = ()) -> Structure:
    """Return the line of a ship that goes from ahead to astern by its clutches.

    Inputs are ``n_set`` and ``gear``, both deviations: of ``1 + gear`` the lever says 1 for ahead, 0 for neither and -1
    for astern. Outputs are the speeds of engine and shaft ``n`` and ``n_s``, ``M_s``, the rack ``X``, ``v_s`` and
    ``x_s``, how far the ship is ahead of one that sails on, over the speed at the working point [s].

    ``propeller``: curves and working point. ``curve``: shape of the full-load torque, as in ``limited``. Raises
    StructureError if the propeller does not pull at its working point; PropellerError if the curves do not hold the
    pitch.
    """
    if not propeller.pulls:
        raise StructureError(
            f"{CRASH_STOP}: expected a propeller that pulls at its working point, found none of {propeller.curve.name} "
            f"at {propeller.shaft_speed_rev_s:g} rev/s and {propeller.ship_speed_m_s:g} m/s; check both speeds, and "
            "that the first is that of the propeller shaft."
        )
    line = Diagram(
        name="crash stop",
        input="n_set",
        outputs=("n", "n_s", "M_s", "X", "v_s", "x_s"),
        equations=_ReversedLine(propeller, curve),
        of=(
            *(*ENGINE.parameters, TAU_DN, TAU_UP, *ENGINE.speed_slope, DROOP, *parameters_of(_LIMITS)),
            *(W, E, TAU_U, T_C, RATIO_ASTERN, THRUST_ASTERN, *CLUTCH),
        ),
        further=("gear",),
    )
    return Structure(
        name=CRASH_STOP,
        title=f"line of a ship that is stopped by its clutches, {propeller.curve.name}",
        inputs=line.inputs,
        outputs={output: line.paths(output) for output in line.outputs},
    )


class _ReversedLine:
    """Equations of engine, clutches, shaft and ship."""

    def __init__(self, propeller: FourQuadrantPropeller, curve: tuple[tuple[float, float], ...]) -> None:
        self._engine = LimitedEngine(_LIMITS, shape_of(curve), 0.0)
        self._forces = _FourQuadrants(propeller)

    def __call__(self, flow: Flow, demand: Formula, p: Any) -> Mapping[str, Formula]:
        """Return what the instruments of ship and line show."""
        engine, shaft, ship = flow.state("n"), flow.state("n_s"), flow.state("v_s")
        brake, rack = self._engine(flow, demand, engine, p)
        closed = 1.0 + rate_limited(flow, flow.input("gear"), 1.0 / p.t_c)
        ahead = clutch_torque(flow, engine - shaft, maximum(closed, 0.0) * p.m_c, p)
        astern = clutch_torque(flow, (1.0 + engine) / p.i_r + 1.0 + shaft, maximum(-closed, 0.0) * p.m_c * p.i_r, p)
        thrust, torque = self._forces(1.0 + shaft, 1.0 + ship, p.w)
        flow.rate(engine, (1.0 + brake - ahead - astern / p.i_r) / p.tau_up)
        flow.rate(shaft, (ahead - astern - torque) / p.tau_dn)
        flow.rate(ship, (choose(thrust, 0.0, p.r_t * thrust, thrust) - _resistance(1.0 + ship, p.e)) / p.tau_u)
        return {
            "n": engine,
            "n_s": shaft,
            "M_s": ahead - astern - 1.0,
            "X": rack,
            "v_s": ship,
            "x_s": flow.running_sum("way", ship),
        }


def _resistance(speed: Formula, exponent: Formula) -> Formula:
    """Return ``u |u|^(e - 1)``: the same law astern."""
    return speed * ((exponent - 1.0) * (abs(speed) + _STANDING).log()).exp()


class _FourQuadrants:
    """Thrust and torque over those at the working point."""

    def __init__(self, propeller: FourQuadrantPropeller) -> None:
        self._slope = propeller.slope
        self._table = propeller.curve.of_pitch(propeller.pitch_ratio)

    def __call__(self, shaft: Formula, ship: Formula, wake: Formula) -> tuple[Formula, Formula]:
        """Return both for speeds of shaft and ship over those at the working point."""
        along = self._slope * (1.0 - wake)
        thrust, torque = self._forces(shaft, along * ship)
        thrust_before, torque_before = self._forces(number(1.0), along)
        return thrust / thrust_before, torque / torque_before

    def _forces(self, around: Formula, along: Formula) -> tuple[Formula, Formula]:
        """Return ``V^2 C_T*`` and ``V^2 C_Q*`` for speeds around and along the shaft."""
        squared = around * around + along * along + _AT_REST
        size = squared.sqrt()
        cosine, sine = around / size, along / size
        multiples = [(number(1.0), number(0.0)), (cosine, sine)]
        for _ in self._table[2:]:
            # cos (k + 1) b = 2 cos b cos k b - cos (k - 1) b, and the sine alike
            (before, last), twice = multiples[-2:], 2.0 * cosine
            multiples.append((twice * last[0] - before[0], twice * last[1] - before[1]))
        thrust, torque = number(0.0), number(0.0)
        for (c, s), (a_t, b_t, a_q, b_q) in zip(multiples, self._table.tolist(), strict=False):
            thrust = thrust + a_t * c + b_t * s
            torque = torque + a_q * c + b_q * s
        return squared * thrust, squared * torque
