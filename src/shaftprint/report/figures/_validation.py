"""A model against the records that it has not seen: over time, and what it misses of every excerpt."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.distributions import deviations
from shaftprint.report.figures._envelope import envelope, worthwhile
from shaftprint.report.figures._style import (
    REFERENCE,
    house_style,
    legend_below,
    legend_entries,
    letter_panels,
    look,
    new_figure,
)
from shaftprint.report.notation import mathtext

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from shaftprint.validation import ExcerptComparison, Validation

MEASURED = "#b9b9b9"
BAND_ALPHA = 0.28
PERCENT = 100.0
WHAT = (("n", "engine speed"), ("M_s", "shaft torque"))
ROW_CM, FRAME_CM = 0.62, 3.2
APART = 0.17


def plot_validation(
    validations: Sequence["Validation"],
    record: str,
    *titles: str,
    set_point: bool = False,
    around_step_s: tuple[float, float] | None = None,
) -> "Figure":
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

    Raises
    ------
    ValueError
        If there is no validation or no title, or no such excerpt.
    """
    if not validations or not titles:
        raise ValueError("validation figure: expected at least one validation and one title, found none.")
    shown = [_found(validation, record, titles) for validation in validations]
    with house_style():
        figure = new_figure(12.0)
        panels = figure.subplots(2, 1, sharex=True)
        for index, (axes, (output, _)) in enumerate(zip(panels, WHAT, strict=True)):
            _draw_data(axes, validations[0], shown[0], index, set_point=set_point and index == 0)
            for number, (validation, parts) in enumerate(zip(validations, shown, strict=True)):
                _draw_model(axes, validation, parts, index, number)
            axes.set_ylabel(f"{mathtext(output)}, deviation over\nworking point [-]")
        first, last = shown[0][0].excerpt, shown[0][-1].excerpt
        begin, end = first.start_s, last.stop_s
        if around_step_s is not None and first.step_s is not None:
            begin, end = first.step_s - around_step_s[0], first.step_s + around_step_s[1]
        panels[-1].set_xlim(begin, end)
        panels[-1].set_xlabel("time in the recording [s]")
        what = f"{record}, {' and '.join(part.excerpt.title for part in shown[0])}".replace(" -", " −")
        letter_panels(panels, [f"{words}, {what}" for _, words in WHAT])
        legend_below(figure, legend_entries(panels))
        return figure


def _found(validation: "Validation", record: str, titles: Sequence[str]) -> "list[ExcerptComparison]":
    try:
        return [validation.of(record, title) for title in titles]
    except KeyError as missing:
        raise ValueError(f"validation figure: expected an excerpt {missing.args[0]}, found none.") from None


def _draw_data(
    axes: "Axes", validation: "Validation", parts: "list[ExcerptComparison]", index: int, *, set_point: bool
) -> None:
    for part in parts:
        traces = part.traces
        few = worthwhile(traces.time_s, validation.settings.highest_hz)
        axes.plot(
            *envelope(traces.time_s[few], traces.measured[index, few]),
            color=MEASURED,
            linewidth=2.6,
            label="measured",
            zorder=1.5,
        )
        if set_point:
            axes.plot(
                *envelope(traces.time_s[few], traces.set_point[few]),
                color=REFERENCE,
                linewidth=0.8,
                label=f"set point {mathtext('n_set')}",
                zorder=1.8,
            )


def _draw_model(
    axes: "Axes", validation: "Validation", parts: "list[ExcerptComparison]", index: int, number: int
) -> None:
    style = look(number)
    wide = deviations(validation.settings.coverage)
    for part in parts:
        traces = part.traces
        few = worthwhile(traces.time_s, validation.settings.highest_hz)
        time, middle = traces.time_s[few], np.asarray(traces.model[index, few])
        half: FloatArray = wide * traces.model_std[index, few]
        if np.any(half > 0.0):
            axes.fill_between(
                time,
                middle - half,
                middle + half,
                color=style.colour,
                alpha=BAND_ALPHA,
                linewidth=0.0,
                label=f"{PERCENT * validation.settings.coverage:g} % band of {validation.model.name}",
            )
        axes.plot(
            *envelope(time, middle),
            color=style.colour,
            linestyle=style.dashes,
            linewidth=1.0,
            label=validation.model.name,
        )


def plot_validation_summary(validation: "Validation") -> "Figure":
    """Return the error of speed and torque in every excerpt with its interval, and the error that is allowed.

    Parameters
    ----------
    validation
        A model held against a recording.
    """
    comparisons = validation.comparisons
    rows = np.arange(len(comparisons), dtype=np.float64)
    with house_style():
        figure = new_figure(FRAME_CM + ROW_CM * len(comparisons))
        axes = figure.subplots()
        allowed = PERCENT * validation.settings.largest_error
        axes.axvline(allowed, color=REFERENCE, linewidth=1.0, linestyle=(0.0, (4.0, 2.0)), label="allowed")
        for index, (output, words) in enumerate((("n", "engine speed"), ("M_s", "shaft torque"))):
            style = look(index)
            errors = [PERCENT * comparison.misfits[index].error for comparison in comparisons]
            ends = PERCENT * np.array([comparison.misfits[index].error_interval for comparison in comparisons])
            axes.errorbar(
                errors,
                rows + (2 * index - 1) * APART,
                xerr=[np.maximum(errors - ends[:, 0], 0.0), np.maximum(ends[:, 1] - errors, 0.0)],
                fmt=style.marker,
                color=style.colour,
                markersize=4.0,
                linewidth=1.0,
                capsize=2.0,
                label=f"{words} {mathtext(output)}",
            )
        axes.set_yticks(rows, [f"{c.excerpt.record}, {c.excerpt.title}".replace(" -", " −") for c in comparisons])
        axes.set_ylim(len(comparisons) - 0.5, -0.5)
        axes.set_xlim(left=0.0)
        coverage = f"{PERCENT * validation.settings.coverage:g}"
        axes.set_xlabel(f"missed beyond noise, with {coverage} % interval [% of the motion]")
        axes.set_title(f"{validation.model.name}: the validation {_word(validation)}")
        legend_below(figure, legend_entries([axes]))
        return figure


def _word(validation: "Validation") -> str:
    return {"passes": "passes", "fails": "fails", "undecided": "does not fail, but noise hides part of it"}[
        validation.outcome
    ]
