"""Why the thesis' way finds one ``K_i`` in all its structures, and a wrong one.

On slow lines the loop leaves an error ``e = n s (k_q - g) / (v K_i)``, and ``M_s = k_q n``. The error that is measured
is formed from set point and speed as the logger has them. The set point reaches the governor ``t_sp`` later, the
pick-up shows the speed ``t_pickup`` later than it is, and both add to it:

``e_seen = n s ((k_q - g) / (v K_i) + t_sp + t_pickup)``,  ``M_s / e_seen = K_seen / s``,
``K_seen = k_q / ((k_q - g) / (v K_i) + t_sp + t_pickup)``,

which is ``2 / (2 / K_i + t_sp + t_pickup)`` where ``k_q = 2``, ``g = 0`` and ``v = 1``. A set point that is off by a
share ``d`` of itself adds ``d n``, which is as large as the error itself on the slowest line: FitPercent falls, in all
structures alike.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from shaftprint.catalogue._roles import ShipRole
from shaftprint.digits import plain, rounded, with_deviation
from shaftprint.plain_table import Table, numbers, texts
from shaftprint.report.thesis._thesis_mode import GOVERNOR_FITS
from shaftprint.units import PERCENT

if TYPE_CHECKING:
    from shaftprint.identify.fit._identification import Identification
    from shaftprint.survey._thesis_mode import ThesisMode

MILLISECONDS = 1000.0


@dataclass(frozen=True, kw_only=True, slots=True)
class IntegralStep:
    """The integral gain that one structure finds the thesis' way, with the set point as it is and off."""

    structure: str
    """Name of the structure."""
    thesis: float
    """Integral gain [1/s]."""
    fit_percent: float
    """Its FitPercent [%]."""
    off: float
    """Integral gain with the set point off [1/s]."""
    off_fit_percent: float
    """Its FitPercent [%]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class IntegralGain:
    """The integral gain of the thesis' way, and what explains it."""

    steps: tuple[IntegralStep, ...]
    """Structure by structure."""
    gauge_aware: float
    """Integral gain of the gauge-aware structure [1/s]."""
    gauge_aware_std: float
    """Its standard deviation [1/s]."""
    set_point_late_s: float
    """Latency of the set point that the gauge-aware structure finds [s]."""
    pick_up_late_s: float
    """Delay of the speed in thesis mode [s]."""
    seen: float
    """What is to be seen of the gauge-aware gain behind both delays [1/s]."""
    slowest_line: str
    """Name of the slowest line."""
    slowest_error: float
    """Size of the error over that of the set point there [-]."""
    off_share: float
    """Share of itself by which the set point is off, where it is [-]."""


def integral_gain(thesis: "ThesisMode", gauge: "Identification") -> IntegralGain:
    """Return the integral gains of the thesis' way beside what the gauge-aware structure lets expect of them.

    ``thesis``: the recording treated the thesis' way, with OL2 to OL5, each also with the set point off. ``gauge``:
    weighted fit of GAUGE-CLOSED to shaftprint's response.
    """
    parameters, gain = gauge.by_role, gauge.of_role(ShipRole.INTEGRAL_GAIN)
    load, late = parameters[ShipRole.LOAD_SLOPE], parameters[ShipRole.SET_POINT_LATENCY]
    integral = parameters[ShipRole.ENGINE_RACK_SLOPE] * gain.value
    pick_up = thesis.spectra.response.pick_up_delay_s
    slowness = (load - parameters[ShipRole.ENGINE_SPEED_SLOPE]) / integral + late + pick_up
    response = thesis.spectra.response
    speed = response.response[response.outputs.index("n"), 0, 0]
    return IntegralGain(
        steps=tuple(_step(name, thesis) for name in GOVERNOR_FITS),
        gauge_aware=gain.value,
        gauge_aware_std=gain.std,
        set_point_late_s=late,
        pick_up_late_s=pick_up,
        seen=load / slowness,
        slowest_line=response.lines[0],
        slowest_error=float(abs(1.0 - speed)),
        off_share=thesis.off_share,
    )


def _step(name: str, thesis: "ThesisMode") -> IntegralStep:
    plain_fit, off = thesis.identifications[name], thesis.set_point_off[name]
    return IntegralStep(
        structure=name,
        thesis=plain_fit.of_role(ShipRole.INTEGRAL_GAIN).value,
        fit_percent=plain_fit.fit_percent["M_s"],
        off=off.of_role(ShipRole.INTEGRAL_GAIN).value,
        off_fit_percent=off.fit_percent["M_s"],
    )


def integral_gain_table(gain: IntegralGain) -> Table:
    """Return the integral gain structure by structure, with the set point as it is and off."""
    off = f"set point off by {plain(PERCENT * gain.off_share, 2)} %"
    return Table(
        title="The integral gain: the same in all structures, with a right set point and with one that is off",
        columns=(
            *texts("structure"),
            *numbers("K_i, the thesis' way", "FitPercent", f"K_i, {off}", f"FitPercent, {off}"),
        ),
        symbols=True,
        rows=tuple(
            (
                step.structure,
                rounded(step.thesis, 3),
                plain(step.fit_percent, 1),
                rounded(step.off, 3),
                plain(step.off_fit_percent, 1),
            )
            for step in gain.steps
        ),
        note=(
            f"GAUGE-CLOSED finds K_i = {with_deviation(gain.gauge_aware, gain.gauge_aware_std)} 1/s, of which "
            f"{rounded(gain.seen, 3)} 1/s are to be seen the thesis' way."
        ),
    )


def integral_gain_words(gain: IntegralGain) -> str:
    """Return in words why all structures find one integral gain, and why it is not that of the governor."""
    gains, off = [step.thesis for step in gain.steps], [step.off for step in gain.steps]
    percent, off_percent = [step.fit_percent for step in gain.steps], [step.off_fit_percent for step in gain.steps]
    set_point_ms, pick_up_ms = (
        plain(MILLISECONDS * delay, 0) for delay in (gain.set_point_late_s, gain.pick_up_late_s)
    )
    return (
        f"K_i is {_range(gains, 3)} in all four structures, since all read it off the slowest lines, and so all err "
        f"alike: the gauge-aware structure finds {with_deviation(gain.gauge_aware, gain.gauge_aware_std)}. The set "
        f"point reaches the governor {set_point_ms} ms late and the pick-up shows the speed {pick_up_ms} ms late. Both "
        "delays lie outside the loop and add to the error that is measured: "
        f"k_q / ((k_q - g) / (v K_i) + t_sp + t_pickup) = {rounded(gain.seen, 3)} is to be seen. FitPercent depends on "
        f"the set point: at {gain.slowest_line} the error is {plain(PERCENT * gain.slowest_error, 1)} % of it. With "
        f"the set point off by {plain(PERCENT * gain.off_share, 2)} % the same fits reach {_range(off_percent, 3)} % "
        f"instead of {_range(percent, 3)} %, with K_i of {_range(off, 3)}: that four values are alike does not prove "
        "them right."
    )


def _range(values: Sequence[float], digits: int) -> str:
    return f"{rounded(min(values), digits)} to {rounded(max(values), digits)}"
