"""The gauge-aware structure of a line with a controllable pitch at the quay: two inputs, three outputs.

The two free bodies of GAUGE-CLOSED, and a propeller that takes more torque at more pitch::

    upstream    M_b - M_s = tau_up s n            M_b = g n + v exp(-s t_d) F X,   X = C (c_set exp(-s t_sp) n_set - n)
    downstream  M_s - M_p = tau_dn s n            M_p = k_q n + q theta_b
    piston      theta = c_th exp(-s t_th) / (tau_th s + 1) theta_set
    blades      theta_b = exp(-s t_blade) theta

``q`` is that of D. Stapersma and A. Vrijdag, Linearisation of a ship propulsion system model (Ocean Engineering 142,
2017, 441-457), at zero advance, where their ``b`` is 0. Neither shaft nor torque acts back on the pitch: the hydraulics
hold it.

Between piston and blades is play. Blades that stay half a play ``h`` behind whichever way the piston goes are, for a
motion of many lines, late by ``t_blade = sqrt(2 / pi) h / sigma`` at all of them, ``sigma`` the rms of the rate of the
piston (statistical linearisation: A. Gelb and W. E. Vander Velde, Multiple-input describing functions and nonlinear
system design, 1968, chapter 7). A feedback whose latency is other than stated shows in it too.
"""

from dataclasses import replace

from shaftprint.catalogue._gauge import (
    C_SET,
    GAUGE_K_I,
    GAUGE_K_P,
    GAUGE_OMEGA_N,
    GAUGE_ZETA,
    K_Q,
    T_AVERAGE,
    T_D,
    T_FILTER,
    T_GAUGE,
    T_HOLD,
    T_PICKUP,
    T_SP,
    TAU_DN,
    TAU_UP,
    V_ONE,
    G,
)
from shaftprint.catalogue._gauge_combinations import gauge_combinations
from shaftprint.catalogue._roles import ShipRole
from shaftprint.catalogue._sailing import TAU_TH, Q
from shaftprint.models import (
    AveragingSensor,
    Combination,
    Constant,
    Delay,
    FirstOrderLag,
    Gain,
    Parameter,
    PIGovernor,
    SecondOrderLag,
    Sensitivity,
    Shaft,
    Structure,
    TorqueBalance,
)

T_TH = Parameter(
    "t_th", "s", 0.0, 3.0, 0.2, "delay of the pitch behind its set point, beside its lag", role=ShipRole.PITCH_DELAY
)
C_TH = Parameter(
    "c_th", "-", 0.5, 2.0, 1.0, "change of pitch that is reached over that asked for", role=ShipRole.PITCH_SCALE
)
T_BLADE = Parameter(
    "t_blade",
    "s",
    -0.1,
    0.5,
    0.0,
    "time by which the blades follow what is shown of the pitch: play, and an error of the feedback's latency",
    role=ShipRole.BLADE_LATENESS,
)
C_PITCH = Parameter(
    "c_pitch", "-", 0.8, 1.25, 1.0, "change of pitch that is shown over that reached", role=ShipRole.PITCH_SENSOR_SCALE
)


def pitched_with_rack() -> Structure:
    """Return the part of GAUGE-PITCH behind the set point of the pitch, with the fuel rack ``X`` in place of the pitch.

    The governor works against what the pitch does to the speed: ``X = -C n``.
    """
    part = gauge_pitch().of_input("theta_set")
    paths = dict(zip([output for output, _ in part.channels], part.paths, strict=True))
    speed, torque = paths["n"], paths["M_s"]
    rack = -(PIGovernor(GAUGE_K_P, GAUGE_K_I) * speed)
    return replace(part, name="PITCH-RACK", outputs={"n": speed, "M_s": torque, "X": rack})


def gauge_pitch() -> Structure:
    """Return the gauge-aware closed loop with a controllable pitch: ``n``, ``M_s`` and ``theta`` from both set points.

    From ``n_set`` it is GAUGE-CLOSED, and the pitch stands. From ``theta_set`` the governor works against the torque
    that the blades take: ``n = -q theta_b / ((tau_up + tau_dn) s + k_q - g) / (1 + L)`` and
    ``M_s = (tau_dn s + k_q) n + q theta_b``, and what is shown of the pitch is ``c_pitch theta``.
    """
    shaft, load = Shaft((TAU_DN, TAU_UP), K_Q, G), TorqueBalance(TAU_DN, K_Q)
    drive = PIGovernor(GAUGE_K_P, GAUGE_K_I) * Gain(V_ONE) * Delay(T_D) * SecondOrderLag(GAUGE_OMEGA_N, GAUGE_ZETA)
    loop = drive * shaft
    left_of_error = Sensitivity(loop)
    pitch = Gain(C_TH) * Delay(T_TH) * FirstOrderLag(TAU_TH)
    forced = Gain(Q) * pitch * Delay(T_BLADE)
    by_set_point = loop * left_of_error * Delay(T_SP) * Gain(C_SET)
    by_pitch = -(forced * shaft * left_of_error)
    speed_sensor, torque_sensor = AveragingSensor(T_AVERAGE, T_HOLD, T_PICKUP), Delay(T_GAUGE) * FirstOrderLag(T_FILTER)
    return Structure(
        name="GAUGE-PITCH",
        title="gauge-aware closed loop with a controllable pitch",
        inputs=("n_set", "theta_set"),
        outputs={
            "n": {"n_set": by_set_point * speed_sensor, "theta_set": by_pitch * speed_sensor},
            "M_s": {
                "n_set": by_set_point * load * torque_sensor,
                "theta_set": (by_pitch * load + forced) * torque_sensor,
            },
            "theta": {"n_set": Constant(0.0), "theta_set": Gain(C_PITCH) * pitch},
        },
        combinations=(
            *gauge_combinations(),
            Combination(
                name="t_th + tau_th",
                unit="s",
                of=lambda p: p["t_th"] + p["tau_th"],
                meaning="lag of the pitch behind its set point",
            ),
            Combination(
                name="q c_th",
                unit="-",
                of=lambda p: p["q"] * p["c_th"],
                meaning="change of torque over the change of pitch that is asked for",
            ),
        ),
    )
