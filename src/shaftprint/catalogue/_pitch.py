"""The gauge-aware structures of a line with a controllable pitch at the quay: speed, torque and pitch.

GAUGE-PITCH has two inputs, the set points of speed and pitch. GAUGE-COMBINATOR has one, the lever that asks for both.

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

A combinator asks for a pitch with each speed, ``theta_set = c n_set`` of small changes; ``c_comb`` is ``c c_th``.
"""

from dataclasses import replace
from typing import NamedTuple

from shaftprint.catalogue._gauge import (
    C_SET,
    diesel,
    diesel_governor,
    rigid_load,
    rigid_shaft,
    set_point,
    speed_sensor,
    torque_sensor,
)
from shaftprint.catalogue._gauge_combinations import gauge_combinations
from shaftprint.catalogue._roles import ShipRole
from shaftprint.catalogue._sailing import TAU_TH, Q
from shaftprint.models._blocks import FirstOrderLag, Gain
from shaftprint.models._combination import Combination
from shaftprint.models._delays import Delay
from shaftprint.models._expression import Constant, Expression, Sensitivity
from shaftprint.models._parameter import Parameter
from shaftprint.models._structure import Structure

T_TH = Parameter(
    "t_th", "s", 0.0, 3.0, 0.2, "delay of the pitch behind its set point, beside its lag", role=ShipRole.PITCH_DELAY
)
C_TH = Parameter(
    "c_th", "-", 0.5, 2.0, 1.0, "change of pitch that is reached over that asked for", role=ShipRole.PITCH_SCALE
)
C_COMB = Parameter(
    "c_comb",
    "-",
    0.0,
    4.0,
    0.8,
    "change of pitch that is reached over the change of speed that is asked for",
    role=ShipRole.COMBINATOR_SLOPE,
)
# Slow lines, which else show the line of the set point, are disturbed by the pitch; the model finds its scale.
_C_SET_WIDE = replace(C_SET, lower=0.7, upper=1.4)
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
    rack = -(diesel_governor() * speed)
    return replace(part, name="PITCH-RACK", outputs={"n": speed, "M_s": torque, "X": rack})


def gauge_pitch() -> Structure:
    """Return the gauge-aware closed loop with a controllable pitch: ``n``, ``M_s`` and ``theta`` from both set points.

    From ``n_set`` it is GAUGE-CLOSED, and the pitch stands. From ``theta_set`` the governor works against the torque
    that the blades take: ``n = -q theta_b / ((tau_up + tau_dn) s + k_q - g) / (1 + L)`` and
    ``M_s = (tau_dn s + k_q) n + q theta_b``, and what is shown of the pitch is ``c_pitch theta``.
    """
    pitch = Gain(C_TH) * Delay(T_TH) * FirstOrderLag(TAU_TH)
    line = _line(pitch, C_SET)
    return Structure(
        name="GAUGE-PITCH",
        title="gauge-aware closed loop with a controllable pitch",
        inputs=("n_set", "theta_set"),
        outputs={
            "n": {"n_set": line.speed_by_set_point * _SPEED_SENSOR, "theta_set": line.speed_by_pitch * _SPEED_SENSOR},
            "M_s": {
                "n_set": line.speed_by_set_point * _LOAD * _TORQUE_SENSOR,
                "theta_set": (line.speed_by_pitch * _LOAD + line.forced) * _TORQUE_SENSOR,
            },
            "theta": {"n_set": Constant(0.0), "theta_set": Gain(C_PITCH) * pitch},
        },
        combinations=(
            *gauge_combinations(),
            _PITCH_LAG,
            Combination(
                name="q c_th",
                unit="-",
                of=lambda p: p["q"] * p["c_th"],
                meaning="change of torque over the change of pitch that is asked for",
                role=ShipRole.ASKED_PITCH_SLOPE,
            ),
        ),
    )


def gauge_combinator() -> Structure:
    """Return the gauge-aware closed loop whose lever asks for speed and pitch: ``n``, ``M_s`` and ``theta`` from it.

    The sum of what GAUGE-PITCH says of both its inputs, with ``c_comb`` in the place of ``c_th``.
    """
    # the pitch is asked for with the true set point
    pitch = Gain(_C_SET_WIDE) * Gain(C_COMB) * Delay(T_TH) * FirstOrderLag(TAU_TH)
    line = _line(pitch, _C_SET_WIDE)
    speed = line.speed_by_set_point + line.speed_by_pitch
    return Structure(
        name="GAUGE-COMBINATOR",
        title="gauge-aware closed loop with a combinator",
        input="n_set",
        outputs={
            "n": speed * _SPEED_SENSOR,
            "M_s": (speed * _LOAD + line.forced) * _TORQUE_SENSOR,
            "theta": Gain(C_PITCH) * pitch,
        },
        combinations=(
            *gauge_combinations(),
            _PITCH_LAG,
            Combination(
                name="q c_comb",
                unit="-",
                of=lambda p: p["q"] * p["c_comb"],
                meaning="change of torque by the pitch over the change of speed that is asked for",
                role=ShipRole.ASKED_PITCH_SLOPE,
            ),
        ),
    )


class _Line(NamedTuple):
    """What set point and pitch do to a governed line, without its sensors."""

    forced: Expression
    """Torque of the propeller by the pitch alone."""
    speed_by_set_point: Expression
    """Speed over the set point of the governor."""
    speed_by_pitch: Expression
    """Speed over what asks for the pitch."""


def _line(pitch: Expression, set_point_scale: Parameter) -> _Line:
    """Return the line of a pitch over what asks for it."""
    shaft = rigid_shaft()
    loop = diesel_governor() * diesel() * shaft
    left_of_error = Sensitivity(loop)
    forced = Gain(Q) * pitch * Delay(T_BLADE)
    return _Line(
        forced=forced,
        speed_by_set_point=loop * left_of_error * set_point(set_point_scale),
        speed_by_pitch=-(forced * shaft * left_of_error),
    )


_LOAD, _SPEED_SENSOR, _TORQUE_SENSOR = rigid_load(), speed_sensor(), torque_sensor()
_PITCH_LAG = Combination(
    name="t_th + tau_th",
    unit="s",
    of=lambda p: p["t_th"] + p["tau_th"],
    meaning="lag of the pitch behind its set point",
    role=ShipRole.PITCH_TOTAL,
)
