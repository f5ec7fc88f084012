"""``shaftprint identify --drive``: from records of a drive to its fingerprint."""

from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np

from shaftprint.bench._equipped import EquippedDrive
from shaftprint.bench._fingerprint import drive_fingerprint
from shaftprint.bench._fit import STARTS, DriveFit, identify_drive
from shaftprint.bench._records import read_records
from shaftprint.bench._responses import RESPONSE_STARTS, identify_responses, read_responses
from shaftprint.catalogue._own_structure import TypedName
from shaftprint.cli._drive_options import drive_sources, equipped_drive, expect_not_given, is_given
from shaftprint.cli._results import print_paths
from shaftprint.cli._terminal import print_findings, say
from shaftprint.cli.output._fingerprint_file import FINGERPRINT
from shaftprint.cli.output._json import give
from shaftprint.cli.output._output_folder import output_folder
from shaftprint.cli.output._progress import Steps, progress
from shaftprint.cli.output._tables import print_tables
from shaftprint.fingerprint._drive_fingerprint import DriveFingerprint, write_drive_fingerprint
from shaftprint.report._drive_page import render_drive
from shaftprint.survey._fit_options import FitOptions
from shaftprint.tables._drive import drive_assumed_table, drive_record_table, drive_response_table
from shaftprint.tables._fingerprint import quantity_table


def identify_on_the_bench(
    recordings: Sequence[Path],
    drive_file: Path,
    names: Sequence[TypedName],
    options: FitOptions,
    output: Path,
    *,
    hints: Mapping[str, Any],
    pictures: bool,
    force: bool,
    no_progress: bool,
) -> None:
    """Identify a drive from its records, print what was found, and write fingerprint and page into a folder."""
    expect_not_given("vessel", "campaign", "legs", "tested_at", "conditions", "previous", "pdf")
    (one,) = equipped_drive(drive_file, names if is_given("names") else (), options)
    with output_folder(output, of="identify", force=force) as folder:
        with progress(hidden=no_progress) as steps:
            fit = _fitted(one, recordings, options, steps, hints)
        sources = drive_sources(recordings, drive_file, names if is_given("names") else ())
        fingerprint = drive_fingerprint(fit, sources=sources, now=datetime.now(UTC))
        print_drive(fingerprint)
        _write(folder, fit, fingerprint, pictures=pictures, no_progress=no_progress)
    print_paths(output)


def _fitted(
    one: EquippedDrive, paths: Sequence[Path], options: FitOptions, steps: Steps, hints: Mapping[str, Any]
) -> DriveFit:
    """Return the fit to records, or to frequency responses where the drive file says that the files hold these."""
    rng, starts = np.random.default_rng(options.seed), options.starts if is_given("starts") else None
    if one.drive.responses:
        steps.begin("Reading the responses")
        responses = read_responses(paths, one)
        steps.begin("Fitting the responses")
        return identify_responses(one, responses, rng=rng, starts=starts or RESPONSE_STARTS)
    steps.begin("Reading the records")
    records = read_records(paths, one, **hints)
    steps.begin("Fitting the records")
    return identify_drive(one, records, rng=rng, starts=starts or STARTS)


def _write(folder: Path, fit: DriveFit, fingerprint: DriveFingerprint, *, pictures: bool, no_progress: bool) -> None:
    write_drive_fingerprint(fingerprint, folder / FINGERPRINT)
    with progress(hidden=no_progress) as steps:
        steps.begin("Writing the report", total=1.0)
        render_drive(folder, fit, fingerprint, pictures=pictures, progress=steps.reach)


def print_drive(fingerprint: DriveFingerprint) -> None:
    """Print verdict, parameters, records and what was taken as known."""
    verdict = fingerprint.verdict
    print_findings(
        f"Verdict: {'trustworthy' if verdict.trustworthy else 'not trustworthy'}", verdict.sentences, is_answer=True
    )
    give("fingerprint", fingerprint)
    say(f"{fingerprint.drive}; structure {fingerprint.structure}")
    tables = [quantity_table("Identified parameters", fingerprint.parameters)]
    if fingerprint.combinations:
        tables.append(quantity_table("Combinations of parameters", fingerprint.combinations))
    tables.append(drive_response_table(fingerprint) if fingerprint.responses else drive_record_table(fingerprint))
    if fingerprint.priors or fingerprint.held:
        tables.append(drive_assumed_table(fingerprint))
    print_tables(tables)
