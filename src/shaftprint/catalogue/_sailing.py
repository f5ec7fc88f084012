"""The structures of a ship that sails free, with the torque gauge where it sits.

Downstream of the gauge stands the propeller, which feels the speed of the ship::

    M_s = (tau_dn s + 2 - b) n + b v,     v = (2 - a) n / (tau_u s + e - a)

with the torque of the propeller times ``k_q / 2`` where the zero of the gauge is off. At the quay, where ``a = b = 0``,
they are the gauge-aware structures.
"""

from shaftprint.catalogue._gauge import (
    K_Q,
    TAU_DN,
    TAU_UP,
    G,
    diesel,
    diesel_governor,
    set_point,
    speed_sensor,
    torque_sensor,
)
from shaftprint.catalogue._gauge_combinations import RESET_TIME, TOTAL_DELAY
from shaftprint.catalogue._roles import ShipRole
from shaftprint.catalogue._sailing_blocks import PitchSpeed, SailingShaft, SailingSpeed, SailingTorque
from shaftprint.models._blocks import FirstOrderLag, Gain
from shaftprint.models._combination import Combination
from shaftprint.models._delays import Delay
from shaftprint.models._expression import Expression, Inverse, Sensitivity
from shaftprint.models._parameter import Parameter
from shaftprint.models._shaft_blocks import Inertia
from shaftprint.models._structure import Structure

K_Q_HELD = K_Q.held_at(2.0)
A = Parameter("a", "-", -6.0, 0.0, -1.0, "slope of the thrust coefficient, d ln K_T / d ln J")
B = Parameter("b", "-", -3.0, 0.0, -0.45, "slope of the torque coefficient, d ln K_Q / d ln J")
E = Parameter("e", "-", 1.0, 8.0, 3.0, "slope of the resistance, d ln R / d ln v")
TAU_U = Parameter("tau_u", "s", 0.5, 200.0, 8.0, "time of the ship, m v / R")
SIGMA = Parameter("sigma", "-", 0.0, 1.0, 1.0, "share of the thrust whose shafts follow the set point", held=True)
P = Parameter("p", "-", 0.0, 6.0, 2.4, "slope of the thrust coefficient with pitch, d ln K_T / d ln theta")
Q = Parameter(
    "q",
    "-",
    0.0,
    6.0,
    2.7,
    "slope of the torque coefficient with pitch, d ln K_Q / d ln theta",
    role=ShipRole.PITCH_SLOPE,
)
TAU_TH = Parameter("tau_th", "s", 0.0, 10.0, 1.0, "lag of the pitch actuator", role=ShipRole.PITCH_LAG)
T_LOG = Parameter(
    "t_log",
    "s",
    -2.0,
    2.0,
    0.0,
    "error of the known latency of the speed log",
    held=True,
    role=ShipRole.LOG_LATENCY,
)

# what a closed loop tells better than its delays and gains, on any water
_OF_THE_LOOP = (TOTAL_DELAY, RESET_TIME)


def free_core() -> Structure:
    """Return the core propulsion of a free-sailing ship: ``n`` from ``M_s``.

    ``n / M_s = (tau_u s + e - a) / [(tau_dn s + 2 - b)(tau_u s + e - a) + sigma b (2 - a)]`` with the sensors. Vrijdag
    and Stapersma (Ocean Engineering 143, 2017, 50-65) write it with the whole inertia; the gauge sees what comes
    after it.
    """
    core = SailingShaft((TAU_DN,), _torque()) * Inverse(torque_sensor()) * speed_sensor()
    return Structure(
        name="FREE-CORE",
        title="core propulsion of a free-sailing ship",
        input="M_s",
        outputs={"n": core},
        combinations=_combinations(),
    )


def free_ship() -> Structure:
    """Return core propulsion and ship: ``n`` and ``v_s`` from ``M_s``.

    ``v_s / n = sigma (2 - a) exp(-s t_log) / (tau_u s + e - a)`` in addition to what FREE-CORE shows.
    """
    core = SailingShaft((TAU_DN,), _torque()) * Inverse(torque_sensor())
    return Structure(
        name="FREE-SHIP",
        title="core propulsion of a free-sailing ship with its speed logged",
        input="M_s",
        outputs={"n": core * speed_sensor(), "v_s": core * SailingSpeed(A, E, TAU_U, SIGMA) * Delay(T_LOG)},
        combinations=(*_combinations(), *_ship_combinations()),
    )


def free_closed() -> Structure:
    """Return the closed loop of a free-sailing ship: ``n`` and ``M_s`` from ``n_set``."""
    speed, torque, _, _ = _governed()
    return Structure(
        name="FREE-CLOSED",
        title="closed loop of a free-sailing ship",
        input="n_set",
        outputs={"n": speed * speed_sensor(), "M_s": torque * torque_sensor()},
        combinations=(*_OF_THE_LOOP, *_combinations()),
    )


