"""The shipped structures: those of the thesis are written here, the gauge-aware ones in their own files.

Every structure is a few lines that read like the block diagrams of the thesis (figures 3.6 and 4.1). Default bounds are
those of thesis table 5.1; for the initial linear model and the benchmark those of eqs 2.36-2.40.
"""

from collections.abc import Callable, Mapping

from shaftprint.catalogue._gauge import (
    T_D,
    engine,
    gauge_closed,
    gauge_core,
    gauge_ecu,
    gauge_elastic,
    gauge_elastic_engine,
    gauge_inflow,
    gauge_motor,
    gauge_open,
    governor,
)
from shaftprint.catalogue._hybrid import gauge_hybrid
from shaftprint.catalogue._pitch import gauge_combinator, gauge_pitch
from shaftprint.catalogue._roles import ShipRole
from shaftprint.catalogue._sailing import free_closed, free_core, free_log, free_pitch, free_ship
from shaftprint.errors import StructureError
from shaftprint.models._blocks import FilteredDerivative, Gain, Integrator, PIGovernor, SecondOrderLag
from shaftprint.models._combination import Combination
from shaftprint.models._delays import Delay, PadeDelay
from shaftprint.models._expression import Expression, Sensitivity
from shaftprint.models._parameter import Parameter
from shaftprint.models._shaft_blocks import Shaft, TorqueBalance
from shaftprint.models._structure import Structure
from shaftprint.spelling import meant

TAU_N = Parameter("tau_n", "s", 0.0, 5.0, 0.39, "inertia time of the line, 2 pi I n_s0 / M_s0", role=ShipRole.INERTIA)
K_P = Parameter("K_p", "-", 0.0, 10.0, 3.0, "proportional gain of the governor", role=ShipRole.PROPORTIONAL_GAIN)
K_I = Parameter("K_i", "1/s", 0.0, 10.0, 4.0, "integral gain of the governor", role=ShipRole.INTEGRAL_GAIN)
OMEGA_N = Parameter(
    "omega_n", "rad/s", 7.0, 13.0, 10.0, "natural frequency of the actuation lag", role=ShipRole.ACTUATOR_FREQUENCY
)
ZETA = Parameter("zeta", "-", 0.3, 4.0, 0.5, "damping ratio of the actuation lag", role=ShipRole.ACTUATOR_DAMPING)
K_Q_TWO = Parameter(
    "k_q", "-", 1.0, 3.0, 2.0, "slope of the propeller torque, d ln M / d ln n", held=True, role=ShipRole.LOAD_SLOPE
)

PID_K_P = Parameter("K_p", "-", 0.0, 15.0, 10.0, "proportional gain of the governor", role=ShipRole.PROPORTIONAL_GAIN)
PID_K_I = Parameter("K_i", "1/s", 0.0, 10.0, 3.0, "integral gain of the governor", role=ShipRole.INTEGRAL_GAIN)
PID_K_D = Parameter("K_d", "s", 0.0, 5.0, 1.0, "derivative gain of the governor", role=ShipRole.DERIVATIVE_GAIN)
PID_T_F = Parameter("T_f", "s", 0.0, 0.05, 0.01, "filter time of the derivative")

FIRST_TAU_N = Parameter(
    "tau_n", "s", 0.0, 5.0, 1.2, "inertia time of the line, 2 pi I n_s0 / M_s0", role=ShipRole.INERTIA
)
FIRST_K_P = Parameter("K_p", "-", 0.0, 15.0, 10.0, "proportional gain of the governor", role=ShipRole.PROPORTIONAL_GAIN)
FIRST_K_I = Parameter("K_i", "1/s", 0.0, 10.0, 3.0, "integral gain of the governor", role=ShipRole.INTEGRAL_GAIN)
FIRST_G = Parameter(
    "g", "-", -3.0, 0.0, -0.5, "slope of the engine torque with speed", role=ShipRole.ENGINE_SPEED_SLOPE
)
FIRST_V = Parameter(
    "v", "-", 0.0, 5.0, 1.0, "slope of the engine torque with fuel rack", role=ShipRole.ENGINE_RACK_SLOPE
)


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
            Combination(
                name="K_p / K_i",
                unit="s",
                of=lambda p: p["K_p"] / p["K_i"],
                meaning="reset time",
                role=ShipRole.LOOP_GAIN,
            ),
            Combination(
                name="v K_p",
                unit="-",
                of=lambda p: p["v"] * p["K_p"],
                meaning="gain of governor and engine",
                role=ShipRole.PROPORTIONAL_GAIN,
            ),
            Combination(
                name="v K_i",
                unit="1/s",
                of=lambda p: p["v"] * p["K_i"],
                meaning="integral gain of both",
                role=ShipRole.INTEGRAL_GAIN,
            ),
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
    "GAUGE-INFLOW": gauge_inflow,
    "GAUGE-ELASTIC": gauge_elastic,
    "GAUGE-ELASTIC-ENGINE": gauge_elastic_engine,
    "GAUGE-ECU": gauge_ecu,
    "GAUGE-MOTOR": gauge_motor,
    "GAUGE-HYBRID": gauge_hybrid,
    "GAUGE-PITCH": gauge_pitch,
    "GAUGE-COMBINATOR": gauge_combinator,
    "GOVERNOR": governor,
    "ENGINE": engine,
    "FREE-CORE": free_core,
    "FREE-SHIP": free_ship,
    "FREE-CLOSED": free_closed,
    "FREE-LOG": free_log,
    "FREE-PITCH": free_pitch,
}
"""Functions that make the shipped structures, by the name that ``identify --structure`` takes."""


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
        raise StructureError(
            f"there is no structure {name!r}; the shipped ones are {', '.join(STRUCTURES)}.{meant(name, STRUCTURES)}"
        ) from None
