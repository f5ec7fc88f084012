"""The verb ``validate_fingerprint``: a saved model held against a recording."""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import frozen_float, known_part
from shaftprint.errors import FingerprintError
from shaftprint.fingerprint._design import expect_fingerprint_of
from shaftprint.fingerprint._fingerprint import Fingerprint
from shaftprint.fingerprint._model import identified_model, named_structure
from shaftprint.models._structure import Structure
from shaftprint.signals._signals import Signals
from shaftprint.survey._measurement import Measurement
from shaftprint.survey._progress import SILENT, Progress
from shaftprint.survey._trial import Trial
from shaftprint.survey._validation_apart import limited_model, limits_of, validated_apart
from shaftprint.units import rpm_from_rev_s
from shaftprint.validation._model import Model
from shaftprint.validation._prediction import Predict, linear_prediction, simulated_prediction
from shaftprint.validation._validate import validate
from shaftprint.validation._validation import Validation

# Parameters are normalised at the working point: at another one inertia times and gains are others.
_SAME_WORKING_POINT = 0.02


@dataclass(frozen=True, kw_only=True, slots=True)
class Asked:
    """What a model is to be held against: ``validate`` with a recording's campaign, its records and its seed."""

    records: tuple[str, ...] = ()
    """Chirps and staircases; empty for the usual ones."""
    used: tuple[str, ...] = ()
    """Tests that the model was identified from besides those that it names itself."""
    allow_in_sample: bool = False
    """Whether records of the identification are shown."""
    seed: int = 1
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


def validate_fingerprint(
    fingerprint: Fingerprint,
    measurement: Measurement,
    trial: Trial,
    asked: Asked,
    *,
    structure: Structure | None = None,
    linear: bool = False,
    quadratic_propeller: bool = True,
    progress: Progress = SILENT,
) -> Validation:
    """Return the model of a fingerprint held against a recording, with its limits where they were found.

    Parameters
    ----------
    fingerprint
        The model.
    measurement, trial
        The recording as it was measured, and what was asked in it.
    asked
        What the model is held against.
    structure
        Structure of the model for small signals, where it is not the shipped one that the fingerprint names.
    linear
        Whether that model is wanted although limits were found.
    quadratic_propeller
        Whether the torque of a linear model goes with the square of the speed.
    progress
        Is told what is being done.

    Raises
    ------
    FingerprintError
        If the fingerprint is of a ship of another design than the vessel file, the working points of both differ by
        more than 2 %, or the structure has other parameters.
    ValidationError
        If no stretch can be judged.
    """
    expect_fingerprint_of(trial.vessel, fingerprint)
    if fingerprint.with_limits is not None and not linear:
        return _with_limits(fingerprint, measurement, trial, asked, progress=progress)
    model = fingerprint_model(fingerprint, structure or named_structure(fingerprint), measurement.signals)
    return asked.validated(model, measurement.signals, trial, quadratic_propeller=quadratic_propeller)


def _with_limits(
    fingerprint: Fingerprint, measurement: Measurement, trial: Trial, asked: Asked, *, progress: Progress
) -> Validation:
    """Return the line with its limits held against a recording; against its own, by fits that did not use it.

    Raises FingerprintError if the working points of both differ by more than 2 %, or the fingerprint has no limits;
    ValidationError if no stretch can be judged.
    """
    signals, line = measurement.signals, limits_of(fingerprint)
    _expect_working_point(fingerprint, signals)
    if _is_of(fingerprint, signals):
        rng = np.random.default_rng(asked.seed)
        return validated_apart(fingerprint, signals, trial, rng=rng, records=asked.records or None, progress=progress)
    model = limited_model(line)
    return asked.validated(model, signals, trial, quadratic_propeller=False, predict=simulated_prediction)


def fingerprint_model(fingerprint: Fingerprint, structure: Structure, signals: Signals) -> Model:
    """Return the model of a fingerprint; the lines that it was identified from count where it is of this recording.

    Raises FingerprintError if the structure has other parameters than the fingerprint, or the working points of both
    differ by more than 2 %.
    """
    model = identified_model(fingerprint, structure)
    _expect_working_point(fingerprint, signals)
    return Model(
        name=fingerprint.structure,
        structure=model.structure,
        values=model.values,
        covariance=frozen_float(known_part(model.covariance)),
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
