"""``shaftprint identify``: from a recording to a fingerprint."""

from __future__ import annotations

from pathlib import Path

import click

from shaftprint.cli._command_group import end_with_no
from shaftprint.cli._drive_options import drive_option, only_recording
from shaftprint.cli._fingerprint_tables import print_found
from shaftprint.cli._fit_options import fit_options
from shaftprint.cli._limit_tables import print_limits, print_line
from shaftprint.cli._next import print_steps
from shaftprint.cli._option_sections import SectionedCommand
from shaftprint.cli._options import (
    DEFAULT_HELP,
    NEEDED_BESIDE_DRIVE,
    OWN_FILE_HELP,
    READING_SECTION,
    campaign_option,
    hints_of,
    reading_options,
    reading_words,
    starboard_option,
    vessel_option,
)
from shaftprint.cli._report_options import ReportOptions, report_options
from shaftprint.cli._results import Report, print_comparison, print_paths
from shaftprint.cli._terminal import details, print_findings, say
from shaftprint.cli._vessel_file import print_disagreements
from shaftprint.cli.output._fingerprint_file import FINGERPRINT
from shaftprint.cli.output._json import give
from shaftprint.cli.output._progress import Steps
from shaftprint.cli.output._results_options import Results, results_options
from shaftprint.cli.output._tables import print_table
from shaftprint.late import late

with late():
    import numpy as np

    from shaftprint.catalogue._own_structure import TypedName
    from shaftprint.cli._after_test import after_test
    from shaftprint.cli._drive_identify import identify_on_the_bench
    from shaftprint.cli._identify_both import identify_both_lines
    from shaftprint.fingerprint._json_file import write_fingerprint
    from shaftprint.fingerprint._sources import structure_sources
    from shaftprint.rehearsal._true_fingerprint import fingerprint_truth, strips_without_truth
    from shaftprint.report.sections._black_box import black_box_sentence
    from shaftprint.survey._everything import with_everything
    from shaftprint.survey._fit_options import FitOptions
    from shaftprint.survey._limits import with_limits
    from shaftprint.survey._of_vessel import default_structure
    from shaftprint.survey._survey import Survey, judged, run
    from shaftprint.survey._trial import load_trial
    from shaftprint.tables._legs import leg_test_table
    from shaftprint.tables._structures import fits_table
    from shaftprint.tug._truth import read_truth


