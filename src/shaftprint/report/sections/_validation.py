"""The section of a report on records that the model has not seen: in words, in numbers, and over time."""

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from shaftprint.report.figures._validation import validation_chart, validation_summary_chart
from shaftprint.report.sections._sections import Inputs, Picture, Section, picture_name
from shaftprint.tables._validation import misfit_table

if TYPE_CHECKING:
    from shaftprint.validation._validation import ExcerptComparison, Validation

MOST_BANDS = 2
AROUND_STEP_S = (0.5, 6.0)
# A step counts as larger than another where it is higher by more than the noise of a level.
HIGHER = 1.05


def validation_section(inputs: Inputs) -> list[Section]:
    """Return how well the model predicts chirps and steps; nothing where it was not tried."""
    if not inputs.validations:
        return []
    first = inputs.validations[0]
    shown = step_against_data(inputs)
    pictures = [
        Picture(
            name="validation_summary",
            caption="What the model misses of each excerpt beyond noise, with 95 % intervals, and what is allowed.",
            alt="Error of speed and torque in every excerpt as points with intervals, and a line at the allowed error.",
            chart=partial(validation_summary_chart, first),
        ),
        *(picture for picture in _excerpt_pictures(inputs) if shown is None or picture.name != shown.name),
    ]
    return [
        Section(
            key="validation",
            title="Records that the model has not seen",
            paragraphs=first.sentences,
            points=first.findings,
            tables=(misfit_table(first),),
            pictures=pictures,
        )
    ]


def step_against_data(inputs: Inputs) -> Picture | None:
    """Return the largest step of the first staircase, measured and by the model; None where there is none."""
    if not inputs.validations:
        return None
    first = inputs.validations[0]
    steps = [c for c in shown_excerpts(first) if c.excerpt.step_s is not None]
    if not steps:
        return None
    picture = _picture(inputs, steps[0])
    outcome = f"{first.headline[:1].upper()}{first.headline[1:]}"
    return replace(picture, caption=f"The largest step: {picture.caption} {outcome}.")


def _excerpt_pictures(inputs: Inputs) -> list[Picture]:
    return [_picture(inputs, comparison) for comparison in shown_excerpts(inputs.validations[0])]


def _picture(inputs: Inputs, comparison: "ExcerptComparison") -> Picture:
    validations, excerpt = inputs.validations, comparison.excerpt
    is_step = excerpt.step_s is not None
    return Picture(
        name=picture_name("validation", excerpt.record, excerpt.kind, f"{excerpt.start_s:.0f}"),
        caption=(
            f"{excerpt.record}, {excerpt.title}: data and model as they are compared, without what is faster than "
            f"{validations[0].settings.highest_hz:g} Hz."
        ),
        alt=f"Speed and torque over time, measured and by the model, of {excerpt.record}, {excerpt.title}.",
        chart=partial(
            validation_chart,
            validations,
            excerpt.record,
            excerpt.title,
            set_point=excerpt.kind != "chirp band",
            around_step_s=AROUND_STEP_S if is_step else None,
            working_point=inputs.signals.working_point,
        ),
    )


def shown_excerpts(validation: "Validation") -> "list[ExcerptComparison]":
    """Return the excerpts that are worth a figure: staircases, the largest step of each, the two worst chirp bands."""
    largest: dict[str, ExcerptComparison] = {}
    bands: list[ExcerptComparison] = []
    for comparison in validation.comparisons:
        if comparison.excerpt.kind == "step":
            before = largest.setdefault(comparison.excerpt.record, comparison)
            if _height(comparison) > HIGHER * _height(before):
                largest[comparison.excerpt.record] = comparison
        if comparison.excerpt.kind == "chirp band":
            bands.append(comparison)
    worst = sorted(bands, key=lambda c: -max(misfit.error for misfit in c.misfits))[:MOST_BANDS]
    chosen = (*largest.values(), *worst)
    return [c for c in validation.comparisons if c.excerpt.kind == "staircase" or c in chosen]


def _height(comparison: "ExcerptComparison") -> float:
    set_point = comparison.traces.set_point
    return abs(float(set_point[-1] - set_point[0]))
