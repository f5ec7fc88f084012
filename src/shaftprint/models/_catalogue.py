"""The shipped structures: those of the thesis, and the gauge-aware ones that know where the torque gauge sits.

Every structure is a few lines that read like the block diagrams of the thesis (figures 3.6 and 4.1). Default bounds are
those of thesis table 5.1; for the initial linear model and the benchmark those of eqs 2.36-2.40.
"""

from collections.abc import Callable, Mapping

from shaftprint.errors import StructureError
from shaftprint.models._blocks import (
    Constant,
    FilteredDerivative,
    Gain,
    Integrator,
    PIGovernor,
    SecondOrderLag,
    Shaft,
    TorqueBalance,
)
from shaftprint.models._combination import Combination
from shaftprint.models._delays import Delay, PadeDelay, SpeedSensor
from shaftprint.models._expression import Expression, Inverse, Sensitivity
from shaftprint.models._parameter import Parameter
from shaftprint.models._structure import Structure

TAU_N = Parameter("tau_n", "s", 0.0, 5.0, 0.39, "inertia time of the line, 2 pi I n_s0 / M_s0")
K_P = Parameter("K_p", "-", 0.0, 10.0, 3.0, "proportional gain of the governor")
K_I = Parameter("K_i", "1/s", 0.0, 10.0, 4.0, "integral gain of the governor")
T_D = Parameter("t_d", "s", 0.0, 0.5, 0.1, "delay inside the loop: governor, injection, combustion")
OMEGA_N = Parameter("omega_n", "rad/s", 7.0, 13.0, 10.0, "natural frequency of the actuation lag")
ZETA = Parameter("zeta", "-", 0.3, 4.0, 0.5, "damping ratio of the actuation lag")
K_Q_TWO = Parameter("k_q", "-", 1.0, 3.0, 2.0, "slope of the propeller torque, d ln M / d ln n", held=True)

PID_K_P = Parameter("K_p", "-", 0.0, 15.0, 10.0, "proportional gain of the governor")
PID_K_I = Parameter("K_i", "1/s", 0.0, 10.0, 3.0, "integral gain of the governor")
PID_K_D = Parameter("K_d", "s", 0.0, 5.0, 1.0, "derivative gain of the governor")
PID_T_F = Parameter("T_f", "s", 0.0, 0.05, 0.01, "filter time of the derivative")

FIRST_TAU_N = Parameter("tau_n", "s", 0.0, 5.0, 1.2, "inertia time of the line, 2 pi I n_s0 / M_s0")
FIRST_K_P = Parameter("K_p", "-", 0.0, 15.0, 10.0, "proportional gain of the governor")
FIRST_K_I = Parameter("K_i", "1/s", 0.0, 10.0, 3.0, "integral gain of the governor")
FIRST_G = Parameter("g", "-", -3.0, 0.0, -0.5, "slope of the engine torque with speed")
FIRST_V = Parameter("v", "-", 0.0, 5.0, 1.0, "slope of the engine torque with fuel rack")

TAU_DN = Parameter("tau_dn", "s", 0.0, 2.0, 0.3, "inertia time downstream of the torque gauge")
TAU_UP = Parameter("tau_up", "s", 0.0, 5.0, 1.0, "inertia time upstream of the torque gauge")
K_Q = Parameter("k_q", "-", 1.0, 3.0, 2.0, "slope of the propeller torque; 2 if gauge and inflow are right")
G = Parameter("g", "-", -3.0, 0.9, 0.0, "slope of the engine torque with speed")
V_ONE = Parameter("v", "-", 0.0, 5.0, 1.0, "slope of the engine torque with fuel rack", held=True)
GAUGE_K_P = Parameter("K_p", "-", 0.0, 20.0, 5.0, "proportional gain of the governor")
GAUGE_K_I = Parameter("K_i", "1/s", 0.0, 20.0, 4.0, "integral gain of the governor")
GAUGE_OMEGA_N = Parameter("omega_n", "rad/s", 3.0, 60.0, 10.0, "natural frequency of the actuation lag")
GAUGE_ZETA = Parameter("zeta", "-", 0.1, 4.0, 0.5, "damping ratio of the actuation lag")
T_SP = Parameter("t_sp", "s", 0.0, 0.5, 0.05, "latency of the set point, outside the loop")
C_SET = Parameter("c_set", "-", 0.95, 1.05, 1.0, "scale error of the measured set point")
T_GAUGE = Parameter("t_gauge", "s", -0.02, 0.02, 0.0, "error of the known latency of the torque telemetry")
T_AVERAGE = Parameter("T_average", "s", 0.0, 1.0, 0.0, "window of the pick-up's mean", held=True)
T_HOLD = Parameter("T_hold", "s", 0.0, 1.0, 0.0, "time for which a pick-up value is held", held=True)
T_PICKUP = Parameter("t_pickup", "s", 0.0, 1.0, 0.0, "delay of the pick-up's value", held=True)


