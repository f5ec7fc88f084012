"""A model against the records that it has not seen: over time, and what it misses of every excerpt."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.distributions import deviations
from shaftprint.plain_table import Symbol
from shaftprint.report.charts._chart import Chart, Panel, Scale
from shaftprint.report.charts._marks import Band, Line, Mark, Points, Straight
from shaftprint.report.charts._text import joined
from shaftprint.report.figures._envelope import envelope, worthwhile
from shaftprint.units import PERCENT, rpm_from_rev_s

if TYPE_CHECKING:
    from shaftprint.signals._working_points import WorkingPoint
    from shaftprint.validation._validation import ExcerptComparison, Validation

BAND_POINTS = 200
ROW_PX, FRAME_PX = 28, 20
APART = 0.17
WHAT = (("n", "engine speed"), ("M_s", "shaft torque"))
OUTCOMES = {"passes": "passes", "fails": "fails", "undecided": "does not fail, but noise hides part of it"}


def validation_chart(
    validations: Sequence["Validation"],
    record: str,
    *titles: str,
    set_point: bool = False,
    around_step_s: tuple[float, float] | None = None,
    working_point: "WorkingPoint | None" = None,
) -> Chart:
    """Return speed and torque of one or more models over the data of a record that they have not seen.

    Data and models are shown as they are compared, without what is faster than the highest frequency of the settings.

    Parameters
    ----------
    validations
        Models held against the same recording in the same way.
    record
        Name of the chirp or staircase.
    titles
        Beginnings of the titles of the excerpts that are shown, one after the other in time: ``up to 1`` for thesis
        figure 5.6, ``1 to 5`` for 5.7, ``5 to 10`` and ``above 10`` for 5.8, ``about 10`` for 5.9, ``whole`` for 5.10
        and ``step at`` with a time for 5.11.
    set_point
        Whether the set point is drawn beside the speed, as in thesis figures 5.10 and 5.11.
    around_step_s
        Time before and after the step that is shown [s]; all of the excerpt when not given.
    working_point
        That of the recording, for speed in rpm and torque in N m; deviations over it when not given.

    Raises
    ------
    ValueError
        If there is no validation or no title, or no such excerpt.
    """
    if not validations or not titles:
        raise ValueError("validation figure: expected at least one validation and one title, found none.")
    shown = [_found(validation, record, titles) for validation in validations]
    first, last = shown[0][0].excerpt, shown[0][-1].excerpt
    span = (first.start_s, last.stop_s)
    if around_step_s is not None and first.step_s is not None:
        span = (first.step_s - around_step_s[0], first.step_s + around_step_s[1])
    what = f", {record}, {' and '.join(part.excerpt.title for part in shown[0])}".replace(" -", " −")
    panels = []
    for row, ((output, words), axis) in enumerate(zip(WHAT, _axes(working_point), strict=True)):
        marks = _data(validations[0], shown[0], row, axis, set_point=set_point and row == 0)
        for shade, (validation, parts) in enumerate(zip(validations, shown, strict=True)):
            if len(validations) == 1:
                marks += _with_noise(validation, parts, row, axis)
            marks += _model(validation, parts, row, axis, shade)
        panels.append(
            Panel(
                title=joined(f"{words} ", Symbol(output), what),
                marks=marks,
                x=Scale(title="time in the recording [s]", span=span),
                y=Scale(title=axis.title),
            )
        )
    return Chart(panels=panels, heights_px=(230,))


@dataclass(frozen=True, kw_only=True, slots=True)
class _Axis:
    """In what deviations from the working point are drawn."""

    title: str
    level: float = 0.0
    scale: float = 1.0

    def of(self, deviation: FloatArray) -> FloatArray:
        return self.level + self.scale * deviation


def _axes(point: "WorkingPoint | None") -> tuple[_Axis, _Axis]:
    """Return the axes of speed and torque."""
    if point is None:
        return (_Axis(title="deviation [-]"),) * 2
    speed, torque = rpm_from_rev_s(point.engine_speed_rev_s), point.shaft_torque_nm
    return _Axis(title="[rpm]", level=speed, scale=speed), _Axis(title="[N·m]", level=torque, scale=torque)


def _found(validation: "Validation", record: str, titles: Sequence[str]) -> "list[ExcerptComparison]":
    try:
        return [validation.of(record, title) for title in titles]
    except KeyError as missing:
        raise ValueError(f"validation figure: expected an excerpt {missing.args[0]}, found none.") from None


def _data(
    validation: "Validation", parts: "list[ExcerptComparison]", row: int, axis: _Axis, *, set_point: bool
) -> list[Mark]:
    marks: list[Mark] = []
    for part in parts:
        traces = part.traces
        few = worthwhile(traces.time_s, validation.settings.highest_hz)
        time, measured = envelope(traces.time_s[few], axis.of(traces.measured[row, few]))
        marks.append(Line(x=time, y=measured, name="measured", shade="soft", width=4.0))
        if set_point:
            time, wanted = envelope(traces.time_s[few], axis.of(traces.set_point[few]))
            name = joined("set point ", Symbol("n_set"))
            marks.append(Line(x=time, y=wanted, name=name, shade="reference", width=1.4))
    return marks


def _with_noise(validation: "Validation", parts: "list[ExcerptComparison]", row: int, axis: _Axis) -> list[Mark]:
    """Return where the samples lie that a right model lets expect: its own band and the noise of the recording."""
    wide = deviations(validation.settings.coverage)
    marks: list[Mark] = []
    for part in parts:
        traces = part.traces
        half = wide * np.hypot(traces.model_std[row], traces.noise_std[row])
        every = slice(None, None, max(1, half.size // BAND_POINTS))
        lower, upper = (axis.of(traces.model[row, every] + sign * half[every]) for sign in (-1.0, 1.0))
        text = f"{PERCENT * validation.settings.coverage:g} % band with noise"
        marks.append(Band(x=traces.time_s[every], lower=lower, upper=upper, name=text, shade="reference"))
    return marks


def _model(validation: "Validation", parts: "list[ExcerptComparison]", row: int, axis: _Axis, shade: int) -> list[Mark]:
    marks: list[Mark] = []
    wide = deviations(validation.settings.coverage)
    for part in parts:
        traces = part.traces
        half = wide * traces.model_std[row]
        if np.any(half > 0.0):
            every = slice(None, None, max(1, half.size // BAND_POINTS))
            lower, upper = (axis.of(traces.model[row, every] + sign * half[every]) for sign in (-1.0, 1.0))
            text = f"{PERCENT * validation.settings.coverage:g} % band of "
            marks.append(
                Band(
                    x=traces.time_s[every],
                    lower=lower,
                    upper=upper,
                    name=text + validation.model.name,
                    shade=shade,
                )
            )
        few = worthwhile(traces.time_s, validation.settings.highest_hz)
        time, values = envelope(traces.time_s[few], axis.of(traces.model[row, few]))
        marks.append(Line(x=time, y=values, name=validation.model.name, shade=shade, width=1.6))
    return marks


def validation_summary_chart(validation: "Validation") -> Chart:
    """Return the error of speed and torque in every excerpt with its interval, and the error that is allowed.

    Parameters
    ----------
    validation
        A model held against a recording.
    """
    comparisons = validation.comparisons
    rows = np.arange(len(comparisons), dtype=np.float64)
    allowed = PERCENT * validation.settings.largest_error
    marks: list[Mark] = [Straight(at=allowed, axis="x", name="allowed", dash="dash")]
    for index, (output, words) in enumerate(WHAT):
        errors = PERCENT * np.array([comparison.misfits[index].error for comparison in comparisons])
        ends = PERCENT * np.array([comparison.misfits[index].error_interval for comparison in comparisons])
        marks.append(
            Points(
                x=errors,
                y=rows + (2 * index - 1) * APART,
                bars=(np.maximum(errors - ends[:, 0], 0.0), np.maximum(ends[:, 1] - errors, 0.0)),
                bars_along="x",
                name=joined(f"{words} ", Symbol(output)),
                shade=index,
            )
        )
    names = [f"{c.excerpt.record}, {c.excerpt.title}".replace(" -", " −") for c in comparisons]
    coverage = f"{PERCENT * validation.settings.coverage:g}"
    return Chart(
        panels=(
            Panel(
                title=f"{validation.model.name}: the validation {OUTCOMES[validation.outcome]}",
                marks=marks,
                x=Scale(title=f"missed beyond noise, {coverage} % interval [% of the motion]"),
                y=Scale(names=names, span=(len(comparisons) - 0.5, -0.5)),
            ),
        ),
        heights_px=(ROW_PX * len(comparisons) + FRAME_PX,),
    )
