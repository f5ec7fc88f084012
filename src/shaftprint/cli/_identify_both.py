"""``shaftprint identify --starboard``: both lines of a ship from one recording, and how they differ."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from shaftprint.cli._command_group import end_with_no
from shaftprint.cli._fingerprint_tables import print_found
from shaftprint.cli._report_options import ReportOptions
from shaftprint.cli._results import Report
from shaftprint.cli._terminal import answer, details, echo, say
from shaftprint.cli._vessel_file import print_disagreements
from shaftprint.cli.output._fingerprint_file import FINGERPRINT, REPORT
from shaftprint.cli.output._json import give
from shaftprint.cli.output._results_options import Results
from shaftprint.cli.output._tables import print_tables
from shaftprint.late import late

with late():
    import numpy as np

    from shaftprint.catalogue._own_structure import TypedName
    from shaftprint.drift._differ import differ
    from shaftprint.drift._words import finding_sentences
    from shaftprint.fingerprint._json_file import write_fingerprint
    from shaftprint.fingerprint._sources import structure_sources
    from shaftprint.report._comparison import render_comparison
    from shaftprint.report.comparison._cause_table import cause_table
    from shaftprint.report.comparison._differences import Difference, differences
    from shaftprint.report.comparison._tables import difference_table
    from shaftprint.report.comparison._vessel_file_words import vessel_file_sentences
    from shaftprint.report.sections._comparison_cover import change_in_words
    from shaftprint.survey._both_shafts import SurveyOfBoth, load_trials_of_both, run_both
    from shaftprint.survey._fit_options import FitOptions
    from shaftprint.survey._of_vessel import default_structure
    from shaftprint.survey._survey import judged
    from shaftprint.survey._wash import wash_sentences


COMPARISON = "comparison"


def identify_both_lines(
    recording: Path,
    vessels: tuple[str, str],
    campaign: str,
    names: Sequence[TypedName],
    options: FitOptions,
    results: Results,
    *,
    about: ReportOptions,
    report: Report | None,
    hints: Mapping[str, Any],
) -> None:
    """Identify both lines, print and write the results of each side and the comparison of both."""
    trials = load_trials_of_both(*vessels, campaign, about.conditions)
    for trial, file in zip(trials, vessels, strict=True):
        print_disagreements(trial.vessel, file, is_recorded=True)
    chosen = names or (default_structure(trials[0].vessel, trials[0].campaign),)
    structures = options.structures(chosen, trials[0].vessel)
    of_user = structure_sources(names)
    port, starboard = (replace(trial, sources=(*trial.sources, *of_user)) for trial in trials)
    with results.folder("identify") as folder:
        with results.progress() as steps:
            both = run_both(
                recording,
                (port, starboard),
                structures=structures,
                settings=options.settings(structures),
                seed=options.seed,
                tested_at=about.tested_at,
                judge=False,
                hints=hints,
                progress=steps,
            )
        _print(both)
        for side, survey in both.sides.items():
            (folder / side).mkdir()
            if report is None:
                write_fingerprint(survey.fingerprint, folder / side / FINGERPRINT)
                continue
            with results.progress() as steps:
                survey = judged(survey, rng=np.random.default_rng(options.seed), progress=steps)
                report.write(folder / side, recording, survey, hints=hints, steps=steps)
        if report is not None:
            known = {structure.name: structure for structure in structures}
            fingerprints = {side: one.fingerprint for side, one in both.sides.items()}
            render_comparison(folder / COMPARISON, fingerprints, structures=known, remarks=wash_sentences(both.washes))
    for side in both.sides:
        echo(f"Fingerprint of {side}: {results.output / side / FINGERPRINT}")
    if report is not None:
        echo(f"Comparison: {results.output / COMPARISON / REPORT}")
    if not all(survey.fingerprint.verdict.trustworthy for survey in both.sides.values()):
        end_with_no()


def _print(both: SurveyOfBoth) -> None:
    """Print the fingerprint of each side, then how they differ, and what the wash of each does to the other."""
    first, other = both.port.fingerprint, both.starboard.fingerprint
    finding, found = differ(first, other), differences(first, other)
    for side, survey in both.sides.items():
        print_found(survey.fingerprint, line=side)
    doubtful = [side for side, survey in both.sides.items() if not survey.fingerprint.verdict.trustworthy]
    words = change_in_words(found) if finding.because else " ".join(finding_sentences(finding))
    if doubtful:
        words = f"It cannot be told: not trustworthy: {', '.join(doubtful)}."
    answer(f"Is starboard other than port? {words}")
    give("differences", found)
    give("causes", finding)
    give("wash", both.washes)
    with details():
        if not finding.because:
            print_tables([cause_table("starboard", finding)])
        _print_differences(found)
    for sentence in (*vessel_file_sentences(first, other)[1:], *wash_sentences(both.washes)):
        say(sentence)


def _print_differences(found: tuple[Difference, ...]) -> None:
    physical = [one for one in found if not one.normalised]
    normalised = [one for one in found if one.normalised]
    print_tables([difference_table("port", "starboard", physical), difference_table("port", "starboard", normalised)])
