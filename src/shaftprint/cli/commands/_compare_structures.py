"""``shaftprint compare-structures``: which of several structures a recording wants."""

from __future__ import annotations

from pathlib import Path

import click

from shaftprint.cli._drive_judge import compare_structures_on_the_bench
from shaftprint.cli._drive_options import drive_option, expect_not_given, only_recording
from shaftprint.cli._fit_options import fit_options
from shaftprint.cli._options import OWN_FILE_HELP, campaign_option, vessel_option
from shaftprint.cli._results import print_comparison
from shaftprint.cli.output._progress import no_progress_option, progress
from shaftprint.late import late

with late():
    import numpy as np

    from shaftprint.catalogue._own_structure import TypedName
    from shaftprint.identify.comparison._compare import compare_jointly, expect_comparable
    from shaftprint.survey._fit_options import FitOptions
    from shaftprint.survey._measurement import measure, pairs_of
    from shaftprint.survey._survey import settings_by_name
    from shaftprint.survey._trial import load_trial


@click.command("compare-structures")
@click.argument("recordings", metavar="RECORDING...", nargs=-1, required=True, type=click.Path(path_type=Path))
@drive_option
@vessel_option
@campaign_option
@click.option(
    "--structure",
    "names",
    multiple=True,
    metavar="NAME",
    help=f"Model structure, two or more of the same input and outputs: {OWN_FILE_HELP}.",
)
@click.option(
    "--folds",
    type=click.IntRange(min=0),
    default=5,
    show_default=True,
    help="Parts into which the lines are dealt, each to be predicted from the others; 0 for none.",
)
@click.option(
    "--without",
    "left_out",
    multiple=True,
    metavar="NAME",
    help="With --drive: the first structure once more without a parameter, which is held at zero; may be repeated.",
)
@fit_options
@no_progress_option
def command(
    recordings: tuple[Path, ...],
    drive_file: Path | None,
    vessel: str,
    campaign: str,
    names: tuple[TypedName, ...],
    folds: int,
    left_out: tuple[str, ...],
    options: FitOptions,
    no_progress: bool,
) -> None:
    """Compare model structures on a recording: which explains it best, and why.

    Each structure is fitted to the same lines, those of all legs where the campaign has legs. It wins that explains
    them with the fewest parameters (BIC); beside it stand a test of each fit, of each structure within a larger one,
    and how well each predicts lines that were left out. --structure, --prior, --free and --hold may be repeated.
    With --drive, structures are fitted to records in time and held against each other on a common noise.
    """
    if drive_file is not None:
        expect_not_given("folds")
        compare_structures_on_the_bench(recordings, drive_file, names, left_out, options, no_progress=no_progress)
        return
    if left_out:
        raise click.UsageError("--without is for drives; hold a parameter of a ship with --hold.")
    recording = only_recording(recordings)
    trial = load_trial(vessel, campaign)
    structures = options.structures(names, trial.vessel)
    expect_comparable(structures)
    with progress(hidden=no_progress) as steps:
        measurement = measure(recording, trial, mode=options.mode, progress=steps)
        steps.begin("Comparing the structures")
        comparison = compare_jointly(
            [pairs_of(structure, measurement) for structure in structures],
            rng=np.random.default_rng(options.seed),
            settings=settings_by_name(structures, measurement, trial, options.settings(structures)),
            folds=folds,
        )
    print_comparison(comparison, is_answer=True)
