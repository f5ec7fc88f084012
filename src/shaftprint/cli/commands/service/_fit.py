"""``shaftprint service fit``: the fingerprint of a line from segments of its service."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path

import click

from shaftprint.cli._command_group import end_with_no
from shaftprint.cli._dates import Moment
from shaftprint.cli._fingerprint_tables import print_found
from shaftprint.cli._next import first_plan, free, print_next
from shaftprint.cli._options import vessel_option
from shaftprint.cli._results import print_paths
from shaftprint.cli._vessel_file import print_disagreements
from shaftprint.cli.output._fingerprint_file import FINGERPRINT, fingerprint_of
from shaftprint.cli.output._output_folder import force_option, output_folder
from shaftprint.cli.output._progress import no_progress_option, progress
from shaftprint.late import late

with late():
    from shaftprint.campaign._trial_conditions import load_trial_conditions
    from shaftprint.fingerprint._json_file import write_fingerprint
    from shaftprint.service._service_fit import fit_service
    from shaftprint.vessel._vessel import load_vessel


@click.command("fit")
@click.argument("segments", nargs=-1, required=True, type=click.Path(path_type=Path))
@vessel_option
@click.option(
    "--fingerprint",
    type=click.Path(path_type=Path),
    help="One of an earlier test or of other days to begin from; none of its numbers counts.",
)
@click.option(
    "--tested-at",
    type=Moment(),
    metavar="DATE",
    help="When the service began, such as 2026-03-31T09:30+02:00; by default as the first log says.",
)
@click.option(
    "--conditions",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Draught and water of these days; `shaftprint new conditions` writes such a file.",
)
@click.option(
    "-o",
    "--output",
    required=True,
    type=click.Path(path_type=Path),
    help="Folder for the fingerprint, and for what each segment tells.",
)
@force_option
@no_progress_option
def command(
    segments: tuple[Path, ...],
    *,
    vessel: str,
    fingerprint: Path | None,
    tested_at: datetime | None,
    conditions: Path | None,
    output: Path,
    force: bool,
    no_progress: bool,
) -> None:
    """Identify the fingerprint from the moves that a scan has found.

    SEGMENTS are tables that `shaftprint service scan -o` wrote, as edited since: one, or those of several days, which
    are fitted together. The fingerprint has the layout of one from a test, with ordinary service as its test. Beside
    it, for each segment, stand slope and curvature of the likelihood at its values, and with --fingerprint at those of
    that one too, which `shaftprint service watch` takes. A fit that is stopped goes on where it was when it is asked
    for again.
    """
    installation = load_vessel(vessel)
    print_disagreements(installation, vessel, is_recorded=True)
    earlier = fingerprint_of(installation, fingerprint)
    stated = None if conditions is None else load_trial_conditions(conditions)
    # the name of "." is that of the folder
    place = output.resolve()
    reached = place.parent / f".{place.name}.fit.json"
    with output_folder(output, of="service", force=force) as folder:
        with progress(hidden=no_progress) as steps:
            steps.begin("Fitting")
            day = fit_service(
                segments, installation, fingerprint=earlier, progress=reached, tested_at=tested_at, conditions=stated,
                now=datetime.now(UTC),
            )  # fmt: skip
        write_fingerprint(day.fingerprint, folder / FINGERPRINT)
        for name, text in day.files(against=earlier is not None).items():
            (folder / name).write_text(text, encoding="utf-8")
    reached.unlink(missing_ok=True)
    print_found(day.fingerprint)
    print_paths(output, report=False)
    if not day.fingerprint.verdict.trustworthy:
        print_next(*first_plan(vessel, installation))
        end_with_no()
    elif fingerprint is None:
        print_next("service", "fit", "OTHER", "--vessel", vessel, "--fingerprint", output, "-o", free("other-day"))
    else:
        print_next("service", "watch", output, "--vessel", vessel, "--against", fingerprint)
