"""``shaftprint demo``: the whole way, from a ship whose truth is known to its fingerprint."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import click

from shaftprint.cli._chain import Measurement, fingerprint_of, measure
from shaftprint.cli._comparison_tables import print_comparison
from shaftprint.cli._comparisons import comparisons_of
from shaftprint.cli._demo_summary import print_summary
from shaftprint.cli._demo_truth import fingerprint_truth
from shaftprint.cli._fingerprint_tables import print_fingerprint
from shaftprint.cli._fit_tables import print_fits
from shaftprint.cli._inputs import Trial, load_trial, settings_text
from shaftprint.cli._output_folder import force_option, output_folder
from shaftprint.cli._progress import Steps, no_progress_option, progress
from shaftprint.cli._results import print_paths, write_results
from shaftprint.cli._signal_tables import print_lines
from shaftprint.cli._terminal import echo
from shaftprint.cli._thesis_way import thesis_way, weighted_fits
from shaftprint.cli._validations import validations_of
from shaftprint.fingerprint import Fingerprint
from shaftprint.identify import Identification
from shaftprint.report import ThesisMode
from shaftprint.tug import Truth, sail

VESSEL = "stan-tug-1205"
FULL, SHORT = "thesis", "short"
RECORDING = "recording.nc"


@click.command("demo")
@click.option(
    "-o", "--output", type=click.Path(path_type=Path), default=Path("demo"), show_default=True,
    help="Folder for the recording and the results.",
)  # fmt: skip
@click.option("--seed", type=click.IntRange(min=0), default=1, show_default=True, help="Seed of noise and starts.")
@click.option("--short", is_flag=True, help="Sail a test of 14 minutes instead of the thesis' one of three hours.")
@force_option
@no_progress_option
def command(output: Path, seed: int, short: bool, force: bool, no_progress: bool) -> None:
    """Sail the simulated Stan Tug 1205 and identify it from its recording.

    The raw recording is written as a logger would write it, and the fingerprint is identified from that
    file alone. The truth is opened at the end, to be printed beside what was found.
    """
    campaign = SHORT if short else FULL
    trial = load_trial(VESSEL, campaign)
    with output_folder(output, of="demo", force=force) as folder, progress(hidden=no_progress) as steps:
        truth = _sail(folder, trial, campaign, seed=seed, steps=steps)
        found = _identify(folder / RECORDING, trial, seed=seed, steps=steps)
        true = fingerprint_truth(truth, found.fits[0].structure, found.measurement.signals)
        comparisons = comparisons_of(found.fits, seed=seed, steps=steps)
        write_results(
            folder,
            folder / RECORDING,
            trial,
            found.measurement,
            found.fits,
            found.fingerprint,
            steps=steps,
            comparisons=comparisons,
            thesis=found.thesis,
            truth=true,
            validations=validations_of(found.fits[0], found.measurement, trial, seed=seed, steps=steps),
        )
    _print(found, true)
    for comparison in comparisons:
        print_comparison(comparison)
    print_summary(found.fingerprint, true, found.thesis.identifications["OL1"])
    _print_paths(output)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Found:
    """What was identified from the recording alone."""

    measurement: Measurement
    fits: tuple[Identification, ...]
    thesis: ThesisMode
    fingerprint: Fingerprint


def _sail(folder: Path, trial: Trial, campaign: str, *, seed: int, steps: Steps) -> Truth:
    """Write the recording, its truth and both settings files into the folder."""
    steps.begin(f"Sailing {trial.campaign.duration_s:g} s", total=1.0)
    truth = sail(trial.vessel, trial.campaign, folder / RECORDING, seed=seed, progress=steps.reach)
    (folder / "vessel.toml").write_bytes(settings_text("vessel", VESSEL))
    (folder / "campaign.toml").write_bytes(settings_text("campaign", campaign))
    return truth


def _identify(recording: Path, trial: Trial, *, seed: int, steps: Steps) -> _Found:
    """Identify the gauge-aware structure and those of the thesis, and the latter once more the thesis' way."""
    measurement = measure(recording, trial, mode="shaftprint", steps=steps)
    fits = weighted_fits(measurement, trial, seed=seed, steps=steps)
    thesis = thesis_way(recording, trial, seed=seed, steps=steps)
    steps.begin("Finding the intervals")
    return _Found(
        measurement=measurement,
        fits=fits,
        thesis=thesis,
        fingerprint=fingerprint_of(fits[0], measurement, trial),
    )


def _print(found: _Found, true: Mapping[str, float]) -> None:
    print_lines(found.measurement.spectra)
    print_fits("Structures of the thesis, on the same signals, weighted by their noise", found.fits[1:])
    print_fits(
        "Structures of the thesis, signals and fits done the thesis' way", tuple(found.thesis.identifications.values())
    )
    print_fingerprint(found.fingerprint, truth=true)


def _print_paths(output: Path) -> None:
    echo(f"Recording:   {output / RECORDING}")
    print_paths(output)
    again = f"shaftprint identify {output / RECORDING} --vessel {output / 'vessel.toml'}"
    echo(f"Again:       {again} --campaign {output / 'campaign.toml'} -o again")
