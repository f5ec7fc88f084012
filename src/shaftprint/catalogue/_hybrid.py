"""The gauge-aware structure of a diesel with an electric machine on its gearbox: two inputs, two outputs.

The two free bodies of GAUGE-CLOSED, upstream of which a converter adds a torque that it controls::

    upstream    M_b + c_m M_m - M_s = tau_up s n        M_b = (1 - c_m s_m) (g n + v exp(-s t_d) F X)
    downstream  M_s - M_p = tau_dn s n                  M_p = k_q n,    X = C (c_set exp(-s t_sp) n_set - n)

``M_m`` is the torque that the converter shows, at the propeller shaft and over the whole torque of the working point;
``s_m`` is its value there, negative of a generator. ``g``, ``v``, ``K_p`` and ``K_i`` are normalised by the torque
that the engine itself gives, ``1 - c_m s_m`` of the whole.
"""

from collections.abc import Mapping
from dataclasses import replace

from shaftprint.arrays import FloatArray
from shaftprint.catalogue._gauge import (
    GAUGE_K_I,
    GAUGE_K_P,
    K_Q,
    TAU_DN,
    TAU_UP,
    G,
    diesel,
    rigid_load,
    set_point,
    speed_sensor,
    torque_sensor,
)
from shaftprint.catalogue._gauge_combinations import RESET_TIME, TOTAL_DELAY
from shaftprint.catalogue._roles import ShipRole
from shaftprint.models._blocks import Gain, PIGovernor
from shaftprint.models._combination import Combination
from shaftprint.models._expression import Sensitivity
from shaftprint.models._own_blocks import RationalBlock
from shaftprint.models._parameter import Parameter
from shaftprint.models._structure import Structure

SHARE = Parameter(
    "s_m",
    "-",
    -1.0,
    0.9,
    0.0,
    "torque of the electric machine as its converter shows it, over that of the shaft; negative where it generates",
    role=ShipRole.MACHINE_SHARE,
)
C_M = Parameter(
    "c_m",
    "-",
    0.85,
    1.15,
    1.0,
    "torque of the electric machine over that which its converter shows",
    role=ShipRole.MACHINE_SCALE,
)
OWN_K_P = replace(
    GAUGE_K_P,
    meaning="proportional gain of the governor, over the torque of the engine alone",
    role=ShipRole.OWN_PROPORTIONAL_GAIN,
)
OWN_K_I = replace(
    GAUGE_K_I,
    meaning="integral gain of the governor, over the torque of the engine alone",
    role=ShipRole.OWN_INTEGRAL_GAIN,
)


def gauge_hybrid() -> Structure:
    """Return the gauge-aware closed loop with an electric machine, ``n`` and ``M_s`` from ``n_set`` and ``M_m``.

    With ``Z = (tau_up + tau_dn) s + k_q - (1 - c_m s_m) g`` and ``L = (1 - c_m s_m) v C exp(-s t_d) F / Z`` it is
    ``n = sensor / (1 + L) (c_set exp(-s t_sp) L n_set + c_m / Z M_m)``, and
    ``M_s = (tau_dn s + k_q) exp(-s t_gauge) / (T_filter s + 1) n`` without the speed sensor. Where ``s_m`` is 0 and
    the machine stands still it is GAUGE-CLOSED.
    """
    shaft = RationalBlock(_shaft, (TAU_DN, TAU_UP, K_Q, G, C_M, SHARE))
    engine = RationalBlock(_of_engine, (C_M, SHARE)) * diesel()
    loop = PIGovernor(OWN_K_P, OWN_K_I) * engine * shaft
    left_of_error = Sensitivity(loop)
    moved = {"n_set": set_point() * loop * left_of_error, "M_m": Gain(C_M) * shaft * left_of_error}
    return Structure(
        name="GAUGE-HYBRID",
        title="gauge-aware closed loop with an electric machine on the gearbox",
        inputs=tuple(moved),
        outputs={
            "n": {name: speed * speed_sensor() for name, speed in moved.items()},
            "M_s": {name: speed * rigid_load() * torque_sensor() for name, speed in moved.items()},
        },
        combinations=_combinations(),
    )


def _shaft(
    tau_dn: FloatArray, tau_up: FloatArray, k_q: FloatArray, g: FloatArray, c_m: FloatArray, share: FloatArray
) -> tuple[list[FloatArray], list[FloatArray]]:
    """Return ``n`` over the torque upstream, ``1 / Z``."""
    return [1.0 + 0.0 * k_q], [tau_up + tau_dn, k_q - (1.0 - c_m * share) * g]


def _of_engine(c_m: FloatArray, share: FloatArray) -> tuple[list[FloatArray], list[FloatArray]]:
    """Return what of the torque the engine gives."""
    return [1.0 - c_m * share], [1.0 + 0.0 * c_m]


def _given(p: Mapping[str, FloatArray]) -> FloatArray:
    return 1.0 - p["c_m"] * p["s_m"]


def _combinations() -> tuple[Combination, ...]:
    """Return what a test of the closed loop finds better than the parameters it is made of."""
    return (
        Combination(name="1 - c_m s_m", unit="-", of=_given, meaning="torque of the engine over that of the shaft"),
        TOTAL_DELAY,
        RESET_TIME,
        Combination(
            name="K_p of the shaft",
            unit="-",
            of=lambda p: _given(p) * p["v"] * p["K_p"],
            meaning="proportional gain of governor and engine, over the torque of the shaft",
            role=ShipRole.PROPORTIONAL_GAIN,
        ),
        Combination(
            name="K_i of the shaft",
            unit="1/s",
            of=lambda p: _given(p) * p["v"] * p["K_i"],
            meaning="integral gain of both, over the torque of the shaft",
            role=ShipRole.INTEGRAL_GAIN,
        ),
        Combination(
            name="K_p of the shaft / (tau_up + tau_dn)",
            unit="1/s",
            of=lambda p: _given(p) * p["v"] * p["K_p"] / (p["tau_up"] + p["tau_dn"]),
            meaning="loop gain at high frequency",
            role=ShipRole.LOOP_GAIN,
        ),
    )
