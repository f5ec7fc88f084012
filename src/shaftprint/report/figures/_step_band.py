"""What the identified model does after a step of its input, with its confidence band, and what was measured."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.identify.uncertainty._band import step_band
from shaftprint.plain_table import Symbol
from shaftprint.report.charts._chart import Chart, Panel, Scale
from shaftprint.report.charts._marks import Band, Line, Mark
from shaftprint.report.charts._text import joined, over
from shaftprint.report.figures._envelope import envelope

if TYPE_CHECKING:
    from shaftprint.arrays import FloatArray
    from shaftprint.identify.fit._identification import Identification
    from shaftprint.signals._signals import Signals, StepDelay

DURATION_S = 6.0
POINTS = 301
BAND_STEP = 3
# Levels before and after a step are means over so long [s].
LEVEL_S = 5.0
# A step that is not much higher than the smallest is one of those that count as smallest.
HIGHER = 1.05
PERCENT = 100.0


def step_chart(
    identification: "Identification", *, signals: "Signals | None" = None, duration_s: float = DURATION_S
) -> Chart:
    """Return the response of every output to a step of 1 at an input, with its pointwise 95 % band.

    Parameters
    ----------
    identification
        The fit.
    signals
        The prepared recording: its smallest step, which a linear model is meant for, is drawn beside.
    duration_s
        Time after the step that is shown [s].
    """
    measured = {} if signals is None else measured_step(signals, duration_s)
    band = step_band(identification, np.linspace(0.0, duration_s, POINTS))
    few = slice(None, None, BAND_STEP)
    text = f"{PERCENT * band.coverage:g} % band, at each time"
    panels = []
    for index, (output, cause) in enumerate(identification.structure.channels):
        marks: list[Mark] = []
        if cause == "n_set" and output in measured:
            time, values = measured[output]
            marks.append(Line(x=time, y=values, name="measured, smallest step", shade="soft", width=3.0))
        if np.isfinite(band.lower[index]).all():
            lower, upper = band.lower[index, few], band.upper[index, few]
            marks.append(Band(x=band.time_s[few], lower=lower, upper=upper, name=text))
        marks.append(Line(x=band.time_s, y=band.value[index], name=identification.structure.name))
        panels.append(
            Panel(
                title=over(output, cause),
                marks=marks,
                x=Scale(title="time after the step [s]", span=(0.0, duration_s)),
                y=Scale(title=joined(Symbol(output), " after a step of 1 [-]")),
            )
        )
    return Chart(panels=panels, columns=len(panels), heights_px=(300,))


def measured_step(signals: "Signals", duration_s: float) -> "dict[str, tuple[FloatArray, FloatArray]]":
    """Return time [s] and response of speed and torque after the smallest step, over the height of the step.

    ``signals``: the prepared recording. ``duration_s``: time after the step [s].
    """
    heights = [abs(_height(signals, step)) for step in signals.step_delays]
    if not heights or not min(heights) > 0.0:
        return {}
    step = next(s for s, height in zip(signals.step_delays, heights, strict=True) if height <= HIGHER * min(heights))
    point, height = signals.working_point, _height(signals, step)
    shown = _samples(signals, step.set_point_time_s, step.set_point_time_s + duration_s)
    before = _samples(signals, step.set_point_time_s - LEVEL_S, step.set_point_time_s - 0.1)
    time = signals.start_s + np.arange(shown.start, shown.stop) / signals.rate_hz - step.set_point_time_s
    return {
        name: envelope(time, (values[shown] - values[before].mean()) / mean / height)
        for name, values, mean in (
            ("n", signals.engine_speed.speed_rev_s, point.engine_speed_rev_s),
            ("M_s", signals.shaft_torque_nm, point.shaft_torque_nm),
        )
    }


def _height(signals: "Signals", step: "StepDelay") -> float:
    """Return by how much a step changes the set point, over the working point."""
    at = step.set_point_time_s
    before, after = _samples(signals, at - LEVEL_S, at - 0.1), _samples(signals, at + 0.1, at + LEVEL_S)
    rise = signals.set_point_rev_s[after].mean() - signals.set_point_rev_s[before].mean()
    return float(rise) / signals.working_point.engine_speed_rev_s


def _samples(signals: "Signals", begin_s: float, end_s: float) -> slice:
    first, last = (round((at - signals.start_s) * signals.rate_hz) for at in (begin_s, end_s))
    return slice(max(0, first), min(signals.samples, last))
