"""Where the thesis' numbers come from: its structures and the gauge-aware one on the same recording, side by side.

Four things are explained, each by changing one step at a time:

- the inertia time, a factor of about three below that of the torsional vibration calculation;
- the damping that governor and engine seem to lack between 1 and 10 rad/s;
- the proportional gain that drifts from structure to structure while FitPercent stays;
- the integral gain that is the same in all structures, and still wrong, and the FitPercent of about 55 %.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.catalogue._gauge import gauge_governor, gauge_line
from shaftprint.catalogue._roles import ShipRole
from shaftprint.errors import IdentificationError
from shaftprint.models._role import Role
from shaftprint.models._structure import Structure
from shaftprint.report._curve import Curve, closed_loop_curve
from shaftprint.report.thesis._integral_gain import IntegralGain, integral_gain
from shaftprint.report.thesis._thesis_mode import GOVERNOR_FITS, calculated_inertia_time_s
from shaftprint.spectra._open_loop import open_loop

if TYPE_CHECKING:
    from shaftprint.identify.fit._identification import Identification
    from shaftprint.spectra._frequency_response import FrequencyResponse
    from shaftprint.survey._thesis_mode import ThesisMode
    from shaftprint.vessel._vessel import Vessel

GAUGE = "GAUGE-CLOSED"
CORE, CORE_WITH_SENSOR = "OL1", "GAUGE-CORE"
GOVERNORS = GOVERNOR_FITS
# Lines are shown where the upstream inertia turns the response, and a little beside.
SHOWN_RAD_S = (0.5, 12.0)
GRID = 200
NEEDED = (CORE, *GOVERNORS)


@dataclass(frozen=True, kw_only=True, slots=True)
class InertiaStep:
    """One inertia time on the way from the thesis' comparison to the right one."""

    what: str
    """Where it comes from."""
    value_s: float
    """Inertia time [s]."""
    std_s: float
    """Standard deviation [s]; not a number where it has none."""
    factor: float
    """Calculated inertia time upstream of the gauge over it [-]."""
    why: str
    """What changed against the step before."""


@dataclass(frozen=True, kw_only=True, slots=True)
class LineStep:
    """What governor and engine are made of at one line, and what comes of it in the closed loop."""

    line: str
    """Name of the line."""
    omega_rad_s: float
    """Its frequency [rad/s]."""
    measured: complex
    """Measured ``M_s / e``, ``e`` formed with the latency of the set point [-]."""
    governor: complex
    """``v C exp(-s t_d) F`` of the gauge-aware structure: governor and engine without any inertia [-]."""
    inertia: complex
    """``(tau_dn s + k_q) / ((tau_up + tau_dn) s + k_q - g)``: what the inertia upstream makes of it [-]."""
    speed: float
    """Measured ``|n / n_set|`` [-]."""
    speed_gauge_aware: float
    """The same of the gauge-aware structure [-]."""
    speed_thesis: float
    """The same of OL1 and OL5 of the thesis' way put into one loop [-]."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Damping:
    """What governor and engine are made of, and what comes of it in the closed loop, over frequency."""

    omega_rad_s: FloatArray
    """Frequencies [rad/s], shape (frequencies,)."""
    governor: ComplexArray
    """``v C exp(-s t_d) F`` of the gauge-aware structure [-]."""
    inertia: ComplexArray
    """``(tau_dn s + k_q) / ((tau_up + tau_dn) s + k_q - g)`` [-]."""
    speed_gauge_aware: FloatArray
    """``|n / n_set|`` of the gauge-aware structure [-]."""
    speed_thesis: FloatArray
    """The same of OL1 and OL5 of the thesis' way put into one loop [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class GainStep:
    """The proportional gain that one structure finds, each way of fitting."""

    structure: str
    """Name of the structure."""
    thesis: float
    """The thesis' way [-]."""
    thesis_fit_percent: float
    """FitPercent of the thesis' way [%]."""
    weighted: float
    """Weighted by the measured covariance, on shaftprint's response [-]."""
    weighted_std: float
    """Its standard deviation [-]."""
    p_value: float
    """Chance of data at least as far off, if the structure held; below 0.01 it is rejected."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Explanation:
    """Where the thesis' numbers come from on one recording."""

    inertia: tuple[InertiaStep, ...]
    """The inertia time, step by step."""
    lines: tuple[LineStep, ...]
    """Governor and engine line by line between 0.5 and 12 rad/s."""
    curves: Damping
    """The models of the lines on a fine grid."""
    gains: tuple[GainStep, ...]
    """The proportional gain, structure by structure; the gauge-aware one last."""
    seen_gain: float
    """``v K_p tau_dn / (tau_up + tau_dn)``: the gain above 10 rad/s that a structure without the inertia sees [-]."""
    share_of_two_lines: float
    """Share of the two slowest lines in the squares that FitPercent of ``M_s / e`` is made of [-]."""
    integral: IntegralGain
    """The integral gain, structure by structure."""


