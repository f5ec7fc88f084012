"""The gauge-aware structures: they know where the torque gauge sits and what each sensor does to what it measures.

Two free bodies cut at the gauge::

    upstream    M_b - M_s = tau_up s n        M_b = g n + v exp(-s t_d) F X,   X = C (c_set exp(-s t_sp) n_set - n)
    downstream  M_s - M_p = tau_dn s n        M_p = k_q n

Where a coupling ahead of the gauge twists, there are three; ``n_1`` is the speed of the engine, which the governor
feels::

    engine      M_b - T = (tau_up - tau_m) s n_1        T = (k_c / s + d_c) (n_1 - n)
    between     T - M_s = tau_m s n

With ``tau_up = 0`` and no latencies they are those of the thesis.
"""

from shaftprint.catalogue._elastic import coupling_mode, engine_end, shaft_end
from shaftprint.catalogue._gauge_combinations import gauge_combinations, motor_combinations
from shaftprint.catalogue._roles import ShipRole
from shaftprint.models._blocks import FirstOrderLag, Gain, PIGovernor, SecondOrderLag
from shaftprint.models._combination import Combination
from shaftprint.models._delays import AveragingSensor, Delay
from shaftprint.models._expression import Expression, Inverse, Sensitivity
from shaftprint.models._own_blocks import RationalBlock
from shaftprint.models._parameter import Parameter
from shaftprint.models._shaft_blocks import DynamicInflow, EntrainedWater, Inertia, Shaft, TorqueBalance
from shaftprint.models._structure import Structure

T_D = Parameter(
    "t_d", "s", 0.0, 0.5, 0.1, "delay inside the loop: governor, injection, combustion", role=ShipRole.LOOP_DELAY
)
TAU_DN = Parameter(
    "tau_dn", "s", 0.0, 2.0, 0.3, "inertia time downstream of the torque gauge", role=ShipRole.INERTIA_DOWNSTREAM
)
TAU_UP = Parameter(
    "tau_up", "s", 0.0, 5.0, 1.0, "inertia time upstream of the torque gauge", role=ShipRole.INERTIA_UPSTREAM
)
K_Q = Parameter(
    "k_q",
    "-",
    1.0,
    3.0,
    2.0,
    "slope of the propeller torque; 2 if gauge and inflow are right",
    role=ShipRole.LOAD_SLOPE,
)
G = Parameter("g", "-", -3.0, 0.9, 0.0, "slope of the engine torque with speed", role=ShipRole.ENGINE_SPEED_SLOPE)
V_ONE = Parameter(
    "v", "-", 0.0, 5.0, 1.0, "slope of the engine torque with fuel rack", held=True, role=ShipRole.ENGINE_RACK_SLOPE
)
GAUGE_K_P = Parameter("K_p", "-", 0.0, 20.0, 5.0, "proportional gain of the governor", role=ShipRole.PROPORTIONAL_GAIN)
GAUGE_K_I = Parameter("K_i", "1/s", 0.0, 20.0, 4.0, "integral gain of the governor", role=ShipRole.INTEGRAL_GAIN)
GAUGE_OMEGA_N = Parameter(
    "omega_n", "rad/s", 3.0, 60.0, 10.0, "natural frequency of the actuation lag", role=ShipRole.ACTUATOR_FREQUENCY
)
GAUGE_ZETA = Parameter("zeta", "-", 0.1, 4.0, 0.5, "damping ratio of the actuation lag", role=ShipRole.ACTUATOR_DAMPING)
T_SP = Parameter(
    "t_sp", "s", 0.0, 0.5, 0.05, "latency of the set point, outside the loop", role=ShipRole.SET_POINT_LATENCY
)
C_SET = Parameter("c_set", "-", 0.95, 1.05, 1.0, "scale error of the measured set point", role=ShipRole.SET_POINT_SCALE)
T_GAUGE = Parameter(
    "t_gauge", "s", -0.02, 0.02, 0.0, "error of the known latency of the torque telemetry", role=ShipRole.TORQUE_LATENCY
)
T_AVERAGE = Parameter(
    "T_average", "s", 0.0, 1.0, 0.0, "window of the pick-up's mean", held=True, role=ShipRole.PICK_UP_AVERAGE
)
T_HOLD = Parameter(
    "T_hold", "s", 0.0, 1.0, 0.0, "time for which a pick-up value is held", held=True, role=ShipRole.PICK_UP_HOLD
)
T_PICKUP = Parameter(
    "t_pickup", "s", 0.0, 1.0, 0.0, "delay of the pick-up's value", held=True, role=ShipRole.PICK_UP_DELAY
)

