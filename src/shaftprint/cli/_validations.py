"""The identified model against chirps and staircases of the same recording, for the report."""

from collections.abc import Sequence

import numpy as np

from shaftprint.cli._chain import Measurement
from shaftprint.cli._inputs import Trial
from shaftprint.cli._progress import Steps
from shaftprint.cli._terminal import echo
from shaftprint.errors import ValidationError
from shaftprint.identify import Identification
from shaftprint.validation import Validation, validate

INPUTS, OUTPUTS = ("n_set",), {"n", "M_s"}


def validations_of(
    identification: Identification, measurement: Measurement, trial: Trial, *, seed: int, steps: Steps
) -> tuple[Validation, ...]:
    """Return what an identified model is worth on records that it has not seen; nothing where there are none.

    A record that cannot be used is no reason to give up a fingerprint: why is said on the terminal.

    Parameters
    ----------
    identification
        The fit.
    measurement, trial
        What it was made from.
    seed
        Seed of the parameter sets that bands are drawn from.
    steps
        Progress of the command.
    """
    structure = identification.structure
    campaign = trial.campaign
    if structure.inputs != INPUTS or set(structure.outputs) != OUTPUTS:
        return ()
    if not campaign.chirps and not campaign.staircases:
        return ()
    steps.begin("Holding the model against records that it has not seen")
    try:
        return (validate(identification, measurement.signals, campaign, rng=np.random.default_rng(seed)),)
    except ValidationError as error:
        echo(f"The model is not validated: {error}")
        return ()


def failed_steps(validations: Sequence[Validation]) -> list[str] | None:
    """Return the steps that a model does not predict, by record and title; None where it was held against none."""
    steps = [one for found in validations for one in found.comparisons if one.excerpt.kind == "step"]
    failed = [f"{one.excerpt.record} {one.excerpt.title}" for one in steps if one.outcome == "fails"]
    return failed if steps else None
