"""The gauge-aware closed loop at large: quadratic propeller, and the limits of governor and engine.

The free bodies are those of ``_gauge``; for small signals the structures are ``GAUGE-CLOSED``::

    governor    e = DB(RL(c_set n_set) - n)                 X = RL(clip(K_p e + I, X_min, X_max))
    engine      M_b = clip(v F X(t - t_d) + g n, m_min, m_max(n))
    upstream    tau_up dn/dt = M_b - M_s
    downstream  tau_dn dn/dt = M_s - M_p                M_p = k_q ((1 + n)^2 - 1) / 2

All are deviations from the working point; the limits are over the brake torque there, ``1 + M_b <= m_max``.

The latency of the set point stands behind the loop, where it does the same: whatever comes late, so does all that
follows. Ahead of it, a jump of the set point would meet the rate limit at a whole step of the simulation, and what is
simulated would change with ``t_sp`` in jumps of a step, its derivative zero.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

from shaftprint.catalogue._actuation import ENGINE, MOTOR, Actuation
from shaftprint.catalogue._gauge import C_SET, K_Q, T_SP, TAU_DN, TAU_UP, speed_sensor, torque_sensor
from shaftprint.errors import StructureError
from shaftprint.models._blocks import Gain
from shaftprint.models._delays import Delay
from shaftprint.models._diagram import Diagram
from shaftprint.models._parameter import Parameter
from shaftprint.models._structure import Structure
from shaftprint.models.equations._engine_parts import boosted, quadratic_propeller
from shaftprint.models.equations._flow import Flow
from shaftprint.models.equations._formula import Formula, Number, clip, table
from shaftprint.models.equations._limits import deadband, limited_pi, rate_limited

M_MAX = Parameter("m_max", "-", 1.05, 6.0, 2.8, "torque limit of the engine over the brake torque of the working point")
M_MIN = Parameter("m_min", "-", -2.0, 0.9, -0.6, "lowest brake torque, engine motored, over that of the working point")
T_AW = Parameter("T_aw", "s", 0.02, 10.0, 0.5, "time in which the governor's integrator is led back at a limit")
R_X = Parameter("r_x", "1/s", 0.2, 100.0, 10.0, "fastest change of the fuel rack, over the rack of the working point")
D_E = Parameter("d_e", "-", 0.0, 0.05, 0.002, "speed error within which the governor does nothing")
DROOP = Parameter("droop", "-", 0.0, 0.1, 0.0, "fall of the speed for one rack of the working point", held=True)
A_0 = Parameter("a_0", "-", 0.2, 1.0, 0.55, "torque without boost over full-load torque: the smoke limit")
R_S = Parameter("r_s", "1/s", 0.01, 50.0, 0.3, "fastest change of the set point, over the speed of the working point")
TAU_TC = Parameter("tau_tc", "s", 0.1, 10.0, 1.0, "lag of the turbocharger")

OPTIONS: Mapping[str, tuple[Parameter, ...]] = {
    "torque": (M_MAX, M_MIN, T_AW),
    "rate": (R_X,),
    "deadband": (D_E,),
    "smoke": (A_0, TAU_TC),
    "ramp": (R_S,),
}
"""Limits that can be put into a structure, with the parameters that each brings."""


def limited(
    *limits: str,
    curve: tuple[tuple[float, float], ...] = (),
    period_s: float = 0.0,
    name: str = "",
    with_rack: bool = False,
    by_motor: bool = False,
    load: "LoadPart | None" = None,
) -> Structure:
    """Return the gauge-aware closed loop with a quadratic propeller and some limits.

    Parameters
    ----------
    limits
        Names of limits: ``torque``, ``rate``, ``deadband``, ``ramp``, ``smoke``, the last with ``torque`` only.
    curve
        Shape of the full-load torque: corner points of speed deviation and torque over that at the working-point speed.
    period_s
        Period in which the governor moves a limited rack [s]; 0 for every step of the simulation.
    name
        What to call it; from the limits if not given.
    with_rack
        Whether the rack that the governor gives, ``X``, is an output too.
    by_motor
        Whether an electric motor drives the line: for small signals it is ``GAUGE-MOTOR`` then.

    Raises
    ------
    StructureError
        If there is no limit of a name, or a smoke limit without a torque limit.
    """
    extra, actuation = parameters_of(limits), MOTOR if by_motor else ENGINE
    load = load or BOLLARD
    loop = Diagram(
        name="limited loop",
        input="demand",
        outputs=("n", "M_s", "X", *load.shows),
        equations=LimitedLoop(limits, curve, period_s, load.equations, actuation),
        of=(*actuation.parameters, TAU_DN, TAU_UP, K_Q, *load.parameters, *actuation.speed_slope, DROOP, *extra),
    )
    demand, ports = Gain(C_SET), loop.ports()
    rack = {"X": demand * ports["X"] * Delay(T_SP)} if with_rack else {}
    return Structure(
        name=name or f"GAUGE-{'MOTOR-' * by_motor}{'-'.join(limits).upper() or 'QUADRATIC'}",
        title=f"gauge-aware closed loop{' of an electric motor' * by_motor}, "
        + ", ".join(("quadratic propeller", *limits)),
        input="n_set",
        outputs={
            "n": demand * ports["n"] * Delay(T_SP) * speed_sensor(),
            "M_s": demand * ports["M_s"] * Delay(T_SP) * torque_sensor(),
            **rack,
            **{name: demand * ports[name] * Delay(T_SP) for name in load.shows},
        },
        combinations=actuation.combinations,
    )


def parameters_of(limits: tuple[str, ...]) -> tuple[Parameter, ...]:
    """Return the parameters that some limits bring.

    Raises StructureError if there is no limit of a name, or a smoke limit without a torque limit.
    """
    unknown = [limit for limit in limits if limit not in OPTIONS]
    if unknown:
        raise StructureError(f"there is no limit {unknown[0]!r}; there are {', '.join(OPTIONS)}.")
    if "smoke" in limits and "torque" not in limits:
        raise StructureError("a smoke limit needs the torque limit of which it gives a part: name both.")
    return tuple(p for limit in limits for p in OPTIONS[limit])


Load: TypeAlias = Callable[[Flow, Formula, Any], tuple[Formula, Mapping[str, Formula]]]
"""Takes equations, shaft speed and parameters; gives the torque of the propeller, and what else there is to see."""


@dataclass(frozen=True, kw_only=True, slots=True)
class LoadPart:
    """What a line drives."""

    equations: Load
    """Its torque by the shaft speed."""
    parameters: tuple[Parameter, ...] = ()
    """What they ask for beside ``k_q``."""
    shows: tuple[str, ...] = ()
    """What else there is to see."""


Observer: TypeAlias = Callable[[Formula], Formula]
"""Takes the brake torque; gives what it adds to the rate of the governor's integrator."""

