"""Governor and engine as the thesis sees them, and what the inertia upstream of the gauge makes of them."""

from typing import TYPE_CHECKING, Any

import numpy as np

from shaftprint.report.figures._style import (
    house_style,
    legend_below,
    legend_entries,
    letter_panels,
    look,
    new_figure,
    plain_log_axis,
)
from shaftprint.units import decibel

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from shaftprint.report.thesis import Explanation


def plot_missing_damping(explanation: "Explanation") -> "Figure":
    """Return ``M_s / e`` measured, of governor and engine alone, and with the inertia; below that ``|n / n_set|``.

    Where the upstream inertia is left out the model runs away from the points between 1 and 10 rad/s.
    """
    curves = explanation.curves
    at = np.array([step.omega_rad_s for step in explanation.lines])
    measured = np.array([step.measured for step in explanation.lines])
    with house_style():
        figure = new_figure(16.0)
        gain, phase, speed = figure.subplots(3, 1, sharex=True)
        models = {
            "governor and engine alone": curves.governor,
            "with the inertia upstream of the gauge": curves.governor * curves.inertia,
        }
        for index, (label, values) in enumerate(models.items()):
            drawn: dict[str, Any] = {"color": look(index).colour, "linestyle": look(index).dashes}
            turned = np.degrees(np.unwrap(np.angle(values)))
            gain.plot(curves.omega_rad_s, decibel(np.abs(values)), label=label, **drawn)
            phase.plot(curves.omega_rad_s, turned, **drawn)
        measured_deg = np.degrees(np.angle(measured))
        measured_deg += 360.0 * np.round((np.interp(at, curves.omega_rad_s, turned) - measured_deg) / 360.0)
        gain.plot(at, decibel(np.abs(measured)), "ko", markersize=4.0, label="measured")
        phase.plot(at, measured_deg, "ko", markersize=4.0)
        speed.plot(at, [step.speed for step in explanation.lines], "ko", markersize=4.0)
        closed = {"GAUGE-CLOSED": curves.speed_gauge_aware, "OL1+OL5": curves.speed_thesis}
        for index, (label, peak) in enumerate(closed.items(), start=2):
            speed.plot(curves.omega_rad_s, peak, color=look(index).colour, linestyle=look(index).dashes, label=label)
        gain.set_ylabel("dB")
        phase.set_ylabel("deg")
        speed.set_ylabel("|n / n_set| [-]")
        speed.set_xlabel("rad/s")
        plain_log_axis(speed)
        letter_panels((gain, phase, speed), ("M_s / e, magnitude", "M_s / e, phase", "n / n_set, magnitude"))
        legend_below(figure, legend_entries((gain, phase, speed)))
    return figure
