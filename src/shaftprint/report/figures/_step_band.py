"""What the identified model does after a step of its input, with its confidence band, and what was measured."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.distributions import deviations
from shaftprint.identify.uncertainty._band import step_band
from shaftprint.plain_table import Symbol
from shaftprint.report.charts._chart import Chart, Panel, Scale
from shaftprint.report.charts._marks import Band, Line, Mark
from shaftprint.report.charts._text import joined, over
from shaftprint.report.figures._envelope import envelope
from shaftprint.units import PERCENT
from shaftprint.validation._run import low_pass
from shaftprint.validation._settings import ValidationSettings

if TYPE_CHECKING:
    from shaftprint.arrays import FloatArray
    from shaftprint.identify.fit._identification import Identification
    from shaftprint.signals._signals import Signals, StepDelay

DURATION_S = 6.0
POINTS = 301
BAND_STEP = 3
# Levels before and after a step are means over so long [s].
LEVEL_S = 5.0
# What a low-pass shows of a step before it happens [s].
AHEAD_S = 0.5
# A step that is not much higher than the smallest is one of those that count as smallest.
HIGHER = 1.05


def step_chart(
    identification: "Identification", *, signals: "Signals | None" = None, duration_s: float = DURATION_S
) -> Chart:
    """Return the response of every output to a step of 1 at an input, with its pointwise 95 % band.

    Parameters
    ----------
    identification
        The fit.
    signals
        The prepared recording: its smallest step, which a linear model is meant for, is drawn beside, with the band in
        which a right model and the noise before the step let expect its samples.
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
        is_known = np.isfinite(band.lower[index]).all()
        middle, lower, upper = band.value[index, few], band.lower[index, few], band.upper[index, few]
        if cause == "n_set" and output in measured:
            time, values, noise = measured[output]
            half = np.hypot(0.5 * (upper - lower) if is_known else 0.0, deviations(band.coverage) * noise)
            wide = f"{PERCENT * band.coverage:g} % band with noise"
            marks.append(Line(x=time, y=values, name="measured, smallest step", shade="soft", width=3.0))
            marks.append(
                Band(x=band.time_s[few], lower=middle - half, upper=middle + half, name=wide, shade="reference")
            )
        if is_known:
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


def measured_step(signals: "Signals", duration_s: float) -> "dict[str, tuple[FloatArray, FloatArray, float]]":
    """Return time [s], response and noise of speed and torque after the smallest step, over the height of the step.

    As a validation compares them: without what is faster than its highest frequency. The noise is the standard
    deviation of the samples before the step from their mean.

    ``signals``: the prepared recording. ``duration_s``: time after the step [s].
    """
    heights = [abs(_height(signals, step)) for step in signals.step_delays]
    if not heights or not min(heights) > 0.0:
        return {}
    smallest = [s for s, height in zip(signals.step_delays, heights, strict=True) if height <= HIGHER * min(heights)]
    # the torque rises with the square of the speed: a model holds about its working point
    step = min(smallest, key=lambda one: abs(_middle(signals, one)))
    at, height = step.set_point_time_s, _height(signals, step)
    whole = _samples(signals, at - 2.0 * LEVEL_S, at + duration_s + LEVEL_S)
    time = signals.start_s + np.arange(whole.start, whole.stop) / signals.rate_hz - at
    before, shown = (time >= -LEVEL_S) & (time < -AHEAD_S), (time >= 0.0) & (time <= duration_s)
    point = signals.working_point
    measured = {}
    for name, values, mean in (
        ("n", signals.engine_speed.speed_rev_s, point.engine_speed_rev_s),
        ("M_s", signals.shaft_torque_nm, point.shaft_torque_nm),
    ):
        smooth = low_pass(values[whole], signals.rate_hz, ValidationSettings().highest_hz) / mean / height
        level = smooth[before]
        measured[name] = (*envelope(time[shown], smooth[shown] - level.mean()), float(level.std()))
    return measured


def _height(signals: "Signals", step: "StepDelay") -> float:
    """Return by how much a step changes the set point, over the working point."""
    before, after = _levels(signals, step)
    return after - before


def _middle(signals: "Signals", step: "StepDelay") -> float:
    """Return how far the middle of a step is from the working point, over it."""
    return 0.5 * sum(_levels(signals, step)) - 1.0


def _levels(signals: "Signals", step: "StepDelay") -> tuple[float, float]:
    """Return the set point before and after a step, over the working point."""
    at, speed = step.set_point_time_s, signals.working_point.engine_speed_rev_s
    sides = _samples(signals, at - LEVEL_S, at - 0.1), _samples(signals, at + 0.1, at + LEVEL_S)
    before, after = (float(signals.set_point_rev_s[side].mean()) / speed for side in sides)
    return before, after


def _samples(signals: "Signals", begin_s: float, end_s: float) -> slice:
    first, last = (round((at - signals.start_s) * signals.rate_hz) for at in (begin_s, end_s))
    return slice(max(0, first), min(signals.samples, last))
