"""What a recording shows of its sensors, as quantities to be followed over the years."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.identify.fit._estimate import Estimate
from shaftprint.units import rpm_from_rev_s

if TYPE_CHECKING:
    from shaftprint.signals._signals import SetPointCalibration, Signals, StripAngles

DEGREES_PER_REVOLUTION = 360.0


def calibration_quantities(signals: "Signals", *, machine: str) -> tuple[Estimate, ...]:
    """Return the set-point line, its scale at low frequency and the angles of the strips, with standard deviations.

    ``signals``: what was measured. ``machine``: what drives the line, in words: engine or motor.
    """
    scale = Estimate(
        name="set-point scale",
        unit="-",
        value=signals.dc_scale,
        std=signals.dc_scale_std,
        meaning="factor on the set point that lets the speed follow it exactly at low frequency",
    )
    strips = (quantity for angles in signals.strips for quantity in _strip_quantities(angles))
    return (*_line_quantities(signals.calibration, machine), scale, *strips)


def _line_quantities(line: "SetPointCalibration", machine: str) -> tuple[Estimate, Estimate]:
    slope_std, intercept_std = np.sqrt(np.diag(line.covariance)).tolist()
    return (
        Estimate(
            name="set-point slope",
            unit="rpm/V",
            value=rpm_from_rev_s(line.slope_rev_s_per_v),
            std=rpm_from_rev_s(slope_std),
            meaning=f"{machine} speed for one volt of set point, from the steady levels",
        ),
        Estimate(
            name="set-point intercept",
            unit="rpm",
            value=rpm_from_rev_s(line.intercept_rev_s),
            std=rpm_from_rev_s(intercept_std),
            meaning=f"{machine} speed of that line at no voltage",
        ),
    )


def _strip_quantities(strips: "StripAngles") -> list[Estimate]:
    if strips.are_many:
        return [
            Estimate(
                name=f"{strips.channel} largest error of a tooth",
                unit="deg",
                value=DEGREES_PER_REVOLUTION * float(strips.error_rev[strips.worst]),
                std=DEGREES_PER_REVOLUTION * float(strips.std_rev[strips.worst]),
                meaning="angle to the next tooth beyond that of a wheel without errors",
            )
        ]
    pairs = zip(strips.angle_rev.tolist(), strips.std_rev.tolist(), strict=True)
    return [
        Estimate(
            name=f"{strips.channel} strip {number}",
            unit="deg",
            value=DEGREES_PER_REVOLUTION * angle,
            std=DEGREES_PER_REVOLUTION * std,
            meaning="angle to the next strip",
        )
        for number, (angle, std) in enumerate(pairs, start=1)
    ]
