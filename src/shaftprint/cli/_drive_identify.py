"""``shaftprint identify --drive``: from records of a drive to its fingerprint."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from shaftprint.cli._command_group import end_with_no
from shaftprint.cli._drive_options import expect_not_given, is_given
from shaftprint.cli._found import drive_sentences
from shaftprint.cli._next import after_drive, print_next
from shaftprint.cli._results import print_paths
from shaftprint.cli._terminal import details, print_findings, say
from shaftprint.cli.output._fingerprint_file import FINGERPRINT
from shaftprint.cli.output._json import give
from shaftprint.cli.output._results_options import Results
from shaftprint.cli.output._tables import print_tables
from shaftprint.late import late

with late():
    import numpy as np

    from shaftprint.bench._fingerprint import drive_fingerprint
    from shaftprint.bench._identify import identify_files
    from shaftprint.bench._named import named_drives
    from shaftprint.bench._records import began_at
    from shaftprint.catalogue._own_structure import TypedName
    from shaftprint.drive._drive import load_drive
    from shaftprint.fingerprint._drive_fingerprint import DriveFingerprint
    from shaftprint.fingerprint._json_file import write_fingerprint
    from shaftprint.fingerprint._sources import source_of, structure_sources
    from shaftprint.report._drive_page import render_drive
    from shaftprint.survey._fit_options import FitOptions
    from shaftprint.tables._drive import drive_assumed_table, drive_record_table, drive_response_table
    from shaftprint.tables._fingerprint import combination_table, quantity_table


def identify_on_the_bench(
    recordings: Sequence[Path],
    drive_file: Path,
    names: Sequence[TypedName],
    options: FitOptions,
    results: Results,
    *,
    hints: Mapping[str, Any],
    tested_at: datetime | None,
    pictures: bool,
) -> None:
    """Identify a drive from its records, print what was found, and write fingerprint and page into a folder."""
    expect_not_given("vessel", "campaign", "legs", "conditions", "previous", "pdf")
    chosen = names if is_given("names") else ()
    (one,) = named_drives(load_drive(drive_file), chosen, options)
    with results.folder("identify") as folder:
        with results.progress() as steps:
            starts = options.starts if is_given("starts") else None
            rng = np.random.default_rng(options.seed)
            fit = identify_files(one, recordings, rng=rng, starts=starts, hints=hints, progress=steps)
        sources = (
            *(source_of("recording", path) for path in recordings),
            source_of("drive", drive_file),
            *structure_sources(chosen),
        )
        fingerprint = drive_fingerprint(
            fit, sources=sources, now=datetime.now(UTC), tested_at=tested_at or began_at(one, recordings, **hints)
        )
        print_drive(fingerprint, whole=False)
        write_fingerprint(fingerprint, folder / FINGERPRINT)
        with results.progress() as steps:
            steps.begin("Writing the report", total=1.0)
            render_drive(folder, fit, fingerprint, pictures=pictures, progress=steps.reach)
    print_paths(results.output)
    if fingerprint.verdict.trustworthy:
        print_next(*after_drive(drive_file, results.output))
    else:
        print_next("compare-structures", *recordings, "--drive", drive_file)
        end_with_no()


def print_drive(fingerprint: DriveFingerprint, *, whole: bool = True) -> None:
    """Print verdict, parameters, records and what was taken as known.

    ``whole``: whether all of it is the answer; otherwise it is the verdict and what was found, the rest are details.
    """
    verdict = fingerprint.verdict
    print_findings(f"Verdict: {verdict.words}", verdict.sentences, is_answer=True)
    give("fingerprint", fingerprint)
    if whole:
        _print_rest(fingerprint)
        return
    if verdict.trustworthy:
        print_findings("What was found", drive_sentences(fingerprint), is_answer=True)
    with details():
        _print_rest(fingerprint)


def _print_rest(fingerprint: DriveFingerprint) -> None:
    say(f"{fingerprint.drive}; structure {fingerprint.structure}")
    tables = [quantity_table("Identified parameters", fingerprint.parameters)]
    if fingerprint.combinations:
        tables.append(combination_table(fingerprint))
    tables.append(drive_response_table(fingerprint) if fingerprint.responses else drive_record_table(fingerprint))
    if fingerprint.priors or fingerprint.held:
        tables.append(drive_assumed_table(fingerprint))
    print_tables(tables)