T_FILTER = Parameter("T_filter", "s", 0.0, 0.5, 0.0, "time constant of the torque telemetry's low-pass", held=True)
V = Parameter("v", "-", 0.0, 5.0, 1.0, "slope of the engine torque with fuel rack", role=ShipRole.ENGINE_RACK_SLOPE)
T_RACK = Parameter(
    "t_rack", "s", -0.1, 0.1, 0.0, "error of the known latency of the rack channel", role=ShipRole.RACK_LATENCY
)
MOTOR_K_P = Parameter(
    "K_p", "-", 0.0, 20.0, 5.0, "proportional gain of the speed controller", role=ShipRole.PROPORTIONAL_GAIN
)
MOTOR_K_I = Parameter(
    "K_i", "1/s", 0.0, 20.0, 4.0, "integral gain of the speed controller", role=ShipRole.INTEGRAL_GAIN
)
T_CONVERTER = Parameter(
    "t_d", "s", 0.0, 0.5, 0.02, "dead time of controller and converter, inside the loop", role=ShipRole.LOOP_DELAY
)
T_M = Parameter(
    "T_m", "s", 0.0, 0.5, 0.05, "time constant of the motor's torque, current loop closed", role=ShipRole.TORQUE_TIME
)
K_C = Parameter(
    "k_c",
    "1/s",
    20.0,
    20000.0,
    1000.0,
    "stiffness of the coupling over the torque of the working point",
    role=ShipRole.COUPLING_STIFFNESS,
)
D_C = Parameter("d_c", "-", 0.0, 50.0, 2.0, "damping of the coupling", role=ShipRole.COUPLING_DAMPING)
TAU_M = Parameter(
    "tau_m",
    "s",
    0.0,
    5.0,
    0.0,
    "inertia time between coupling and torque gauge, a part of tau_up",
    held=True,
    role=ShipRole.INERTIA_DRIVEN,
)
TAU_W = Parameter("tau_w", "s", 0.0, 1.0, 0.0, "inertia time of the entrained water, where tau_dn is dry", held=True)
KAPPA = Parameter(
    "kappa",
    "-",
    0.0,
    3.0,
    1.0,
    "slope of the propeller torque with the speed of the slipstream",
    role=ShipRole.INFLOW_SLOPE,
)
TAU_I = Parameter("tau_i", "s", 0.02, 1.0, 0.12, "time in which the slipstream follows the propeller")


def gauge_core() -> Structure:
    """Return the gauge-aware core propulsion: only what is downstream.

    ``n / M_s = sensor exp(s t_gauge) (T_filter s + 1) / (tau_dn s + k_q)``.
    """
    core = Shaft((TAU_DN,), K_Q) * Inverse(torque_sensor()) * speed_sensor()
    return Structure(name="GAUGE-CORE", title="gauge-aware core propulsion", input="M_s", outputs={"n": core})


def gauge_open() -> Structure:
    """Return the gauge-aware governor and engine, ``M_s / e`` with ``e = n_set - n`` as it is measured.

    ``M_s / e = v C exp(-s t_d) F (tau_dn s + k_q) / ((tau_up + tau_dn) s + k_q - g)`` inside the ship; the latency
    of the set point and the pick-up enter through ``e``, so the measured ratio is
    ``(M_s / n_set) / (1 - n / n_set)``.
    """
    speed, torque, _ = _measured(rigid_shaft(), rigid_load(), diesel_governor(), diesel())
    error = 1.0 - speed
    return Structure(
        name="GAUGE-OPEN",
        title="gauge-aware governor and engine",
        input="e",
        outputs={"M_s": torque * Inverse(error)},
        combinations=gauge_combinations(),
    )


def gauge_closed() -> Structure:
    """Return the gauge-aware closed loop, ``n`` and ``M_s`` from ``n_set``.

    ``n = c_set sensor exp(-s t_sp) L / (1 + L)`` with ``L = v C exp(-s t_d) F / ((tau_up + tau_dn) s + k_q - g)``, and
    ``M_s = (tau_dn s + k_q) exp(-s t_gauge) / (T_filter s + 1) n`` without the speed sensor.
    """
    speed, torque, _ = _measured(rigid_shaft(), rigid_load(), diesel_governor(), diesel())
    return Structure(
        name="GAUGE-CLOSED",
        title="gauge-aware closed loop",
        input="n_set",
        outputs={"n": speed, "M_s": torque},
        combinations=gauge_combinations(),
    )


