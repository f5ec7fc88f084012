"""Steps and the delay between set point and speed (thesis figure 3.3)."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.plain_table import Symbol
from shaftprint.report.charts._chart import Chart, Panel, Scale
from shaftprint.report.charts._marks import Line, Mark, Points, Straight, Words
from shaftprint.report.charts._text import joined
from shaftprint.report.figures._envelope import envelope

if TYPE_CHECKING:
    from shaftprint.signals._signals import Signals, StepDelay

AROUND_S = 20.0
ZOOM_BEFORE_S, ZOOM_AFTER_S = 0.6, 1.8
# The middle of a step lies between the set points this long before and after it.
BESIDE_S = 0.5
HIGHER = 1.2
TIME, DEVIATION = "time in the recording [s]", "deviation [-]"


def delay_chart(signals: "Signals", *, staircase: str | None = None) -> Chart:
    """Return the steps of a staircase, one of them enlarged, and all delays: what figure 3.3 of the thesis shows.

    Parameters
    ----------
    signals
        The prepared recording, with the delay of each step.
    staircase
        Name of the staircase; the first by default.

    Raises
    ------
    ValueError
        If there is no step of that name.
    """
    steps = [s for s in signals.step_delays if staircase in (None, s.staircase) and s.delay_s is not None]
    steps = [s for s in steps if s.staircase == steps[0].staircase]
    if not steps:
        raise ValueError(f"step delays: expected steps of {staircase or 'a staircase'}, found none in the signals.")
    first = steps[0]
    whole = (first.set_point_time_s - AROUND_S, steps[-1].set_point_time_s + AROUND_S)
    zoom = (first.set_point_time_s - ZOOM_BEFORE_S, first.set_point_time_s + ZOOM_AFTER_S)
    return Chart(
        panels=(
            Panel(
                title=f"staircase {first.staircase}, deviation over working point",
                marks=_signals(signals, whole),
                x=Scale(title=TIME),
                y=Scale(title=DEVIATION),
            ),
            Panel(
                title="first step, enlarged",
                marks=[*_signals(signals, zoom), *_crossings(signals, first)],
                x=Scale(title=TIME, span=zoom),
                y=Scale(title=DEVIATION),
            ),
            _delays(steps),
        ),
        heights_px=(210,),
        linked="none",
    )


def _signals(signals: "Signals", span_s: tuple[float, float]) -> list[Mark]:
    first = max(0, int((span_s[0] - signals.start_s) * signals.rate_hz))
    last = min(signals.samples, int((span_s[1] - signals.start_s) * signals.rate_hz) + 1)
    time = signals.start_s + np.arange(first, last) / signals.rate_hz
    marks: list[Mark] = []
    for values, words, shade in (
        (signals.engine_speed.speed_rev_s, ("n", ", engine speed"), 0),
        (signals.set_point_rev_s, ("n_set", ", set point"), 1),
    ):
        x, y = envelope(time, _deviation(signals, values[first:last]))
        name = joined(Symbol(words[0]), words[1])
        marks.append(Line(x=x, y=y, name=name, shade=shade, dash="solid", width=1.6))
    return marks


def _deviation(signals: "Signals", speed_rev_s: FloatArray) -> FloatArray:
    return speed_rev_s / signals.working_point.engine_speed_rev_s - 1.0


def _crossings(signals: "Signals", step: "StepDelay") -> list[Mark]:
    """Return where set point and speed cross the middle of the step, and the time between."""
    sides = (step.set_point_time_s + np.array([-BESIDE_S, BESIDE_S]) - signals.start_s) * signals.rate_hz
    level = float(_deviation(signals, signals.set_point_rev_s[sides.astype(np.intp)]).mean())
    ends = np.array([step.set_point_time_s, step.speed_time_s], dtype=np.float64)
    return [
        *(Straight(at=float(end), axis="x", dash="dash") for end in ends),
        Line(x=ends, y=np.full(2, level), shade="ink", width=1.4),
        Words(x=float(ends[1]), y=level, text=f"{step.delay_s:.3f} s"),
    ]


def _delays(steps: "list[StepDelay]") -> Panel:
    delay = np.array([step.delay_s for step in steps], dtype=np.float64)
    rising = np.array([step.rising for step in steps])
    number = np.arange(delay.size, dtype=np.float64)
    marks: list[Mark] = []
    for chosen, name, filled in ((rising, "speed rises", True), (~rising, "speed falls", False)):
        if chosen.any():
            marks.append(
                Points(
                    x=number[chosen],
                    y=delay[chosen],
                    name=name,
                    marker="triangle-up" if filled else "triangle-down",
                    filled=filled,
                    size=9.0,
                )
            )
    marks.append(Straight(at=float(delay.mean()), axis="y", name=f"mean {delay.mean():.3f} s"))
    return Panel(
        title="delay of each step",
        marks=marks,
        x=Scale(title="step", names=[str(place + 1) for place in range(delay.size)], span=(-0.5, delay.size - 0.5)),
        y=Scale(title="delay [s]", span=(0.0, HIGHER * float(delay.max()))),
    )
