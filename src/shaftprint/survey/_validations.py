"""The identified model against chirps and staircases of the same recording."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.errors import IdentificationError, ValidationError
from shaftprint.fingerprint._fingerprint import Fingerprint
from shaftprint.identify.fit._identification import Identification
from shaftprint.late import late
from shaftprint.survey._measurement import Measurement
from shaftprint.survey._progress import SILENT, Progress
from shaftprint.survey._trial import Trial
from shaftprint.survey._validation_apart import validated_apart

with late():
    from shaftprint.validation._validate import validate

if TYPE_CHECKING:
    from shaftprint.validation._validation import Validation


INPUTS, OUTPUTS = ("n_set",), {"n", "M_s"}


def validations_of(
    identification: Identification,
    measurement: Measurement,
    trial: Trial,
    *,
    rng: np.random.Generator,
    progress: Progress = SILENT,
) -> "tuple[tuple[Validation, ...], tuple[str, ...]]":
    """Return an identified model held against records that it has not seen, none where there are none; and remarks.

    A record that cannot be used is no reason to give up a fingerprint: the remark says why.

    ``identification``: the fit. ``measurement``, ``trial``: what it was made from. ``rng``: for the parameter sets that
    bands are drawn from.
    """
    structure, campaign = identification.structure, trial.campaign
    if structure.inputs != INPUTS or set(structure.outputs) != OUTPUTS:
        return (), ()
    if not campaign.chirps and not campaign.staircases:
        return (), ()
    progress.begin("Holding the model against records that it has not seen")
    try:
        return (validate(identification, measurement.signals, campaign, rng=rng),), ()
    except ValidationError as error:
        return (), (f"The model is not validated: {error}",)


def validations_with_limits(
    fingerprint: Fingerprint,
    measurement: Measurement,
    trial: Trial,
    *,
    rng: np.random.Generator,
    progress: Progress = SILENT,
) -> "tuple[tuple[Validation, ...], tuple[str, ...]]":
    """Return the line with its limits, each stretch judged by a fit that did not use it; and remarks."""
    if not trial.campaign.chirps and not trial.campaign.staircases:
        return (), ()
    try:
        return (validated_apart(fingerprint, measurement.signals, trial, rng=rng, progress=progress),), ()
    except (ValidationError, IdentificationError) as error:
        return (), (f"The model is not validated: {error}",)


def failed_steps(validations: "Sequence[Validation]") -> list[str] | None:
    """Return the steps that a model does not predict, by record and title; None where it was held against none."""
    steps = [one for validation in validations for one in validation.comparisons if one.excerpt.kind == "step"]
    failed = [f"{one.excerpt.record} {one.excerpt.title}" for one in steps if one.outcome == "fails"]
    return failed if steps else None
