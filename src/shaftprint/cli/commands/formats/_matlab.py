"""``shaftprint export matlab``: a model for MATLAB and Octave."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import click

from shaftprint.cli._options import NAMES
from shaftprint.cli._terminal import answer
from shaftprint.cli.commands.formats._exported import (
    file_to_write,
    fingerprint_argument,
    force_option,
    linear_option,
    model_to_export,
    set_option,
    structure_option,
)
from shaftprint.cli.output._fingerprint_file import fingerprint_at
from shaftprint.cli.output._progress import no_progress_option, progress
from shaftprint.late import late

with late():
    from shaftprint.catalogue._own_structure import TypedName
    from shaftprint.export._matlab import write_matlab
    from shaftprint.models._structure import Structure
    from shaftprint.spectra._frequency_response import FrequencyResponse
    from shaftprint.survey._measurement import measure, response_of
    from shaftprint.survey._trial import load_trial


@click.command("matlab")
@fingerprint_argument
@structure_option
@linear_option
@set_option
@click.option(
    "--recording",
    type=click.Path(path_type=Path),
    help="Recording whose measured response, with covariance, is to stand beside the model's; needs --vessel and "
    "--campaign.",
)
@click.option("--vessel", help=f"Vessel file of the recording: {NAMES} stan-tug-1205.")
@click.option("--campaign", help=f"Campaign file of the recording: {NAMES} thesis.")
@click.option(
    "-o", "--output", type=click.Path(path_type=Path), help="Data file to write; named after the vessel by default."
)
@force_option
@no_progress_option
def command(
    fingerprint: Path,
    structure: TypedName | None,
    linear: bool,
    given: Mapping[str, float],
    recording: Path | None,
    vessel: str | None,
    campaign: str | None,
    output: Path | None,
    force: bool,
    no_progress: bool,
) -> None:
    """Write a .mat file and a function for MATLAB and Octave that rebuilds the objects.

    FINGERPRINT is the JSON file, or the folder in which identify or demo has put it. The function is
    written beside the data: called in MATLAB it makes the state space with its delays, frd and idfrd
    objects; in bare Octave it computes the response.
    """
    model = model_to_export(fingerprint, structure, given, linear=linear)
    path = file_to_write(output, model, ".mat", inputs=(fingerprint, recording), force=force)
    measured = None
    if recording is not None:
        if vessel is None or campaign is None:
            raise click.UsageError("--recording needs --vessel and --campaign, which say what is in it.")
        measured = _measured(
            fingerprint, model.structure, recording, vessel=vessel, campaign=campaign, no_progress=no_progress
        )
    written = write_matlab(model, path, measured=measured, overwrite=force)
    answer(written.data)
    answer(written.script)


def _measured(
    fingerprint: Path, structure: Structure, recording: Path, *, vessel: str, campaign: str, no_progress: bool
) -> FrequencyResponse:
    """Return the measured response that the structure describes, prepared as for the fingerprint."""
    mode = fingerprint_at(fingerprint).conditions.mode
    with progress(hidden=no_progress) as steps:
        measurement = measure(recording, load_trial(vessel, campaign), mode=mode, progress=steps)
    return response_of(structure, measurement.responses)
