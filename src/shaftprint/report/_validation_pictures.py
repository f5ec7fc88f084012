"""The figures of a validation, as files in a folder."""

from collections.abc import Sequence
from pathlib import Path

from shaftprint.escape import plain_name
from shaftprint.report.charts._pictures import save_chart
from shaftprint.report.figures._validation import validation_chart, validation_summary_chart
from shaftprint.survey._progress import SILENT, Progress
from shaftprint.validation._validation import ExcerptComparison, Validation

# As the thesis shares its sets between the parts (a) and (b) of figures 5.7 to 5.9.
GROUPS = {"a": ("CL4", "OL1+OL5", "benchmark"), "b": ("CL3", "OL1+OL4", "benchmark")}
AROUND_STEP_S = (0.5, 4.0)


def write_validations(folder: Path, validations: Sequence[Validation], *, progress: Progress = SILENT) -> None:
    """Write a figure of all errors, and one of each chirp band, each staircase and its largest step.

    ``folder``: where they go. ``validations``: the model that is validated, and the sets of the thesis if they are to
    stand beside it. ``progress``: is told how far it is.
    """
    first = validations[0]
    shown = _shown(first)
    progress.begin("Drawing the figures", total=1.0 + len(shown))
    save_chart(validation_summary_chart(first), folder / "missed_beyond_noise.svg")
    for comparison in shown:
        progress.advance(1.0)
        excerpt = comparison.excerpt
        for suffix, group in _groups(validations).items():
            figure = validation_chart(
                group,
                excerpt.record,
                excerpt.title,
                set_point=excerpt.kind != "chirp band",
                around_step_s=AROUND_STEP_S if excerpt.step_s is not None else None,
            )
            save_chart(figure, folder / f"{plain_name(f'{excerpt.record} {_title(comparison)}{suffix}')}.svg")


def _title(comparison: ExcerptComparison) -> str:
    """Return the title as it stands in a file name."""
    at = comparison.excerpt.step_s
    return comparison.excerpt.title if at is None else f"step at {at:.0f} s"


def _shown(validation: Validation) -> list[ExcerptComparison]:
    """Return all excerpts, of the steps only the largest of each staircase."""
    largest: dict[str, ExcerptComparison] = {}
    for comparison in validation.comparisons:
        if comparison.excerpt.kind == "step":
            before = largest.setdefault(comparison.excerpt.record, comparison)
            if _height(comparison) > 1.05 * _height(before):
                largest[comparison.excerpt.record] = comparison
    return [c for c in validation.comparisons if c.excerpt.kind != "step" or c in largest.values()]


def _height(comparison: ExcerptComparison) -> float:
    set_point = comparison.traces.set_point
    return abs(float(set_point[-1] - set_point[0]))


def _groups(validations: Sequence[Validation]) -> dict[str, list[Validation]]:
    if len(validations) == 1:
        return {"": list(validations)}
    by_name = {validation.model.name: validation for validation in validations[1:]}
    return {f" {part}": [validations[0], *(by_name[name] for name in names)] for part, names in GROUPS.items()}
