"""A measured response with what a flexible model makes of it, and with the structure that does not explain it."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.distributions import NORMAL_95
from shaftprint.identify.uncertainty._band import DECIBEL_PER_NEPER
from shaftprint.report.charts._chart import Chart, Panel, Scale
from shaftprint.report.charts._marks import Band, Line, Points
from shaftprint.report.charts._text import over
from shaftprint.report.figures._bode import HEIGHTS_PX, frequency_scale
from shaftprint.report.figures._traces import nearest_turn
from shaftprint.report.figures._uncertainty import measured_points
from shaftprint.units import decibel

if TYPE_CHECKING:
    from shaftprint.identify.comparison._black_box import BlackBox

_WIDER = 1.2


def black_box_chart(found: "BlackBox") -> Chart:
    """Return magnitude and phase of each output: lines with 95 % intervals, flexible model with its band, structure."""
    above: list[Panel] = []
    below: list[Panel] = []
    response, omega = found.response, 2.0 * np.pi * found.frequency_hz
    span = frequency_scale((float(omega.min()) / _WIDER, float(omega.max()) * _WIDER))
    for at, output in enumerate(response.outputs):
        points = measured_points(response, at)
        model = _phase(found.model[at])
        near = np.interp(np.log(response.omega_rad_s), np.log(omega), model)
        rows = (
            (decibel(np.abs(found.model[at])), DECIBEL_PER_NEPER * found.magnitude_std[at],
             decibel(np.abs(found.structure_at_lines[at])), points.magnitude_db,
             (points.radial_std * DECIBEL_PER_NEPER * NORMAL_95, points.above_db)),
            (model, np.degrees(found.phase_std[at]), _near(found.structure_at_lines[at], near),
             _near(response.response[at, 0], near), (points.phase_half_deg, points.phase_half_deg)),
        )  # fmt: skip
        for panels, unit, (middle, std, structure, measured, bars) in zip(
            (above, below), ("magnitude [dB]", "phase [deg]"), rows, strict=True
        ):
            panels.append(
                Panel(
                    title=over(output, response.inputs[0]) if panels is above else "",
                    marks=[
                        Band(
                            x=omega, lower=middle - NORMAL_95 * std, upper=middle + NORMAL_95 * std,
                            name="flexible model, 95 % band", shade=0,
                        ),
                        Line(x=omega, y=middle, name="flexible model", shade=0),
                        Line(x=response.omega_rad_s, y=structure, name=found.structure, shade=1),
                        Points(
                            x=response.omega_rad_s, y=measured, name="data, 95 % interval", bars=bars,
                            words=response.lines,
                        ),
                    ],
                    x=span,
                    y=Scale(title=unit if at == 0 else ""),
                )
            )  # fmt: skip
    return Chart(panels=[*above, *below], columns=len(above), heights_px=HEIGHTS_PX, linked="all")


def _phase(values: ComplexArray) -> FloatArray:
    """Return a phase without jumps [deg]."""
    return np.asarray(np.degrees(np.unwrap(np.angle(values))))


def _near(values: ComplexArray, phase_deg: FloatArray) -> FloatArray:
    """Return the phases of values by whole turns nearest to others [deg]."""
    return nearest_turn(np.degrees(np.angle(values)), phase_deg)
