"""Signal-to-noise ratio of every line and channel (thesis table 3.7 as a picture)."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.plain_table import Symbol
from shaftprint.report.charts._chart import Chart, Panel, Scale
from shaftprint.report.charts._marks import Line, Mark, Points, Straight

if TYPE_CHECKING:
    from shaftprint.spectra._spectra import Spectra

THESIS_LIMIT_DB = 3.0


def signal_to_noise_chart(spectra: "Spectra", *, aliasing_limit_hz: float | None = None) -> Chart:
    """Return the local signal-to-noise ratio of each line and channel (values of thesis table 3.7).

    Lines that are not used are hollow. The horizontal line is the thesis' limit of 3 dB.

    Parameters
    ----------
    spectra
        What the sines told.
    aliasing_limit_hz
        Half the pulse rate of the speed sensor [Hz].
    """
    ratios = spectra.signal_to_noise
    omega = 2.0 * np.pi * np.array([window.frequency_hz for window in spectra.windows])
    line_used = dict(zip(spectra.response.lines, spectra.response.used, strict=True))
    used = np.array([bool(line_used.get(line, False)) for line in ratios.lines])
    marks: list[Mark] = []
    for shade, (channel, values) in enumerate(zip(ratios.channels, ratios.local_db.T, strict=True)):
        marks.append(Line(x=omega, y=values, name=Symbol(channel), shade=shade, width=1.4))
        for chosen, filled in ((used, True), (~used, False)):
            if chosen.any():
                words = [line for line, is_shown in zip(ratios.lines, chosen, strict=True) if is_shown]
                points = Points(
                    x=omega[chosen], y=values[chosen], name=Symbol(channel), shade=shade, filled=filled, words=words
                )
                marks.append(points)
    limit = f"{THESIS_LIMIT_DB:g} dB, the thesis' limit"
    marks.append(Straight(at=THESIS_LIMIT_DB, axis="y", name=limit, shade="ink", dash="solid"))
    if aliasing_limit_hz is not None:
        text = f"aliasing limit of the speed, {aliasing_limit_hz:.2f} Hz"
        marks.append(Straight(at=2.0 * np.pi * aliasing_limit_hz, axis="x", name=text))
    frequency = Scale(title="frequency [rad/s]", log=True)
    return Chart(panels=(Panel(marks=marks, x=frequency, y=Scale(title="local signal-to-noise ratio [dB]")),))
