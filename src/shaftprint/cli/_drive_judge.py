"""What the judging commands do with a drive: compare, validate, predict, compare structures."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import click
import numpy as np

from shaftprint.bench._compare import drive_differences
from shaftprint.bench._fit import STARTS
from shaftprint.bench._per_record import all_parameters, free_parameters
from shaftprint.bench._predict import noise_words, predict_drive, predicted_at
from shaftprint.bench._records import read_records
from shaftprint.bench._structures import compare_in_time, without
from shaftprint.bench._validate import identified_from, validate_drive
from shaftprint.catalogue._own_structure import TypedName
from shaftprint.cli._drive_options import drive_fingerprint_at, equipped_drive, file_sha256, holding, is_given, kept_one
from shaftprint.cli._terminal import answer, print_findings, say
from shaftprint.cli.output._json import give
from shaftprint.cli.output._progress import progress
from shaftprint.cli.output._tables import print_table, print_tables
from shaftprint.fingerprint._drive_fingerprint import DriveFingerprint
from shaftprint.forecast._ship_before_test import ShipBeforeTest
from shaftprint.survey._fit_options import FitOptions
from shaftprint.tables._drive import (
    drive_difference_table,
    drive_prediction_table,
    time_comparison_table,
    validated_drive_table,
)


def compare_on_the_bench(named: Mapping[str, DriveFingerprint]) -> None:
    """Print what differs between fingerprints of a drive; all are compared with the first."""
    (first_name, first), *others = named.items()
    for name, other in others:
        found = drive_differences(first, other)
        doubtful = [label for label, one in ((first_name, first), (name, other)) if not one.verdict.trustworthy]
        differing = [one.first.name for one in found if one.outcome == "differs"]
        words = f"Yes: {', '.join(differing)}." if differing else "No difference is seen that chance would not make."
        if doubtful:
            words = f"It cannot be told: not trustworthy: {', '.join(doubtful)}."
        answer(f"Has the drive changed{f', {name}' if len(others) > 1 else ''}? {words}")
        give(f"differences {name}", {one.first.name: one for one in found})
        print_table(drive_difference_table(first_name, name, found))


def validate_on_the_bench(
    recordings: Sequence[Path], drive_file: Path, fingerprint: Path | None, name: TypedName | None, *, no_progress: bool
) -> None:
    """Print how well the model of a drive's fingerprint explains records that it was not identified from."""
    if fingerprint is None:
        raise click.UsageError("--drive needs --fingerprint, a result of identify from other records.")
    kept = drive_fingerprint_at(fingerprint)
    one = kept_one(kept, drive_file, name)
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
    seen = identified_from(kept, [file_sha256(path) for path in recordings], records)
    if seen:
        say(f"A record was identified from too, {', '.join(seen)}: what it shows is no validation.")
    print_table(validated_drive_table(validated))


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
    (one,) = equipped_drive(drive_file, names)
    one, values, priors = holding(one, known.held), known.values, known.priors
    kept = None if fingerprint is None else drive_fingerprint_at(fingerprint)
    stds = _noise(kept) | dict(noise)
    records = read_records(inputs, one, planned=True, hold=kept is not None and kept.inputs_hold)
    names_of_all = {parameter.name for parameter in all_parameters(one, records)}
    at = {name: value for name, value in (kept.values if kept else {}).items() if name in names_of_all}
    at |= values
    deviations = predict_drive(one, records, noise_std=stds, kept=kept, values=at, priors=priors)
    give("deviations", deviations)
    lost = [name for name, std in deviations.items() if not np.isfinite(std)]
    answer("The records would tell every parameter." if not lost else f"Not told: {', '.join(lost)}.")
    say(noise_words(kept, records))
    assumed = predicted_at(one, records, values=at, priors=priors)
    print_table(drive_prediction_table(free_parameters(one, records), assumed, deviations))


def _noise(kept: DriveFingerprint | None) -> dict[str, float]:
    """Return the largest noise of each output that a fingerprint has seen."""
    records = () if kept is None else kept.records
    found: dict[str, float] = {}
    for record in records:
        for name, std in record.noise_std.items():
            found[name] = max(found.get(name, 0.0), std)
    return found


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
    named = equipped_drive(drive_file, names, options)
    drives = [*named, *(without(named[0], [name]) for name in left_out)]
    with progress(hidden=no_progress) as steps:
        steps.begin("Reading the records")
        records = read_records(recordings, drives[0])
        steps.begin("Fitting the structures")
        starts = options.starts if is_given("starts") else STARTS
        comparison = compare_in_time(drives, records, rng=np.random.default_rng(options.seed), starts=starts)
    best = comparison.candidates[0].name
    print_findings(f"Which structure: {best}", comparison.sentences, is_answer=True)
    give("criteria", {one.name: one.bic for one in comparison.candidates})
    print_tables([time_comparison_table(comparison)])
