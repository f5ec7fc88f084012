"""The line with its limits held against stretches of its own recording, each judged by a fit that did not use it.

Limits show in the very steps and chirps that a model is held against. So each record is taken out in turn, the limits
are fitted to the rest, and that fit predicts it. Where the rest does not show a limit, as in a test with one staircase,
step after step is taken out instead; one that alone shows a limit has no fit that could judge it.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import frozen_float, known_part
from shaftprint.campaign._campaign import Campaign
from shaftprint.campaign._excitations import Chirp, Staircase
from shaftprint.errors import FingerprintError, ValidationError
from shaftprint.fingerprint._fingerprint import Fingerprint
from shaftprint.fingerprint._line_with_limits import LineWithLimits
from shaftprint.fingerprint._model import model_with_limits
from shaftprint.fingerprint._validation_record import StretchRecord, ValidationRecord
from shaftprint.late import late
from shaftprint.signals._signals import Signals
from shaftprint.survey._line_with_limits import line_with_limits
from shaftprint.survey._progress import SILENT, Progress
from shaftprint.survey._trial import Trial

with late():
    from shaftprint.limits import _candidates
    from shaftprint.limits._levels_beside import levels_beside
    from shaftprint.validation import _prediction
    from shaftprint.validation._model import Model
    from shaftprint.validation._validate import joined, validate
    from shaftprint.validation._validation_records import default_records, excerpts_of

if TYPE_CHECKING:
    from shaftprint.limits._candidates import Kind
    from shaftprint.limits._levels_beside import Levels
    from shaftprint.validation._validation import Validation
    from shaftprint.validation._validation_records import Excerpt


# What follows a record still answers it [s].
AFTER_S = 5.0
# What the low-pass shows of a stretch before it begins [s].
BEFORE_S = 1.0


def limited_model(line: LineWithLimits) -> "Model":
    """Return the model of a line with its limits, for a validation."""
    model = model_with_limits(line)
    return Model(
        name=model.structure.name,
        structure=model.structure,
        values=model.values,
        covariance=frozen_float(known_part(model.covariance)),
        not_known=model.not_known,
    )


def validated_apart(
    fingerprint: Fingerprint,
    signals: Signals,
    trial: Trial,
    *,
    rng: np.random.Generator,
    records: Sequence[str] | None = None,
    progress: Progress = SILENT,
) -> "Validation":
    """Hold the line with its limits against records of the recording that it was found in.

    ``fingerprint``: the linear fit and the line with limits. ``signals``, ``trial``: the recording that both are from,
    and what was asked. ``rng``: source of the parameter sets that bands of step numbers are drawn from. ``records``:
    names of chirps and staircases; by default all staircases and the chirp with the widest sweep. Raises
    ValidationError if there is no record, one is not in the campaign, or no noise can be measured; FingerprintError if
    there are no limits, or they cannot be put into the structure of the fingerprint.
    """
    task = _Task.of(fingerprint, signals, trial, rng)
    names = default_records(trial.campaign, fingerprint.conditions.lines_used) if records is None else records
    progress.begin("Fitting the limits without each record that they are held against", total=float(len(names)))
    validations: list[Validation] = []
    for name in names:
        validations += task.of_record(name)
        progress.advance(1.0)
    if not validations:
        raise ValidationError(
            f"campaign {trial.campaign.name}: expected records of which one can be left out and the rest still shows "
            f"the {' and '.join(kind.value for kind in kinds_of(task.line))}, found {', '.join(names) or 'none'}; test "
            "with a second staircase."
        )
    whole = joined(validations, limited_model(task.line))
    return replace(whole, findings=(*whole.findings, *_how_judged(task.line, whole, trial.campaign, names)))


def _how_judged(line: LineWithLimits, whole: "Validation", campaign: Campaign, names: Sequence[str]) -> list[str]:
    """Return which fits judged, and what none could judge."""
    said = ["each excerpt is judged by limits that were fitted without it"]
    judged = {(one.excerpt.record, one.excerpt.title) for one in whole.comparisons}
    planned = excerpts_of(campaign, names, used=(), allow_in_sample=False, settings=whole.settings)
    left = [f"{one.record} ({one.title})" for one in planned if (one.record, one.title) not in judged]
    if left:
        limits = " and ".join(kind.value for kind in kinds_of(line))
        said.append(f"not judged, because the rest does not show the {limits}, or for a gap: {', '.join(left)}")
    return said


@dataclass(frozen=True, slots=True, eq=False)
class _Task:
    """What is the same for every record."""

    fingerprint: Fingerprint
    line: LineWithLimits
    signals: Signals
    trial: Trial
    rng: np.random.Generator

    @classmethod
    def of(cls, fingerprint: Fingerprint, signals: Signals, trial: Trial, rng: np.random.Generator) -> "_Task":
        return cls(fingerprint, limits_of(fingerprint), signals, trial, rng)

    def of_record(self, name: str) -> "list[Validation]":
        """Return a record held against fits that did not use it."""
        campaign = self.trial.campaign
        large: list[Chirp | Staircase] = [*campaign.chirps, *campaign.staircases]
        test = next((one for one in large if one.name == name), None)
        if test is None:
            # the sentence is that of the validation
            return [self._validated(self.line, name)]
        without = self._without([(test.start_s - BEFORE_S, test.stop_s + AFTER_S)])
        if self._shows_all(without):
            return [self._validated(self._line(without), name)]
        if isinstance(test, Chirp):
            return []
        return self._step_by_step(test)

    def _step_by_step(self, stairs: Staircase) -> "list[Validation]":
        """Return a staircase whose steps are judged one by one; it is not judged as a whole."""
        validations = []
        for step in range(len(stairs.levels_v)):
            at = stairs.start_s + step * stairs.dwell_s
            without = self._without([(at - BEFORE_S, at + stairs.dwell_s - BEFORE_S)])
            if self._shows_all(without):
                validations.append(self._validated(self._line(without), stairs.name, at))
        return validations

    def _without(self, apart: Sequence[tuple[float, float]]) -> "Levels":
        values = {quantity.name: quantity.value for quantity in self.line.parameters} | self.line.held
        linear = self.fingerprint.values
        return levels_beside(
            linear,
            self.signals,
            self.trial.campaign,
            self.trial.vessel,
            kinds=kinds_of(self.line),
            start=values,
            apart=apart,
        )

    def _shows_all(self, levels: "Levels") -> bool:
        linear = {quantity.name for quantity in self.fingerprint.parameters}
        return {quantity.name for quantity in self.line.parameters} - linear == set(levels.names)

    def _line(self, levels: "Levels") -> LineWithLimits:
        return line_with_limits(
            self.fingerprint, levels, vessel=self.trial.vessel, working_point=self.signals.working_point
        )

    def _validated(self, line: LineWithLimits, name: str, step_s: float | None = None) -> "Validation":
        def chosen(excerpt: "Excerpt") -> bool:
            return step_s is None or excerpt.step_s == step_s

        return validate(
            limited_model(line),
            self.signals,
            self.trial.campaign,
            rng=self.rng,
            records=(name,),
            predict=_prediction.simulated_prediction,
            quadratic_propeller=False,
            chosen=chosen,
        )


def limits_of(fingerprint: Fingerprint) -> LineWithLimits:
    """Return the line with limits of a fingerprint.

    Raises FingerprintError if limits were not looked for.
    """
    if fingerprint.with_limits is None:
        raise FingerprintError(
            f"fingerprint of {fingerprint.conditions.vessel}: expected a line with limits, found none; look for them "
            "with `shaftprint limits RECORDING -o FOLDER`, or use the linear model."
        )
    return fingerprint.with_limits


def kinds_of(line: LineWithLimits) -> "tuple[Kind, ...]":
    """Return the limits of a line, as they are looked for."""
    words = {number.limit for number in line.numbers}
    return tuple(kind for kind in _candidates.Kind if kind.value in words)


def with_validation(fingerprint: Fingerprint, validations: "Sequence[Validation]") -> Fingerprint:
    """Return a fingerprint that says what its model was worth on records that its fit had not seen.

    A validation that does not pass is a finding too.
    """
    if not validations:
        return fingerprint
    record = _record(validations[0])
    findings = (*fingerprint.findings, *([record.remark] if record.outcome == "fails" else []))
    return fingerprint.model_copy(update={"validation": record, "findings": findings})


def _record(validation: "Validation") -> ValidationRecord:
    """Return what a fingerprint keeps of a validation."""
    return ValidationRecord(
        model=validation.model.name,
        largest_error=validation.settings.largest_error,
        outcome=validation.outcome,
        headline=validation.headline,
        stretches=tuple(
            StretchRecord(
                record=comparison.excerpt.record,
                title=comparison.excerpt.title,
                outcome=comparison.outcome,
                error={misfit.output: misfit.error for misfit in comparison.misfits},
                interval_95={misfit.output: misfit.error_interval for misfit in comparison.misfits},
            )
            for comparison in validation.comparisons
            if not comparison.excerpt.in_sample
        ),
    )
