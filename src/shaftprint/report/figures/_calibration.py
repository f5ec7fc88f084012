"""Calibration of the sensors: the line of the set point and the angles between the strips of a pick-up."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.distributions import NORMAL_95
from shaftprint.report.charts._chart import Chart, Panel, Scale
from shaftprint.report.charts._marks import Band, Bars, Line, Mark, Points, Straight
from shaftprint.units import SECONDS_PER_MINUTE

if TYPE_CHECKING:
    from shaftprint.arrays import FloatArray
    from shaftprint.signals._signals import SetPointCalibration, StripAngles
    from shaftprint.vessel._vessel import Vessel

BEYOND_V = 0.3
DEGREES_PER_REV = 360.0


def calibration_chart(calibration: "SetPointCalibration") -> Chart:
    """Return the set-point line with its levels, and the residuals: what figure 3.1 of the thesis shows.

    Intervals and band are 95 %, the band from the covariance of slope and intercept.
    """
    volts = np.linspace(calibration.level_v.min() - BEYOND_V, calibration.level_v.max() + BEYOND_V, 100)
    base = np.stack([volts, np.ones_like(volts)])
    slope, intercept = SECONDS_PER_MINUTE * np.array([calibration.slope_rev_s_per_v, calibration.intercept_rev_s])
    variance = np.einsum("iv,ij,jv->v", base, calibration.covariance, base)
    half = NORMAL_95 * SECONDS_PER_MINUTE * np.sqrt(np.maximum(variance, 0.0))
    levels = SECONDS_PER_MINUTE * calibration.level_rev_s
    bars = NORMAL_95 * SECONDS_PER_MINUTE * calibration.level_std_rev_s
    at_levels = slope * calibration.level_v + intercept
    text = f"n = {slope:.6g} rpm/V · U {'+' if intercept >= 0.0 else '−'} {abs(intercept):.1f} rpm".replace("-", "−")

    def measured(values: "FloatArray") -> Points:
        return Points(x=calibration.level_v, y=values, bars=(bars, bars), name="steady levels, 95 % interval")

    line: list[Mark] = [Line(x=volts, y=slope * volts + intercept, name=text), measured(levels)]
    residuals: list[Mark] = [
        Band(x=volts, lower=-half, upper=half, name="95 % band of line"),
        Straight(at=0.0, axis="y", shade=0, dash="solid"),
        measured(levels - at_levels),
    ]
    voltage = Scale(title="set-point voltage U [V]")
    return Chart(
        panels=(
            Panel(title="line through the steady levels", marks=line, x=voltage, y=Scale(title="engine speed n [rpm]")),
            Panel(title="residuals", marks=residuals, x=voltage, y=Scale(title="level minus line [rpm]")),
        ),
        columns=2,
        heights_px=(300,),
    )


def strip_chart(strips: "tuple[StripAngles, ...]", vessel: "Vessel | None" = None) -> Chart:
    """Return how far each strip angle is from an even spacing, with 95 % intervals (values of table 3.4).

    Parameters
    ----------
    strips
        Angles of the multi-pulse channels, as found in the recording.
    vessel
        Gives the angles that were found earlier, for comparison.

    Raises
    ------
    ValueError
        If no channel has more than one strip.
    """
    several = [strip for strip in strips if strip.angle_rev.size > 1]
    if not several:
        raise ValueError("strip angles: expected a channel of more than one pulse a revolution, found none.")
    panels = [_strip_panel(strip, vessel) for strip in several]
    return Chart(panels=panels, columns=len(panels), heights_px=(260,), linked="none")


def _strip_panel(strip: "StripAngles", vessel: "Vessel | None") -> Panel:
    count = strip.angle_rev.size
    places, even = np.arange(count, dtype=np.float64), DEGREES_PER_REV / count
    measured = DEGREES_PER_REV * strip.error_rev
    bars = NORMAL_95 * DEGREES_PER_REV * strip.std_rev
    marks: list[Mark] = [
        Bars(places=places, lengths=measured, starts=np.zeros(count), shade=4, width=0.5),
        Straight(at=0.0, axis="y", shade="ink", dash="solid"),
        Points(x=places, y=measured, bars=(bars, bars), size=5.0, name="found in this recording, 95 % interval"),
    ]
    earlier = _earlier_deg(strip, vessel)
    if earlier is not None:
        marks.append(Points(x=places, y=earlier - even, marker="diamond", filled=False, name="vessel file"))
    return Panel(
        title=f"channel {strip.channel}",
        marks=marks,
        x=Scale(title="strip, angle to the next [-]", names=[str(number + 1) for number in range(count)]),
        y=Scale(title=f"angle minus {even:g}° [deg]" if strip.nominal_rev is None else "error of the angle [deg]"),
    )


def _earlier_deg(strip: "StripAngles", vessel: "Vessel | None") -> "FloatArray | None":
    if vessel is None:
        return None
    for sensor in vessel.sensors.speed:
        if sensor.channel == strip.channel and sensor.strip_angles_deg is not None:
            angles = np.array(sensor.strip_angles_deg)
            return _turned(angles * (DEGREES_PER_REV / angles.sum()), DEGREES_PER_REV * strip.angle_rev)
    return None


def _turned(earlier: "FloatArray", identified_deg: "FloatArray") -> "FloatArray":
    """Return the earlier angles from the strip on that was counted first now, which no recording shows."""
    if earlier.size != identified_deg.size:
        return earlier
    turns = [np.roll(earlier, shift) for shift in range(earlier.size)]
    return min(turns, key=lambda angles: float(np.abs(angles - identified_deg).max()))