def explain_thesis(
    thesis: "ThesisMode",
    fits: "Mapping[str, Identification]",
    response: "FrequencyResponse",
    vessel: "Vessel",
) -> Explanation:
    """Return where the thesis' numbers come from on one recording.

    ``thesis``: the recording treated the thesis' way, with OL1 to OL5, GAUGE-CORE for the step that models the pick-up,
    and OL2 to OL5 with the set point off. ``fits``: weighted fits to shaftprint's responses by name: GAUGE-CLOSED, OL1
    to OL5. ``response``: shaftprint's response from ``n_set``. ``vessel``: what was tested. Raises IdentificationError
    if a fit is missing.
    """
    missing = _missing(thesis, fits)
    if missing:
        raise IdentificationError(f"explanation: expected {', '.join(missing)}; fit them too.")
    governor, _ = open_loop(thesis.spectra.response)
    squares = np.abs(governor.response[0, 0]) ** 2
    gauge = fits[GAUGE].by_role
    upstream, downstream = gauge[ShipRole.INERTIA_UPSTREAM], gauge[ShipRole.INERTIA_DOWNSTREAM]
    gain = gauge[ShipRole.ENGINE_RACK_SLOPE] * gauge[ShipRole.PROPORTIONAL_GAIN]
    return Explanation(
        inertia=_inertia_steps(thesis, fits, vessel),
        lines=_line_steps(thesis, fits[GAUGE], response),
        curves=_damping(thesis, fits[GAUGE], np.geomspace(*SHOWN_RAD_S, GRID)),
        gains=_gain_steps(thesis, fits),
        seen_gain=gain * downstream / (upstream + downstream),
        share_of_two_lines=float(squares[:2].sum() / squares.sum()),
        integral=integral_gain(thesis, fits[GAUGE]),
    )


def can_explain(thesis: "ThesisMode", fits: "Mapping[str, Identification]") -> bool:
    """Return whether all fits are there that an explanation needs."""
    return not _missing(thesis, fits)


def _missing(thesis: "ThesisMode", fits: "Mapping[str, Identification]") -> list[str]:
    unweighted = [
        f"{name} the thesis' way" for name in (*NEEDED, CORE_WITH_SENSOR) if name not in thesis.identifications
    ]
    off = [f"{name} with the set point off" for name in GOVERNORS if name not in thesis.set_point_off]
    return unweighted + off + [f"{name} weighted" for name in (*NEEDED, GAUGE) if name not in fits]


def _inertia_steps(
    thesis: "ThesisMode", fits: "Mapping[str, Identification]", vessel: "Vessel"
) -> tuple[InertiaStep, ...]:
    upstream = calculated_inertia_time_s(thesis, vessel)
    downstream = upstream * vessel.inertia_downstream_kg_m2 / vessel.inertia_upstream_kg_m2
    core, sensed = thesis.identifications[CORE], thesis.identifications[CORE_WITH_SENSOR]
    steps = (
        ("calculation, upstream of the gauge", upstream, np.nan, "the inertia that the thesis compares with"),
        ("calculation, downstream of the gauge", downstream, np.nan, "the inertia that n / M_s sees: it turns below"),
        ("OL1, the thesis' way", *_estimate(core, ShipRole.INERTIA), "the pick-up is late, which looks like inertia"),
        (
            "pick-up in the model, the thesis' signals",
            *_estimate(sensed, ShipRole.INERTIA_DOWNSTREAM),
            "its mean, hold and delay known",
        ),
        (
            "OL1, shaftprint's signals",
            *_estimate(fits[CORE], ShipRole.INERTIA),
            "speed without delay, weights, no alias",
        ),
        (
            "GAUGE-CLOSED",
            *_estimate(fits[GAUGE], ShipRole.INERTIA_DOWNSTREAM),
            "speed and torque together, k_q and g free",
        ),
    )
    return tuple(
        InertiaStep(what=what, value_s=value, std_s=std, factor=upstream / value, why=why)
        for what, value, std, why in steps
    )


