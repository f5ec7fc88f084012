"""What the judging commands do with a drive: validate, predict, compare structures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import click

from shaftprint.cli._command_group import end_with_no
from shaftprint.cli._drive_options import is_given
from shaftprint.cli._terminal import answer, print_findings, say
from shaftprint.cli.output._fingerprint_file import drive_fingerprint_at
from shaftprint.cli.output._json import give
from shaftprint.cli.output._progress import progress
from shaftprint.cli.output._tables import print_table, print_tables
from shaftprint.late import late

with late():
    import numpy as np

    from shaftprint.bench import _fit
    from shaftprint.bench._kept import kept_drive
    from shaftprint.bench._named import holding, named_drives
    from shaftprint.bench._predict import predict_files
    from shaftprint.bench._records import read_records
    from shaftprint.bench._structures import compare_in_time, without
    from shaftprint.bench._validate import identified_from, validate_drive
    from shaftprint.catalogue._own_structure import TypedName, chosen_structures
    from shaftprint.drive._drive import load_drive
    from shaftprint.forecast._ship_before_test import ShipBeforeTest
    from shaftprint.recording._recording import sha256_of
    from shaftprint.survey._fit_options import FitOptions
    from shaftprint.tables._drive import drive_prediction_table, time_comparison_table, validated_drive_table


def validate_on_the_bench(
    recordings: Sequence[Path], drive_file: Path, fingerprint: Path | None, name: TypedName | None, *, no_progress: bool
) -> None:
    """Print how well the model of a drive's fingerprint explains records that it was not identified from."""
    if fingerprint is None:
        raise click.UsageError("--drive needs --fingerprint, a result of identify from other records.")
    kept = drive_fingerprint_at(fingerprint)
    one = kept_drive(kept, load_drive(drive_file), own=None if name is None else chosen_structures([name])[0])
    with progress(hidden=no_progress) as steps:
        steps.begin("Simulating the records")
        records = read_records(recordings, one, hold=kept.inputs_hold)
        validated = validate_drive(kept, one, records)
    failed = [record.fit.record.name for record in validated if record.outcome == "fails"]
    headline = (
        f"The model fails on {len(failed)} of {len(validated)} records: {', '.join(failed)}."
        if failed
        else f"The model holds on all of {len(validated)} records."
    )
    answer(headline)
    give("missed", {record.fit.record.name: dict(record.missed) for record in validated})
    seen = identified_from(kept, [sha256_of(path) for path in recordings], records)
    if seen:
        say(f"A record was identified from too, {', '.join(seen)}: what it shows is no validation.")
    print_table(validated_drive_table(validated))
    if failed:
        end_with_no()


def predict_on_the_bench(
    drive_file: Path,
    inputs: Sequence[Path],
    names: Sequence[TypedName],
    noise: Mapping[str, float],
    fingerprint: Path | None,
    known: ShipBeforeTest,
) -> None:
    """Print the standard deviations that planned records would give."""
    if not inputs:
        raise click.UsageError("--drive needs --input, a file with the planned inputs; may be repeated.")
    (one,) = named_drives(load_drive(drive_file), names)
    kept = None if fingerprint is None else drive_fingerprint_at(fingerprint)
    predicted = predict_files(
        holding(one, known.held), inputs, kept=kept, noise_std=noise, values=known.values, priors=known.priors
    )
    give("deviations", predicted.deviations)
    lost = [name for name, std in predicted.deviations.items() if not np.isfinite(std)]
    answer("The records would tell every parameter." if not lost else f"Not told: {', '.join(lost)}.")
    say(predicted.noise_source)
    print_table(drive_prediction_table(predicted.parameters, predicted.values, predicted.deviations))


def compare_structures_on_the_bench(
    recordings: Sequence[Path],
    drive_file: Path,
    names: Sequence[TypedName],
    left_out: Sequence[str],
    options: FitOptions,
    *,
    no_progress: bool,
) -> None:
    """Print which structure the records of a drive want."""
    named = named_drives(load_drive(drive_file), names, options)
    drives = [*named, *(without(named[0], [name]) for name in left_out)]
    with progress(hidden=no_progress) as steps:
        steps.begin("Reading the records")
        records = read_records(recordings, drives[0])
        steps.begin("Fitting the structures")
        starts = options.starts if is_given("starts") else _fit.STARTS
        comparison = compare_in_time(drives, records, rng=np.random.default_rng(options.seed), starts=starts)
    best = comparison.candidates[0].name
    print_findings(f"Which structure: {best}", comparison.sentences, is_answer=True)
    give("criteria", {one.name: one.bic for one in comparison.candidates})
    print_tables([time_comparison_table(comparison)])