def _core(tau: Parameter = TAU_N) -> Expression:
    """Return ``n / M_s`` (thesis eq. 4.2)."""
    return Shaft((tau,), K_Q_TWO)


def _open(name: str, title: str, engine: Expression) -> Structure:
    return Structure(name=name, title=title, input="e", outputs={"M_s": engine})


def _closed(name: str, title: str, engine: Expression) -> Structure:
    """Return the closed loop of thesis eqs 4.25-4.27 around the engine's ``M_s / e``."""
    core = _core()
    torque = engine * Sensitivity(engine * core)
    return Structure(name=name, title=title, input="n_set", outputs={"n": core * torque, "M_s": torque})


def ol1() -> Structure:
    """Return OL1: core propulsion, ``n / M_s`` (thesis eq. 4.2)."""
    return Structure(name="OL1", title="core propulsion", input="M_s", outputs={"n": _core()})


def ol2() -> Structure:
    """Return OL2: governor and engine, ``M_s / e`` (thesis eq. 4.12)."""
    return _open("OL2", "PI governor", PIGovernor(K_P, K_I))


def ol3() -> Structure:
    """Return OL3: governor and engine with delay (thesis eq. 4.21)."""
    return _open("OL3", "PI governor, delay", PIGovernor(K_P, K_I) * Delay(T_D))


def ol4() -> Structure:
    """Return OL4: governor and engine with second-order lag (thesis eq. 4.23, with ``2 zeta omega_n s``)."""
    return _open("OL4", "PI governor, second-order lag", PIGovernor(K_P, K_I) * SecondOrderLag(OMEGA_N, ZETA))


def ol5() -> Structure:
    """Return OL5: governor and engine with delay and second-order lag."""
    engine = PIGovernor(K_P, K_I) * Delay(T_D) * SecondOrderLag(OMEGA_N, ZETA)
    return _open("OL5", "PI governor, delay, second-order lag", engine)


def ol_pid() -> Structure:
    """Return the PID variant of governor and engine (thesis eqs 4.18-4.19)."""
    governor = PIGovernor(PID_K_P, PID_K_I) + FilteredDerivative(PID_K_D, PID_T_F)
    return _open("OL-PID", "PID governor", governor)


def cl1() -> Structure:
    """Return CL1: closed loop of PI governor and core propulsion (thesis eqs D.1, D.3)."""
    return _closed("CL1", "closed loop, PI governor", PIGovernor(K_P, K_I))


def cl3() -> Structure:
    """Return CL3: closed loop with second-order lag."""
    engine = PIGovernor(K_P, K_I) * SecondOrderLag(OMEGA_N, ZETA)
    return _closed("CL3", "closed loop, PI governor, second-order lag", engine)


def cl4() -> Structure:
    """Return CL4: closed loop with second-order lag and the exact delay inside the loop (thesis eq. 4.27)."""
    engine = PIGovernor(K_P, K_I) * Delay(T_D) * SecondOrderLag(OMEGA_N, ZETA)
    return _closed("CL4", "closed loop, PI governor, delay, second-order lag", engine)


def cl4_pade5() -> Structure:
    """Return CL4 with the fifth-order Pade approximation that the thesis had to use; to compare only."""
    engine = PIGovernor(K_P, K_I) * PadeDelay(T_D) * SecondOrderLag(OMEGA_N, ZETA)
    return _closed("CL4-PADE5", "CL4 with a fifth-order Pade approximation of the delay", engine)


def initial() -> Structure:
    """Return the initial linear model, ``n``, ``E_n`` and ``M_s`` from ``n_set`` (thesis eqs 2.26-2.28)."""
    return _five_parameters("INITIAL", "initial linear model of five parameters", integrated_error=True)


def benchmark() -> Structure:
    """Return the benchmark's structure: the initial linear model with the outputs ``n`` and ``M_s`` (eqs 2.31-2.33)."""
    return _five_parameters("BENCHMARK", "benchmark of five parameters", integrated_error=False)


def _five_parameters(name: str, title: str, *, integrated_error: bool) -> Structure:
    governed = PIGovernor(FIRST_K_P, FIRST_K_I) * Gain(FIRST_V)
    loop = governed * Shaft((FIRST_TAU_N,), K_Q_TWO, FIRST_G)
    sensitivity = Sensitivity(loop)
    speed = loop * sensitivity
    outputs = {"n": speed}
    if integrated_error:
        outputs["E_n"] = sensitivity * Integrator()
    outputs["M_s"] = speed * TorqueBalance(FIRST_TAU_N, K_Q_TWO)
    return Structure(
        name=name,
        title=title,
        input="n_set",
        outputs=outputs,
        combinations=(
            Combination(name="K_p / K_i", unit="s", of=lambda p: p["K_p"] / p["K_i"], meaning="reset time"),
            Combination(
                name="v K_p",
                unit="-",
                of=lambda p: p["v"] * p["K_p"],
                meaning="gain of governor and engine",
            ),
            Combination(
                name="v K_i",
                unit="1/s",
                of=lambda p: p["v"] * p["K_i"],
                meaning="integral gain of both",
            ),
        ),
    )


