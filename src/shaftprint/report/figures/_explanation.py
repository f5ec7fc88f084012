"""Governor and engine as the thesis sees them, and what the inertia upstream of the gauge makes of them."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.report.charts._chart import Chart, Panel, Scale
from shaftprint.report.charts._marks import Line, Mark, Points
from shaftprint.report.figures._traces import nearest_turn
from shaftprint.units import decibel

if TYPE_CHECKING:
    from shaftprint.report.thesis._explanation import Explanation


def missing_damping_chart(explanation: "Explanation") -> Chart:
    """Return ``M_s / e`` measured, of governor and engine alone, and with the inertia; below that ``|n / n_set|``.

    Where the upstream inertia is left out the model runs away from the points between 1 and 10 rad/s.
    """
    curves = explanation.curves
    at = np.array([step.omega_rad_s for step in explanation.lines])
    measured = np.array([step.measured for step in explanation.lines])
    models = {
        "governor and engine alone": curves.governor,
        "with the inertia upstream of the gauge": curves.governor * curves.inertia,
    }
    gain: list[Mark] = []
    phase: list[Mark] = []
    for shade, (name, values) in enumerate(models.items()):
        turned = np.degrees(np.unwrap(np.angle(values)))
        gain.append(Line(x=curves.omega_rad_s, y=decibel(np.abs(values)), name=name, shade=shade))
        phase.append(Line(x=curves.omega_rad_s, y=turned, name=name, shade=shade))
    measured_deg = nearest_turn(np.degrees(np.angle(measured)), np.interp(at, curves.omega_rad_s, turned))
    gain.append(Points(x=at, y=decibel(np.abs(measured)), name="measured"))
    phase.append(Points(x=at, y=measured_deg, name="measured"))
    closed = {"GAUGE-CLOSED": curves.speed_gauge_aware, "OL1+OL5": curves.speed_thesis}
    speed: list[Mark] = [Points(x=at, y=np.array([step.speed for step in explanation.lines]), name="measured")]
    speed += [Line(x=curves.omega_rad_s, y=y, name=name, shade=2 + i) for i, (name, y) in enumerate(closed.items())]
    frequency = Scale(title="frequency [rad/s]", log=True)
    return Chart(
        panels=(
            Panel(title="M_s / e, magnitude", marks=gain, x=frequency, y=Scale(title="magnitude [dB]")),
            Panel(title="M_s / e, phase", marks=phase, x=frequency, y=Scale(title="phase [deg]")),
            Panel(title="n / n_set, magnitude", marks=speed, x=frequency, y=Scale(title="|n / n_set| [-]")),
        ),
        heights_px=(220,),
    )