@click.command(
    "identify",
    cls=SectionedCommand,
    example="shaftprint identify log.csv --vessel mine.toml --campaign test.toml -o result",
    sections={
        NEEDED_BESIDE_DRIVE: ("--vessel", "--campaign", "--output", "--drive"),
        "Test": ("--leg", "--starboard", "--tested-at", "--conditions", "--previous"),
        "Model": ("--structure", "--with", "--prior", "--free", "--hold"),
        "Fit": ("--mode", "--unweighted", "--starts", "--seed"),
        "Report": ("--no-report", "--figures", "--pdf", "--truth"),
        **READING_SECTION,
    },
)
@click.argument("recordings", metavar="RECORDING...", nargs=-1, required=True, type=click.Path(path_type=Path))
@drive_option
@vessel_option
@campaign_option
@starboard_option
@click.option(
    "--structure",
    "names",
    multiple=True,
    metavar="NAME",
    help=f"Model structure: {OWN_FILE_HELP}. By default {DEFAULT_HELP}. The fingerprint is of the first, "
    "others are fitted beside it.",
)
@click.option("--figures", is_flag=True, help="Write every chart as SVG, PDF and PNG, too: half a minute more.")
@click.option("--leg", "legs", multiple=True, metavar="NAME", help="Leg of the campaign to use; all when not given.")
@click.option(
    "--with",
    "more",
    type=click.Choice(["limits", "all"]),
    help="limits: find the limits too, and put them into the line; all: fit sines, steps, chirps and limits at once.",
)
@click.option(
    "--no-report",
    "no_report",
    is_flag=True,
    help="Write the fingerprint alone: without page, validation and comparison of structures, in a few seconds.",
)
@click.option(
    "--truth",
    "truth_file",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Truth file that `sail` wrote beside a simulated recording: its numbers are printed beside those that were "
    "found, at the same working point.",
)
@fit_options
@results_options("Folder for the results.")
@report_options
@reading_options
def command(
    recordings: tuple[Path, ...],
    drive_file: Path | None,
    vessel: str,
    campaign: str,
    starboard: str | None,
    names: tuple[TypedName, ...],
    figures: bool,
    legs: tuple[str, ...],
    more: str | None,
    no_report: bool,
    truth_file: Path | None,
    options: FitOptions,
    results: Results,
    about: ReportOptions,
    **said: object,
) -> None:
    """Identify the fingerprint from a recording.

    Writes the fingerprint as JSON and a report with figures and tables into a folder, and prints the verdict and what
    was found; -v prints the tables too.
    --structure, --leg, --prior, --free and --hold may be repeated. With --drive, several recordings of
    one drive are fitted together. With --starboard both lines of a ship are identified from one
    recording and compared, each with results in a folder of its own.
    """
    of_ship = drive_file is None
    if more is not None and (not of_ship or options.mode != "shaftprint"):
        raise click.UsageError(f"--with {more} is for ships, and for signals of --mode shaftprint: leave it out.")
    if starboard is not None and not of_ship:
        raise click.UsageError("--starboard is for ships: leave out --drive.")
    if no_report and not of_ship:
        raise click.UsageError("--no-report is for ships, and a drive has a page that is made at once: leave it out.")
    if no_report and (figures or about.pdf):
        raise click.UsageError("--no-report goes with neither --figures nor --pdf: leave one of them out.")
    if truth_file is not None and (not of_ship or starboard is not None):
        raise click.UsageError("--truth goes with neither --drive nor --starboard: leave one of them out.")
    if starboard is not None and (more is not None or legs or options.mode != "shaftprint"):
        raise click.UsageError("--starboard goes with neither --with nor --leg, and with signals of shaftprint.")
    hints = hints_of(**said)
    if drive_file is not None:
        identify_on_the_bench(
            recordings,
            drive_file,
            names,
            options,
            results,
            hints=hints,
            tested_at=about.tested_at,
            pictures=figures,
        )
        return
    report = None if no_report else Report(about=about, pictures=figures)
    recording = only_recording(recordings)
    if starboard is not None:
        vessels = (vessel, starboard)
        identify_both_lines(
            recording, vessels, campaign, names, options, results, about=about, report=report, hints=hints
        )
        return
    # before the folder is made: a mistake in a file leaves none
    truth = None if truth_file is None else read_truth(truth_file)
    trial, rng = load_trial(vessel, campaign), np.random.default_rng(options.seed)
    print_disagreements(trial.vessel, vessel, is_recorded=True)
    structures = options.structures(names or (default_structure(trial.vessel, trial.campaign),), trial.vessel)
    with results.folder("identify") as folder:
        with results.progress() as steps:
            survey = run(
                recording,
                trial.vessel,
                trial.campaign,
                structures=structures,
                settings=options.settings(structures),
                mode=options.mode,
                sources=(*trial.sources, *structure_sources(names)),
                rng=rng,
                tested_at=about.tested_at,
                conditions=about.conditions,
                legs=legs,
                judge=False,
                hints=hints,
                progress=steps,
            )
        true = None if truth is None else fingerprint_truth(truth, survey.identification.structure, survey.signals)
        # the answer first: what follows takes as long again
        print_found(survey.fingerprint, truth=true)
        if truth is not None:
            print_findings(f"Not in {truth_file}", strips_without_truth(truth, survey.signals))
        with results.progress() as steps:
            survey = _with_more(survey, more, rng=rng, steps=steps)
        _print_line(survey)
        if report is None:
            write_fingerprint(survey.fingerprint, folder / FINGERPRINT)
        else:
            with results.progress() as steps:
                survey = judged(survey, rng=rng, progress=steps)
            _print_judgement(survey)
            with results.progress() as steps:
                report.write(folder, recording, survey, truth=true, hints=hints, steps=steps)
    print_paths(results.output, report=report is not None)
    following = after_test(
        (recording, vessel, campaign),
        (results.output, survey.fingerprint),
        trial.vessel,
        trial.campaign,
        reading=reading_words(**said),
        own=("--structure", names[0]) if names and ":" in names[0] else (),
        is_undecided=any(one.outcome == "undecided" for one in survey.validations[:1]),
    )
    print_steps(*following)
    if not survey.fingerprint.verdict.trustworthy:
        end_with_no()


def _with_more(survey: Survey, more: str | None, *, rng: np.random.Generator, steps: Steps) -> Survey:
    """Return the survey with what was asked for besides the sines or legs."""
    match more:
        case "limits":
            return with_limits(survey, progress=steps)
        case "all":
            return with_everything(survey, rng=rng.spawn(1)[0], progress=steps)
        case _:
            return survey


def _print_line(survey: Survey) -> None:
    """Print the limits and the line with them, where they were looked for."""
    line = survey.fingerprint.with_limits
    if survey.limit_fit is not None and line is not None:
        print_limits(survey.limit_fit)
        print_line(line)


def _print_judgement(survey: Survey) -> None:
    """Print which structure the data want where several were asked for; what is in the report too is a detail."""
    with details():
        for remark in survey.remarks:
            say(remark)
        if survey.leg_tests:
            print_table(leg_test_table(survey.leg_tests, p_value=survey.identification.p_value))
        print_findings("Limits", survey.limit_hints)
    if len(survey.fits) > 1:
        print_table(fits_table("All structures", survey.fits))
    if survey.black_boxes:
        with details():
            print_findings("Without physics", [black_box_sentence(one) for one in survey.black_boxes])
        give("black_box", [one.record for one in survey.black_boxes])
    for comparison in survey.comparisons:
        print_comparison(comparison)