Shape: TypeAlias = Callable[[Flow, Formula], Number]
"""Takes equations and engine speed; gives the torque limit over that at the working-point speed."""


def shape_of(curve: tuple[tuple[float, float], ...]) -> Shape:
    """Return the shape of a torque limit given by corner points; empty for a flat one."""
    return lambda flow, speed: table(speed, curve) if curve else 1.0


def bollard_load(flow: Flow, speed: Formula, p: Any) -> tuple[Formula, Mapping[str, Formula]]:
    """Return the torque of a propeller at the quay, and nothing else."""
    return quadratic_propeller(speed, p.k_q), {}


BOLLARD = LoadPart(equations=bollard_load)
"""A propeller at the quay."""


class LimitedEngine:
    """Equations of a governor and its engine with some limits: from demand and speed to brake torque."""

    def __init__(self, limits: tuple[str, ...], shape: Shape, period_s: float, actuation: Actuation = ENGINE) -> None:
        self._limits = limits
        self._actuation = actuation
        self._shape = shape
        self._period_s = period_s

    def __call__(
        self, flow: Flow, demand: Formula, speed: Formula, p: Any, observer: Observer | None = None
    ) -> tuple[Formula, Formula]:
        """Return brake torque and rack.

        ``observer``: what the brake torque adds to the rate of the governor's integrator.
        """
        if "ramp" in self._limits:
            demand = rate_limited(flow, demand, p.r_s, period_s=self._period_s)
        error = demand - speed
        if "deadband" in self._limits:
            error = deadband(error, p.d_e)
        burnt = flow.unknown()
        lowest, highest = self._torque_limits(flow, speed, burnt, p)
        drawn: Number = observer(burnt) if observer else 0.0
        rack = self._governor(flow, error, speed, lowest, highest, drawn, p)
        demanded = self._actuation.torque(flow, rack, speed, p)
        brake = flow.close(burnt, demanded if lowest is None else clip(demanded, lowest, highest), "engine torque")
        return brake, rack

    def _torque_limits(self, flow: Flow, speed: Formula, burnt: Formula, p: Any) -> tuple[Formula | None, Formula]:
        """Return the lowest and highest brake torque; no lowest where torque is not limited."""
        if "torque" not in self._limits:
            return None, burnt
        shape = self._shape(flow, speed)
        highest = p.m_max * shape - 1.0
        if "smoke" in self._limits:
            highest = boosted(flow, burnt, highest, at_rest=p.m_max, unboosted=p.a_0, lag_s=p.tau_tc)
        return self._actuation.lowest(p.m_min, speed, shape) - 1.0, highest

    def _governor(
        self,
        flow: Flow,
        error: Formula,
        speed: Formula,
        lowest: Formula | None,
        highest: Formula,
        drawn: Number,
        p: Any,
    ) -> Formula:
        """Return the rack that the governor gives."""
        if lowest is None:
            integral = flow.state("governor integral")
            felt = error - p.droop * integral
            flow.rate(integral, p.K_i * felt + drawn)
            rack = p.K_p * felt + integral
        else:
            rack = limited_pi(
                flow,
                error,
                proportional=p.K_p,
                integral=p.K_i,
                lowest=self._actuation.rack(lowest, speed, p),
                highest=self._actuation.rack(highest, speed, p),
                anti_windup_s=p.T_aw,
                droop=p.droop,
                drawn=drawn,
            ).given
        return rate_limited(flow, rack, p.r_x, period_s=self._period_s) if "rate" in self._limits else rack


class LimitedLoop:
    """Equations of governor, engine and line with some limits, around any load."""

    def __init__(
        self,
        limits: tuple[str, ...],
        curve: tuple[tuple[float, float], ...],
        period_s: float,
        load: Load,
        actuation: Actuation = ENGINE,
    ) -> None:
        self._engine = LimitedEngine(limits, shape_of(curve), period_s, actuation)
        self._load = load

    def __call__(self, flow: Flow, demand: Formula, p: Any) -> Mapping[str, Formula]:
        """Return speed, torque at the gauge and rack, and what the load shows."""
        speed = flow.state("n")
        brake, rack = self._engine(flow, demand, speed, p)
        load, shown = self._load(flow, speed, p)
        acceleration = (brake - load) / (p.tau_dn + p.tau_up)
        flow.rate(speed, acceleration)
        return {"n": speed, "M_s": load + p.tau_dn * acceleration, "X": rack, **shown}
