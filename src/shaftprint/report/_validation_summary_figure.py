"""What a model misses of every excerpt, with its interval, beside what it may miss."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.report._style import REFERENCE, house_style, legend_below, legend_entries, look, new_figure
from shaftprint.report._symbols import mathtext

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from shaftprint.validation import Validation

PERCENT = 100.0
ROW_CM, FRAME_CM = 0.62, 3.2
APART = 0.17


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
        for place, (output, words) in enumerate((("n", "engine speed"), ("M_s", "shaft torque"))):
            style = look(place)
            errors = [PERCENT * comparison.misfits[place].error for comparison in comparisons]
            ends = PERCENT * np.array([comparison.misfits[place].error_interval for comparison in comparisons])
            axes.errorbar(
                errors,
                rows + (2 * place - 1) * APART,
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