def gauge_core() -> Structure:
    """Return the gauge-aware core propulsion: only what is downstream.

    ``n / M_s = sensor exp(s t_gauge) / (tau_dn s + k_q)``.
    """
    core = Shaft((TAU_DN,), K_Q) * Inverse(Delay(T_GAUGE)) * SpeedSensor(T_AVERAGE, T_HOLD, T_PICKUP)
    return Structure(name="GAUGE-CORE", title="gauge-aware core propulsion", input="M_s", outputs={"n": core})


def gauge_open() -> Structure:
    """Return the gauge-aware governor and engine, ``M_s / e`` with ``e = n_set - n`` as it is measured.

    ``M_s / e = v C exp(-s t_d) F (tau_dn s + k_q) / ((tau_up + tau_dn) s + k_q - g)`` inside the ship; the latency
    of the set point and the pick-up enter through ``e``, so the measured ratio is
    ``(M_s / n_set) / (1 - n / n_set)``.
    """
    speed, torque = _gauge_outputs()
    error = Constant(1.0) + Constant(-1.0) * speed
    return Structure(
        name="GAUGE-OPEN",
        title="gauge-aware governor and engine",
        input="e",
        outputs={"M_s": torque * Inverse(error)},
        combinations=_gauge_combinations(),
    )


def gauge_closed() -> Structure:
    """Return the gauge-aware closed loop, ``n`` and ``M_s`` from ``n_set``.

    ``n = c_set sensor exp(-s t_sp) L / (1 + L)`` with ``L = v C exp(-s t_d) F / ((tau_up + tau_dn) s + k_q - g)``, and
    ``M_s = (tau_dn s + k_q) exp(-s t_gauge) n`` without the sensor.
    """
    speed, torque = _gauge_outputs()
    return Structure(
        name="GAUGE-CLOSED",
        title="gauge-aware closed loop",
        input="n_set",
        outputs={"n": speed, "M_s": torque},
        combinations=_gauge_combinations(),
    )


def _gauge_outputs() -> tuple[Expression, Expression]:
    governor = PIGovernor(GAUGE_K_P, GAUGE_K_I) * Gain(V_ONE)
    engine = Delay(T_D) * SecondOrderLag(GAUGE_OMEGA_N, GAUGE_ZETA)
    loop = governor * engine * Shaft((TAU_DN, TAU_UP), K_Q, G)
    speed = loop * Sensitivity(loop) * Delay(T_SP) * Gain(C_SET)
    torque = speed * TorqueBalance(TAU_DN, K_Q) * Delay(T_GAUGE)
    return speed * SpeedSensor(T_AVERAGE, T_HOLD, T_PICKUP), torque


def _gauge_combinations() -> tuple[Combination, ...]:
    return (
        Combination(name="t_d + t_sp", unit="s", of=lambda p: p["t_d"] + p["t_sp"], meaning="total delay"),
        Combination(
            name="K_p / K_i",
            unit="s",
            of=lambda p: p["K_p"] / p["K_i"],
            meaning="reset time of the governor",
        ),
        Combination(
            name="v K_i / (k_q - g)",
            unit="1/s",
            of=lambda p: p["v"] * p["K_i"] / (p["k_q"] - p["g"]),
            meaning="integral gain over the slope of load and engine",
        ),
        Combination(
            name="v K_p / (tau_up + tau_dn)",
            unit="1/s",
            of=lambda p: p["v"] * p["K_p"] / (p["tau_up"] + p["tau_dn"]),
            meaning="loop gain at high frequency",
        ),
    )


STRUCTURES: Mapping[str, Callable[[], Structure]] = {
    "OL1": ol1,
    "OL2": ol2,
    "OL3": ol3,
    "OL4": ol4,
    "OL5": ol5,
    "OL-PID": ol_pid,
    "CL1": cl1,
    "CL3": cl3,
    "CL4": cl4,
    "CL4-PADE5": cl4_pade5,
    "INITIAL": initial,
    "BENCHMARK": benchmark,
    "GAUGE-CORE": gauge_core,
    "GAUGE-OPEN": gauge_open,
    "GAUGE-CLOSED": gauge_closed,
}


def structure(name: str) -> Structure:
    """Return a shipped structure by its name, in capitals or not.

    Raises
    ------
    StructureError
        If there is none of that name.
    """
    try:
        return STRUCTURES[name.upper()]()
    except KeyError:
        raise StructureError(f"there is no structure {name!r}; the shipped ones are {', '.join(STRUCTURES)}.") from None