def gauge_inflow() -> Structure:
    """Return the gauge-aware closed loop with entrained water and dynamic inflow.

    ``M_p = (tau_w s + k_q + kappa tau_i s / (tau_i s + 1)) n``: the slipstream follows the propeller late, so that a
    fast change of speed meets more torque than a slow one. ``tau_dn`` holds the water too while ``tau_w`` is held at 0.
    """
    load = rigid_load() + EntrainedWater(TAU_W) + DynamicInflow(KAPPA, TAU_I)
    shaft = Inverse(load + Inertia(TAU_UP) - Gain(G))
    speed, torque, _ = _measured(shaft, load, diesel_governor(), diesel())
    return Structure(
        name="GAUGE-INFLOW",
        title="gauge-aware closed loop with dynamic inflow",
        input="n_set",
        outputs={"n": speed, "M_s": torque},
        combinations=gauge_combinations(),
    )


def gauge_ecu() -> Structure:
    """Return the gauge-aware closed loop with the fuel rack logged: ``n``, ``M_s`` and ``X`` from ``n_set``.

    ``X = C exp(-s t_rack) / (1 + L) c_set exp(-s t_sp)``: it shows the governor without the engine, so that ``v`` is
    found.
    """
    speed, torque, rack = _measured(rigid_shaft(), rigid_load(), diesel_governor(), diesel(V))
    return Structure(
        name="GAUGE-ECU",
        title="gauge-aware closed loop with the fuel rack logged",
        input="n_set",
        outputs={"n": speed, "M_s": torque, "X": rack},
        combinations=(
            *gauge_combinations(),
            Combination(
                name="v / (tau_up + tau_dn)",
                unit="1/s",
                of=lambda p: p["v"] / (p["tau_up"] + p["tau_dn"]),
                meaning="acceleration of the line for one unit of rack",
            ),
        ),
    )


def governor() -> Structure:
    """Return the governor alone, ``X`` from ``n_set`` and ``n``.

    ``X = C exp(-s t_rack) (c_set exp(-s t_sp) n_set - n)``: the set point reaches it late, the speed does not. Engine
    and line are not in it; a fit takes the speed that was measured.
    """
    rack = diesel_governor() * Delay(T_RACK)
    return Structure(
        name="GOVERNOR",
        title="governor alone, fuel rack logged",
        inputs=("n_set", "n"),
        outputs={"X": {"n_set": rack * set_point(), "n": -rack}},
    )


def engine() -> Structure:
    """Return engine and line without the governor, ``n`` and ``M_s`` from ``X``.

    ``n = v exp(-s (t_d - t_rack)) F / ((tau_up + tau_dn) s + k_q - g) X``: no feedback is in it, and no set point.
    """
    drive = diesel(V) * Inverse(Delay(T_RACK))
    speed = drive * rigid_shaft()
    return Structure(
        name="ENGINE",
        title="engine and line, fuel rack logged",
        input="X",
        outputs={"n": speed * speed_sensor(), "M_s": speed * rigid_load() * torque_sensor()},
    )


def gauge_motor() -> Structure:
    """Return the gauge-aware closed loop of an electric motor, ``n`` and ``M_s`` from ``n_set``.

    That of a diesel with ``L = C exp(-s t_d) / (T_m s + 1) / ((tau_up + tau_dn) s + k_q)``: the converter controls the
    torque, which therefore neither falls nor rises with the speed, and follows in a lag of first order (A. J. Sorensen
    and O. N. Smogeli, "Torque and power control of electrically driven marine propellers", Control Engineering Practice
    17, 2009).
    """
    speed, torque, _ = _measured(Shaft((TAU_DN, TAU_UP), K_Q), rigid_load(), PIGovernor(MOTOR_K_P, MOTOR_K_I), _motor())
    return Structure(
        name="GAUGE-MOTOR",
        title="gauge-aware closed loop of an electric motor",
        input="n_set",
        outputs={"n": speed, "M_s": torque},
        combinations=motor_combinations(),
    )


def gauge_elastic() -> Structure:
    """Return the gauge-aware closed loop with an elastic coupling ahead of the gauge, the pick-up behind it.

    ``n_1 / M_b = 1 / ((tau_up - tau_m) s - g + Z n / n_1)`` and ``n / n_1 = 1 / (1 + Z s / (d_c s + k_c))`` with
    ``Z = (tau_m + tau_dn) s + k_q``. The governor feels the speed of the engine, ``L = v C exp(-s t_d) F n_1 / M_b``,
    the pick-up that of the shaft, ``n = c_set sensor exp(-s t_sp) L / (1 + L) n / n_1``. Where ``k_c`` has no end it is
    GAUGE-CLOSED; ``tau_m`` is held at 0, where the gauge shows what the coupling carries.
    """
    return _elastic("GAUGE-ELASTIC", on_engine=False)


