"""The files of results that ``identify`` and ``demo`` leave behind."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from shaftprint.cli._chain import Measurement
from shaftprint.cli._fingerprint_file import FINGERPRINT, REPORT
from shaftprint.cli._inputs import Trial
from shaftprint.cli._progress import Steps
from shaftprint.cli._terminal import echo
from shaftprint.fingerprint import Fingerprint, write_fingerprint
from shaftprint.identify import Comparison, Identification
from shaftprint.recording import read_recording
from shaftprint.report import ThesisMode, render_report
from shaftprint.spectra import ExactBin, FrequencyResponse, HighestPeak, estimate_response
from shaftprint.validation import Validation


def write_results(
    folder: Path,
    recording: Path,
    trial: Trial,
    measurement: Measurement,
    fits: Sequence[Identification],
    fingerprint: Fingerprint,
    *,
    steps: Steps,
    comparisons: Sequence[Comparison] = (),
    thesis: ThesisMode | None = None,
    truth: Mapping[str, float] | None = None,
    validations: Sequence[Validation] = (),
) -> None:
    """Write fingerprint, figures and report into a folder.

    Parameters
    ----------
    folder
        Where they go.
    recording, trial, measurement
        What the fits were made from.
    fits
        Fitted structures; the fingerprint is that of the first.
    fingerprint
        What is kept.
    steps
        Progress of the command.
    comparisons
        Which of several structures the data want.
    thesis
        The same recording done the thesis' way, to compare.
    truth
        True values by name, where they are known.
    validations
        The first structure held against records that it has not seen.
    """
    write_fingerprint(fingerprint, folder / FINGERPRINT)
    steps.begin("Drawing the figures of the report", total=1.0)
    with read_recording(recording) as opened:
        render_report(
            folder,
            fingerprint=fingerprint,
            identification=fits[0],
            signals=measurement.signals,
            spectra=measurement.spectra,
            vessel=trial.vessel,
            campaign=trial.campaign,
            recording=opened,
            fits={found.structure.name: found for found in fits[1:]},
            comparisons=comparisons,
            thesis=thesis,
            truth=truth,
            line_selection=_line_selection(trial, measurement),
            sensitivity=(fits[0].structure,),
            validations=validations,
            progress=steps.reach,
        )


def print_paths(output: Path) -> None:
    """Print where fingerprint and report are."""
    echo(f"Fingerprint: {output / FINGERPRINT}")
    echo(f"Report:      {output / REPORT}")


def _line_selection(trial: Trial, measurement: Measurement) -> dict[str, FrequencyResponse]:
    """Return the response as other ways to measure a sine would have it."""
    others = {"bin of the line": ExactBin(), "highest peak": HighestPeak()}
    found = {"whole periods": measurement.spectra.response}
    for name, method in others.items():
        found[name] = estimate_response(measurement.signals, trial.campaign, method=method)
    return found
