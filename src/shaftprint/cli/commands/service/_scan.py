"""``shaftprint service scan``: what logs of ordinary service would tell."""

from __future__ import annotations

import contextlib
from collections import Counter
from datetime import UTC, datetime
from pathlib import Path

import click

from shaftprint.cli._command_group import NOT_REACHED
from shaftprint.cli._next import first_plan, free, print_next
from shaftprint.cli._options import vessel_option
from shaftprint.cli._terminal import answer, print_findings, say
from shaftprint.cli._vessel_file import print_disagreements
from shaftprint.cli.output._file_to_write import expect_ending, expect_free
from shaftprint.cli.output._fingerprint_file import REPORT, fingerprint_of
from shaftprint.cli.output._json import give
from shaftprint.cli.output._output_folder import output_folder
from shaftprint.cli.output._progress import no_progress_option, progress
from shaftprint.cli.output._tables import print_tables
from shaftprint.late import late
from shaftprint.plain_table import Column, Table

with late():
    from shaftprint.report._service_page import render_service
    from shaftprint.service._scan import Scan, scan
    from shaftprint.service._segment_file import channel_file
    from shaftprint.tables._service import asked_table
    from shaftprint.vessel._vessel import load_vessel


@click.command("scan")
@click.argument("logs", nargs=-1, required=True, type=click.Path(path_type=Path))
@vessel_option
@click.option(
    "--fingerprint",
    type=click.Path(path_type=Path),
    help="One of an earlier test or of other days, against which the clock of the lever is held.",
)
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    help="Table of segments to write (CSV); what their channels did goes beside it, for service fit.",
)
@click.option(
    "--page",
    type=click.Path(path_type=Path),
    help="Folder for a page with every move in its place in the logs.",
)
@click.option("--force", is_flag=True, help="Replace an existing table or page.")
@no_progress_option
@click.pass_context
def command(
    context: click.Context,
    logs: tuple[Path, ...],
    *,
    vessel: str,
    fingerprint: Path | None,
    output: Path | None,
    page: Path | None,
    force: bool,
    no_progress: bool,
) -> None:
    """Find the moves of the lever in logs, and say what they would tell.

    LOGS are the files of one logger in order of time, in any readable format. Around each move a segment of half a
    minute is cut out, with its swing, what the ship was doing, what it tells about each number were all others known,
    and why it is not used. Edit the column `used` of the table to take segments out. A log that shows less than every
    value, a lever that follows the load, a ship with way on, or a clock that is off ends with code 3 and the cause.
    """
    if output is not None:
        expect_ending(output, ".csv")
        expect_free(output, force=force)
        expect_free(channel_file(output), force=force)
    # a folder that cannot be written is refused before a week of logs is read
    place = contextlib.nullcontext() if page is None else output_folder(page, of="service scan", force=force)
    with place as folder:
        installation = load_vessel(vessel)
        print_disagreements(installation, vessel, is_recorded=True)
        earlier = fingerprint_of(installation, fingerprint)
        with progress(hidden=no_progress) as steps:
            steps.begin("Reading", total=1.0)
            found = scan(logs, installation, fingerprint=earlier, progress=steps.reach)
        if output is not None and found.line is not None:
            found.write(output)
        if folder is not None:
            render_service(folder, found, vessel=installation.name, now=datetime.now(UTC))
    answer(found.headline)
    give("scan", _as_given(found))
    print_tables(_tables(found))
    if found.left_out:
        print_findings("Could not be read", found.left_out)
    if output is not None and found.line is not None:
        say(f"{output}: {len(found.segments)} segments, {len(found.used)} of them used.")
    if page is not None:
        say(f"{page / REPORT}: the moves in their places.")
    if found.refused:
        context.exit(NOT_REACHED)
    against = () if fingerprint is None else ("--fingerprint", fingerprint)
    if not found.used:
        print_next(*first_plan(vessel, installation))
    elif output is None:
        print_next("service", "scan", *logs, "--vessel", vessel, *against, "-o", free("segments.csv"))
    else:
        print_next("service", "fit", output, "--vessel", vessel, *against, "-o", free("day"))


def _as_given(found: Scan) -> dict[str, object]:
    return {
        "moves": len(found.segments),
        "used": len(found.used),
        "seconds": found.seconds,
        "std": found.accuracy,
        "refused": found.refused,
        "found": found.found,
        "line": found.line,
        "segments": found.rows,
    }


def _tables(found: Scan) -> list[Table]:
    """Return what the ship was doing, why moves are not used, and what was asked of the log."""
    reasons = Counter(one.reason for one in found.segments if one.reason)
    tables = [
        Table(
            title="What the ship was doing",
            columns=(Column("state"), Column("minutes", number=True)),
            rows=tuple((name, f"{seconds / 60.0:.1f}") for name, seconds in sorted(found.seconds.items())),
        )
    ]
    if reasons:
        tables.append(
            Table(
                title="Moves of the lever that are not used",
                columns=(Column("why"), Column("moves", number=True)),
                rows=tuple((reason, str(count)) for reason, count in reasons.most_common()),
            )
        )
    if found.found:
        tables.append(asked_table(found))
    return tables