def _estimate(fit: "Identification", role: Role) -> tuple[float, float]:
    estimate = fit.of_role(role)
    return estimate.value, estimate.std


def _line_steps(thesis: "ThesisMode", gauge: "Identification", response: "FrequencyResponse") -> tuple[LineStep, ...]:
    omega = response.omega_rad_s
    chosen = np.flatnonzero((omega >= SHOWN_RAD_S[0]) & (omega <= SHOWN_RAD_S[1]) & response.used)
    s = 1j * omega[chosen]
    gauge_latency, set_point_latency, scale = (
        gauge.by_role[role] for role in (ShipRole.TORQUE_LATENCY, ShipRole.SET_POINT_LATENCY, ShipRole.SET_POINT_SCALE)
    )
    speed, torque = (response.response[response.outputs.index(name), 0, chosen] for name in ("n", "M_s"))
    # e inside the ship: the governor has the set point later than the logger, and with its true scale
    measured = torque * np.exp(s * gauge_latency) / (scale * np.exp(-s * set_point_latency) - speed)
    curves = _damping(thesis, gauge, omega[chosen])
    return tuple(
        LineStep(
            line=response.lines[line],
            omega_rad_s=float(omega[line]),
            measured=complex(measured[i]),
            governor=complex(curves.governor[i]),
            inertia=complex(curves.inertia[i]),
            speed=float(abs(speed[i])),
            speed_gauge_aware=float(curves.speed_gauge_aware[i]),
            speed_thesis=float(curves.speed_thesis[i]),
        )
        for i, line in enumerate(chosen)
    )


def _damping(thesis: "ThesisMode", gauge: "Identification", omega: FloatArray) -> Damping:
    s = 1j * omega
    joined = closed_loop_curve(Curve.of(thesis.identifications[CORE]), Curve.of(thesis.identifications["OL5"]))
    models = (Curve.of(gauge), joined)
    speeds = [np.abs(m.structure.response(m.values, s)[list(m.structure.outputs).index("n")]) for m in models]
    return Damping(
        omega_rad_s=omega,
        governor=_part(gauge_governor(), gauge, omega),
        inertia=_part(gauge_line(), gauge, omega),
        speed_gauge_aware=speeds[0],
        speed_thesis=speeds[1],
    )


def _part(part: Structure, gauge: "Identification", omega: FloatArray) -> ComplexArray:
    """Return the response of a part of the gauge-aware structure with the values of its fit."""
    values = gauge.structure.named(gauge.values)
    return np.asarray(part.response([values[name] for name in part.names], 1j * omega)[0])


def _gain_steps(thesis: "ThesisMode", fits: "Mapping[str, Identification]") -> tuple[GainStep, ...]:
    steps = []
    for name in GOVERNORS:
        before = thesis.identifications[name]
        gain, std = _estimate(fits[name], ShipRole.PROPORTIONAL_GAIN)
        steps.append(
            GainStep(
                structure=name,
                thesis=before.of_role(ShipRole.PROPORTIONAL_GAIN).value,
                thesis_fit_percent=before.fit_percent["M_s"],
                weighted=gain,
                weighted_std=std,
                p_value=_p_value(fits[name]),
            )
        )
    gain, std = _estimate(fits[GAUGE], ShipRole.PROPORTIONAL_GAIN)
    gauge = GainStep(
        structure=GAUGE,
        thesis=np.nan,
        thesis_fit_percent=np.nan,
        weighted=gain,
        weighted_std=std,
        p_value=_p_value(fits[GAUGE]),
    )
    return (*steps, gauge)


def _p_value(fit: "Identification") -> float:
    return np.nan if fit.p_value is None else fit.p_value