def gauge_elastic_engine() -> Structure:
    """Return the same with the pick-up ahead of the coupling, where it shows the engine.

    ``n = c_set sensor exp(-s t_sp) L / (1 + L)`` with ``L`` of GAUGE-ELASTIC, for it is the speed that the governor
    feels; ``M_s = (tau_dn s + k_q) exp(-s t_gauge) / (T_filter s + 1) n / n_1`` of it without the speed sensor.
    """
    return _elastic("GAUGE-ELASTIC-ENGINE", on_engine=True)


def _elastic(name: str, *, on_engine: bool) -> Structure:
    """Return the elastic line with the speed of the engine or that of the shaft measured."""
    end = RationalBlock(engine_end, (TAU_UP, TAU_M, TAU_DN, K_Q, G, K_C, D_C))
    follows = RationalBlock(shaft_end, (TAU_M, TAU_DN, K_Q, K_C, D_C))
    engine, _ = _speed_and_rack(end, diesel_governor(), diesel())
    shaft = engine * follows
    shown, where = (engine, ", pick-up on the engine") if on_engine else (shaft, "")
    return Structure(
        name=name,
        title=f"gauge-aware closed loop with an elastic coupling{where}",
        input="n_set",
        outputs={"n": shown * speed_sensor(), "M_s": shaft * rigid_load() * torque_sensor()},
        combinations=(*gauge_combinations(), coupling_mode()),
    )


def gauge_governor() -> Structure:
    """Return governor and engine of the gauge-aware closed loop, ``M_b / e = v C exp(-s t_d) F`` without inertia."""
    return Structure(
        name="GAUGE-GOVERNOR",
        title="governor and engine of the gauge-aware closed loop",
        input="e",
        outputs={"M_b": diesel_governor() * diesel()},
    )


def gauge_line() -> Structure:
    """Return what the inertia upstream makes of the engine's torque at the gauge, ``M_s / M_b``.

    ``M_s / M_b = (tau_dn s + k_q) / ((tau_up + tau_dn) s + k_q - g)``.
    """
    return Structure(
        name="GAUGE-LINE",
        title="line of the gauge-aware closed loop",
        input="M_b",
        outputs={"M_s": rigid_shaft() * rigid_load()},
    )


def diesel_governor() -> Expression:
    """Return ``X / e`` of a diesel's governor."""
    return PIGovernor(GAUGE_K_P, GAUGE_K_I)


def diesel(v: Parameter = V_ONE) -> Expression:
    """Return ``M_b / X`` of a diesel, without the slope of its torque with speed."""
    return Gain(v) * Delay(T_D) * SecondOrderLag(GAUGE_OMEGA_N, GAUGE_ZETA)


def _motor() -> Expression:
    """Return ``M_b / M_ref`` of a motor whose torque a converter controls."""
    return Delay(T_CONVERTER) * FirstOrderLag(T_M)


def rigid_shaft() -> Expression:
    """Return ``n / M_b`` of one rigid body."""
    return Shaft((TAU_DN, TAU_UP), K_Q, G)


def rigid_load() -> Expression:
    """Return ``M_s / n`` of the body downstream of the gauge."""
    return TorqueBalance(TAU_DN, K_Q)


def set_point(scale: Parameter = C_SET) -> Expression:
    """Return what the set point makes of that which was recorded: its latency and its scale."""
    return Delay(T_SP) * Gain(scale)


def speed_sensor() -> Expression:
    """Return what the pick-up shows of the speed."""
    return AveragingSensor(T_AVERAGE, T_HOLD, T_PICKUP)


def torque_sensor() -> Expression:
    """Return what the telemetry shows of the torque at the gauge."""
    return Delay(T_GAUGE) * FirstOrderLag(T_FILTER)


def _measured(
    shaft: Expression, load: Expression, rack: Expression, drive: Expression
) -> tuple[Expression, Expression, Expression]:
    """Return ``n``, ``M_s`` and ``X`` from ``n_set`` as measured.

    It is that of ``n / M_b`` and ``M_s / n`` of a line, ``X / e`` of its governor and ``M_b / X`` of what drives it.
    """
    speed, given = _speed_and_rack(shaft, rack, drive)
    return speed * speed_sensor(), speed * load * torque_sensor(), given * Delay(T_RACK)


def _speed_and_rack(shaft: Expression, rack: Expression, drive: Expression) -> tuple[Expression, Expression]:
    """Return the speed that the governor feels and the rack that it gives, from ``n_set``, before any sensor."""
    loop = rack * drive * shaft
    left_of_error = Sensitivity(loop)
    asked = set_point()
    return loop * left_of_error * asked, rack * left_of_error * asked
