"""What ``validate`` works with and leaves behind: the model of a fingerprint, the figures, the tables."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from shaftprint.arrays import frozen_float
from shaftprint.cli._terminal import print_findings
from shaftprint.cli.output._json import give
from shaftprint.cli.output._progress import Steps
from shaftprint.cli.output._tables import print_tables
from shaftprint.errors import FingerprintError
from shaftprint.escape import plain_name
from shaftprint.fingerprint._fingerprint import Fingerprint
from shaftprint.fingerprint._model import identified_model
from shaftprint.models._structure import Structure
from shaftprint.report.charts._pictures import save_chart
from shaftprint.report.figures._validation import validation_chart, validation_summary_chart
from shaftprint.signals._signals import Signals
from shaftprint.survey._measurement import Measurement
from shaftprint.survey._trial import Trial
from shaftprint.survey._validation_apart import limited_model, limits_of, validated_apart
from shaftprint.tables._validation import excerpt_name, misfit_table, step_number_table
from shaftprint.units import rpm_from_rev_s
from shaftprint.validation._model import Model
from shaftprint.validation._prediction import Predict, linear_prediction, simulated_prediction
from shaftprint.validation._validate import validate
from shaftprint.validation._validation import ExcerptComparison, Validation

# As the thesis shares its sets between the parts (a) and (b) of figures 5.7 to 5.9.
GROUPS = {"a": ("CL4", "OL1+OL5", "benchmark"), "b": ("CL3", "OL1+OL4", "benchmark")}
AROUND_STEP_S = (0.5, 4.0)


def write_validations(folder: Path, validations: Sequence[Validation], *, steps: Steps) -> None:
    """Write a figure of all errors, and one of each chirp band, each staircase and its largest step.

    Parameters
    ----------
    folder
        Where they go.
    validations
        The model that is validated, and the sets of the thesis if they are to stand beside it.
    steps
        Progress of the command.
    """
    first = validations[0]
    shown = _shown(first)
    steps.begin("Drawing the figures", total=1.0 + len(shown))
    save_chart(validation_summary_chart(first), folder / "missed_beyond_noise.svg")
    for comparison in shown:
        steps.advance(1.0)
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


# Parameters are normalised at the working point: at another one inertia times and gains are others.
_SAME_WORKING_POINT = 0.02


@dataclass(frozen=True, kw_only=True, slots=True)
class Asked:
    """What a model is to be held against."""

    records: tuple[str, ...]
    """Chirps and staircases; empty for the usual ones."""
    used: tuple[str, ...]
    """Tests that the model was identified from besides those that it names itself."""
    allow_in_sample: bool
    """Whether records of the identification are shown."""
    seed: int
    """Start of the random numbers."""

    def validated(
        self,
        model: Model,
        signals: Signals,
        trial: Trial,
        *,
        quadratic_propeller: bool = True,
        predict: Predict = linear_prediction,
    ) -> Validation:
        """Return a model held against them."""
        return validate(
            model,
            signals,
            trial.campaign,
            rng=np.random.default_rng(self.seed),
            records=self.records or None,
            used=self.used,
            allow_in_sample=self.allow_in_sample,
            quadratic_propeller=quadratic_propeller,
            predict=predict,
        )


def validated_with_limits(
    fingerprint: Fingerprint, measurement: Measurement, trial: Trial, asked: Asked, *, steps: Steps
) -> Validation:
    """Return the line with its limits held against a recording; against its own, by fits that did not use it.

    Raises
    ------
    FingerprintError
        If the working points of both differ by more than 2 %, or the fingerprint has no limits.
    ValidationError
        If no stretch can be judged.
    """
    signals, line = measurement.signals, limits_of(fingerprint)
    _expect_working_point(fingerprint, signals)
    if _is_of(fingerprint, signals):
        rng = np.random.default_rng(asked.seed)
        return validated_apart(fingerprint, signals, trial, rng=rng, records=asked.records or None, progress=steps)
    model = limited_model(line)
    return asked.validated(model, signals, trial, quadratic_propeller=False, predict=simulated_prediction)


def fingerprint_model(fingerprint: Fingerprint, structure: Structure, signals: Signals) -> Model:
    """Return the model of a fingerprint; the lines that it was identified from count where it is of this recording.

    Raises
    ------
    FingerprintError
        If the structure has other parameters than the fingerprint, or the working points of both differ by more than
        2 %.
    """
    model = identified_model(fingerprint, structure)
    _expect_working_point(fingerprint, signals)
    lost = ~np.isfinite(np.diag(model.covariance))
    return Model(
        name=fingerprint.structure,
        structure=model.structure,
        values=model.values,
        covariance=frozen_float(np.where(lost[:, None] | lost[None, :], 0.0, model.covariance)),
        used=fingerprint.conditions.lines_used if _is_of(fingerprint, signals) else (),
        not_known=model.not_known,
    )


def _is_of(fingerprint: Fingerprint, signals: Signals) -> bool:
    """Return whether a fingerprint is of a recording."""
    return any(s.role == "recording" and s.sha256 == signals.recording_sha256 for s in fingerprint.sources)


def _expect_working_point(fingerprint: Fingerprint, signals: Signals) -> None:
    here = rpm_from_rev_s(signals.working_point.engine_speed_rev_s)
    there = fingerprint.conditions.engine_speed.value
    if abs(here / there - 1.0) > _SAME_WORKING_POINT:
        raise FingerprintError(
            f"fingerprint of {fingerprint.conditions.vessel}: expected a recording around its working point of "
            f"{there:.1f} rpm, found {here:.1f} rpm; identify the recording at its own working point."
        )


def print_validation(validation: Validation) -> None:
    """Print the verdict, every excerpt, the numbers of every step, and how it was found."""
    give("misfits", {excerpt_name(c): c.misfits for c in validation.comparisons})
    print_findings(f"Validation: {validation.headline}", validation.sentences, is_answer=True)
    print_tables([misfit_table(validation), step_number_table(validation)])
    print_findings("How this was found", validation.findings)
