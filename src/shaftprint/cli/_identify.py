"""``shaftprint identify``: from a recording to a fingerprint."""

from dataclasses import replace
from pathlib import Path

import click

from shaftprint.cli._chain import fingerprint_of, fit, measure
from shaftprint.cli._comparison_tables import print_comparison
from shaftprint.cli._comparisons import comparisons_of
from shaftprint.cli._fingerprint_tables import print_findings, print_fingerprint
from shaftprint.cli._fit_options import FitOptions, fit_options, settings_of, structures_of
from shaftprint.cli._fit_tables import print_fits
from shaftprint.cli._inputs import campaign_option, load_trial, structure_sources, vessel_option
from shaftprint.cli._output_folder import force_option, output_folder
from shaftprint.cli._own_structure import OWN_FILE_HELP, TypedName
from shaftprint.cli._progress import no_progress_option, progress
from shaftprint.cli._results import print_paths, write_results
from shaftprint.cli._validations import failed_steps, validations_of
from shaftprint.limits import limit_hints


@click.command("identify")
@click.argument("recording", type=click.Path(path_type=Path))
@vessel_option
@campaign_option
@click.option(
    "--structure",
    "names",
    multiple=True,
    default=("GAUGE-CLOSED",),
    show_default=True,
    metavar="NAME",
    help=f"Model structure: {OWN_FILE_HELP}. The fingerprint is of the first, others are fitted beside it.",
)
@fit_options
@click.option("-o", "--output", required=True, type=click.Path(path_type=Path), help="Folder for the results.")
@force_option
@no_progress_option
def command(
    recording: Path,
    vessel: str,
    campaign: str,
    names: tuple[TypedName, ...],
    options: FitOptions,
    output: Path,
    force: bool,
    no_progress: bool,
) -> None:
    """Identify the fingerprint from a recording.

    Writes the fingerprint as JSON, the figures and a report into a folder, and prints the tables.
    --structure, --prior, --free and --hold may be repeated.
    """
    structures = structures_of(names, options)
    trial = load_trial(vessel, campaign)
    trial = replace(trial, sources=(*trial.sources, *structure_sources(names)))
    with output_folder(output, of="identify", force=force) as folder, progress(hidden=no_progress) as steps:
        measurement = measure(recording, trial, mode=options.mode, steps=steps)
        settings = settings_of(structures, measurement, trial, options)
        fits = fit(structures, measurement, settings=settings, seed=options.seed, steps=steps)
        steps.begin("Finding the intervals")
        fingerprint = fingerprint_of(fits[0], measurement, trial)
        comparisons = comparisons_of(fits, seed=options.seed, steps=steps)
        validations = validations_of(fits[0], measurement, trial, seed=options.seed, steps=steps)
        write_results(
            folder,
            recording,
            trial,
            measurement,
            fits,
            fingerprint,
            steps=steps,
            comparisons=comparisons,
            validations=validations,
        )
    print_fingerprint(fingerprint)
    print_findings("Limits", limit_hints(measurement.spectra.harmonics, failed_steps(validations)))
    if len(fits) > 1:
        print_fits("All structures", fits)
    for comparison in comparisons:
        print_comparison(comparison)
    print_paths(output)