def free_log() -> Structure:
    """Return the closed loop of a free-sailing ship with its speed logged: ``n``, ``M_s`` and ``v_s`` from ``n_set``.

    ``v_s / n = sigma (2 - a) exp(-s t_log) / (tau_u s + e - a)`` in addition to what FREE-CLOSED shows.
    """
    speed, torque, ship, _ = _governed()
    return Structure(
        name="FREE-LOG",
        title="closed loop of a free-sailing ship with its speed logged",
        input="n_set",
        outputs={"n": speed * speed_sensor(), "M_s": torque * torque_sensor(), "v_s": ship * Delay(T_LOG)},
        combinations=(*_OF_THE_LOOP, *_combinations(), *_ship_combinations()),
    )


def sailing_with_rack() -> Structure:
    """Return FREE-CLOSED with the fuel rack ``X`` that the governor asks for: for what a test asks of the engine."""
    speed, torque, _, rack = _governed()
    return Structure(
        name="FREE-RACK",
        title="closed loop of a free-sailing ship with its fuel rack",
        input="n_set",
        outputs={"n": speed * speed_sensor(), "M_s": torque * torque_sensor(), "X": rack},
        combinations=(*_OF_THE_LOOP, *_combinations()),
    )


def free_pitch() -> Structure:
    """Return a governed ship with controllable pitch: ``n``, ``M_s`` and ``v_s`` from ``n_set`` and ``theta_set``.

    Pitch follows its set point with ``1 / (tau_th s + 1)`` and turns the propeller's torque by
    ``q + sigma b p / (tau_u s + e - a)`` at constant shaft speed, against which the governor works. ``p`` and ``q`` are
    slopes of the propeller's curves with pitch (Stapersma and Vrijdag, Ocean Engineering 142, 2017, 441-457). How fast
    the actuator can go at most is no property of small signals.
    """
    load = Inertia(TAU_DN) + _torque()
    shaft = SailingShaft((TAU_DN, TAU_UP), _torque(), G)
    loop = diesel_governor() * diesel() * shaft
    left_of_error = Sensitivity(loop)
    pitch = FirstOrderLag(TAU_TH)
    pitch_ship = PitchSpeed(P, A, E, TAU_U, SIGMA)
    pitch_torque = 0.5 * Gain(K_Q_HELD) * (Gain(Q) + Gain(B) * pitch_ship)
    by_set_point = loop * left_of_error * set_point()
    by_pitch = -(pitch * pitch_torque * shaft * left_of_error)
    ship = SailingSpeed(A, E, TAU_U, SIGMA)
    return Structure(
        name="FREE-PITCH",
        title="closed loop of a free-sailing ship with controllable pitch",
        inputs=("n_set", "theta_set"),
        outputs={
            "n": {"n_set": by_set_point * speed_sensor(), "theta_set": by_pitch * speed_sensor()},
            "M_s": {
                "n_set": by_set_point * load * torque_sensor(),
                "theta_set": (by_pitch * load + pitch * pitch_torque) * torque_sensor(),
            },
            "v_s": {
                "n_set": by_set_point * ship * Delay(T_LOG),
                "theta_set": (by_pitch * ship + pitch * pitch_ship) * Delay(T_LOG),
            },
        },
        combinations=(
            *_OF_THE_LOOP,
            *_combinations(),
            *_ship_combinations(),
            Combination(
                name="p / tau_u",
                unit="1/s",
                of=lambda p: p["p"] / p["tau_u"],
                meaning="acceleration of the ship for one unit of pitch",
            ),
        ),
    )


def _governed() -> tuple[Expression, Expression, Expression, Expression]:
    """Return ``n``, ``M_s``, the speed of the ship and the rack from ``n_set``, without sensors."""
    loop = diesel_governor() * diesel() * SailingShaft((TAU_DN, TAU_UP), _torque(), G)
    error = Sensitivity(loop) * set_point()
    speed = loop * error
    ship = speed * SailingSpeed(A, E, TAU_U, SIGMA)
    return speed, speed * (Inertia(TAU_DN) + _torque()), ship, diesel_governor() * error


def _torque() -> SailingTorque:
    return SailingTorque(K_Q_HELD, A, B, E, TAU_U, SIGMA)


def _combinations() -> tuple[Combination, ...]:
    """Return what torque and speed of the shaft show of the ship: a corner, and how far the gain falls below it."""
    return (
        Combination(
            name="(e - a) / tau_u",
            unit="1/s",
            of=lambda p: (p["e"] - p["a"]) / p["tau_u"],
            meaning="rate at which the ship's speed settles at constant shaft speed",
        ),
        Combination(
            name="b (2 - a) / tau_u",
            unit="1/s",
            of=lambda p: p["b"] * (2.0 - p["a"]) / p["tau_u"],
            meaning="how strongly the ship's speed acts back on the torque",
        ),
    )


def _ship_combinations() -> tuple[Combination, ...]:
    """Return what a speed log adds."""
    return (
        Combination(
            name="(2 - a) / tau_u",
            unit="1/s",
            of=lambda p: (2.0 - p["a"]) / p["tau_u"],
            meaning="acceleration of the ship for one unit of shaft speed",
        ),
    )
