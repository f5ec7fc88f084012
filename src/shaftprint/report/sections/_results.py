"""The sections of a report on the result: findings in words, parameters, fit and stability."""

from typing import TYPE_CHECKING

from shaftprint.digits import plain, unit_text, with_deviation
from shaftprint.identify.judgement._phrases import probability
from shaftprint.report._curve import Curve
from shaftprint.report.figures._covariance import correlation_chart
from shaftprint.report.figures._fit import fit_chart
from shaftprint.report.figures._nyquist import nyquist_chart
from shaftprint.report.figures._residuals import residual_chart
from shaftprint.report.figures._step_band import step_chart
from shaftprint.report.sections._meanings import in_words
from shaftprint.report.sections._sections import Inputs, Picture, Section
from shaftprint.report.sections._validation import step_against_data
from shaftprint.tables._fingerprint import (
    TELLING_PERCENT,
    combination_table,
    expected_text,
    fit_table,
    margin_table,
    parameter_table,
    physical_table,
    truth_of_combinations,
)
from shaftprint.validation._settings import ValidationSettings

if TYPE_CHECKING:
    from shaftprint.fingerprint._fingerprint import Fingerprint

# A misfit that chance alone makes in fewer than this share of the tests is none of chance.
UNLIKELY = 0.01


def summary_section(inputs: Inputs) -> Section:
    """Return the verdict in all its words, the findings, and how well the model explains the data."""
    fingerprint = inputs.fingerprint
    return Section(
        key="summary",
        title="Findings",
        paragraphs=(*fingerprint.verdict.sentences, *_against_vessel(fingerprint)),
        tables=(fit_table(fingerprint),),
        points=(*fingerprint.findings, *fingerprint.quality.remarks),
        pictures=(
            Picture(
                name="residuals",
                caption="What the model leaves, over its standard deviation, and chi-square of each line.",
                alt="Two panels: normalised residuals and chi-square of each test line.",
                chart=lambda: residual_chart(inputs.identification),
            ),
        ),
    )


def _explained(fingerprint: "Fingerprint") -> str:
    quality = fingerprint.quality
    # where noise is in the way of a perfect model too, a FitPercent says nothing of this one
    telling = [name for name, ceiling in quality.fit_ceiling.items() if ceiling >= TELLING_PERCENT]
    fit = "; ".join(
        f"{name} {plain(quality.fit_percent[name], 1)} %, a perfect model {plain(quality.fit_ceiling[name], 1)} %"
        for name in telling
    )
    of_fit = f" FitPercent: {fit}." if fit else ""
    if quality.chi_square is None:
        return f"The fit was not weighted by the noise, so it says nothing of the model's validity.{of_fit}"
    chance = quality.p_value
    words = "explains" if chance is None or chance >= UNLIKELY else "does not explain"
    tested = "" if chance is None else f", {probability(chance)}"
    return (
        f"The model {words} the measured responses within their noise (chi-square {plain(quality.chi_square, 0)} for "
        f"{quality.degrees_of_freedom} degrees of freedom{tested}).{of_fit}"
    )


def _against_vessel(fingerprint: "Fingerprint") -> list[str]:
    compared = [q for q in fingerprint.physical if q.expected is not None]
    if not compared:
        return []
    listed = "; ".join(
        f"{q.name} = {with_deviation(q.value, q.std)} {unit_text(q.unit)}".strip()
        + f" (vessel file {expected_text(q)})"
        for q in compared
    )
    return [f"Physical values: {listed}."]


def parameter_section(inputs: Inputs) -> Section:
    """Return parameters, combinations and physical values with uncertainty, and their correlation."""
    truth = truth_of_combinations(inputs.identification, inputs.truth) | dict(inputs.truth) if inputs.truth else {}
    tables = [
        parameter_table(inputs.fingerprint, truth),
        combination_table(inputs.fingerprint, truth),
        physical_table(inputs.fingerprint, truth),
    ]
    return Section(
        key="parameters",
        title="Parameters",
        paragraphs=_given(inputs.fingerprint),
        tables=[table for table in tables if table.rows],
        pictures=(
            Picture(
                name="correlation",
                caption=(
                    "Correlation of the estimates. Parameters with a correlation near ±1 cannot be told apart by this "
                    "test; their combinations above can."
                ),
                alt="Matrix of the correlation between all free parameters, with the numbers written in each field.",
                chart=lambda: correlation_chart(inputs.identification),
            ),
        ),
    )


def _given(fingerprint: "Fingerprint") -> tuple[str, ...]:
    """Return what the fit was told instead of finding it."""
    priors = "; ".join(f"{name} = {with_deviation(p.mean, p.std)}" for name, p in fingerprint.priors.items())
    held = ", ".join(f"{name} = {value:g}" for name, value in fingerprint.held.items())
    sentences = []
    if priors:
        sentences.append(
            f"Priors, from the vessel file or as given: {priors}. Where the standard deviation below is hardly smaller "
            "than this one, the test adds nothing to the prior."
        )
    if held:
        sentences.append(f"Held during the fit: {held}.")
    return tuple(sentences)


def fit_section(inputs: Inputs) -> Section:
    """Return how well the model explains the data."""
    symbols = in_words(inputs.identification.structure.channels)
    return Section(
        key="fit",
        title="Model and data",
        paragraphs=(_explained(inputs.fingerprint),),
        pictures=(
            Picture(
                name="fit",
                caption=(
                    "Identified model with its 95 % band (covariance of the parameters) and measured response with "
                    f"95 % intervals; pale points may be noise alone, hollow ones are not used. {symbols}"
                    "A band that is not seen is thinner than its line: the lowest row magnifies it, beside what the "
                    "model leaves, in standard deviations of each measured point."
                ),
                alt="Bode diagram of the identified model through the measured points of all outputs.",
                chart=lambda: fit_chart(inputs.identification, aliasing_limit_hz=inputs.aliasing_limit_hz),
            ),
            step_against_data(inputs) or model_step(inputs),
        ),
    )


def model_step(inputs: Inputs) -> Picture:
    """Return what the model does after a step."""
    return Picture(
        name="step",
        caption=(
            "What the identified linear model does after a step of its input, delays exact, with its 95 % band "
            "at each time, and the smallest measured step over its height, without what is faster than "
            f"{ValidationSettings().highest_hz:g} Hz; noise lets it lie in the wide band."
        ),
        alt="Response of every output to a step of the input, with a band around it.",
        chart=lambda: step_chart(inputs.identification, signals=inputs.signals),
    )


def stability_section(inputs: Inputs) -> list[Section]:
    """Return the stability margins; nothing for a structure without feedback."""
    if inputs.identification.margins is None:
        return []
    curve = Curve.of(inputs.identification)
    picture = Picture(
        name="nyquist",
        caption=(
            "Nyquist plot of the loop gain with exact delays. Dots are labelled with their frequency in rad/s. The "
            "dashed circle about the critical point −1 touches the curve: the wider, the further from hunting."
        ),
        alt="Curve of the loop gain in the complex plane with gain margin, phase margin and critical point marked.",
        chart=lambda: nyquist_chart(curve),
    )
    return [
        Section(
            key="stability",
            title="Stability",
            tables=(margin_table(inputs.fingerprint, inputs.truth),),
            # the summary shows a step against data where there is one
            pictures=(picture, model_step(inputs)) if step_against_data(inputs) else (picture,),
        )
    ]
