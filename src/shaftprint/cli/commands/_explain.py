"""``shaftprint explain``: where the numbers of the thesis' way come from."""

from __future__ import annotations

from pathlib import Path

import click

from shaftprint.cli._options import campaign_option, vessel_option
from shaftprint.cli._results import print_paths, write_results
from shaftprint.cli._terminal import say
from shaftprint.cli.output._output_folder import force_option, output_folder
from shaftprint.cli.output._progress import no_progress_option, progress
from shaftprint.cli.output._tables import print_table
from shaftprint.digits import plain_letters
from shaftprint.late import late

with late():
    import numpy as np

    from shaftprint.report.thesis import _words
    from shaftprint.report.thesis._explanation import Explanation, explain_thesis
    from shaftprint.report.thesis._words import explanation_sentences
    from shaftprint.survey._measurement import measure
    from shaftprint.survey._survey import Survey, fingerprint_of
    from shaftprint.survey._thesis_way import line_selections, thesis_way, weighted_fits
    from shaftprint.survey._trial import load_trial


@click.command("explain")
@click.argument("recording", type=click.Path(path_type=Path))
@vessel_option
@campaign_option
@click.option("--seed", type=click.IntRange(min=0), default=1, show_default=True, help="Seed of the starts.")
@click.option("-o", "--output", type=click.Path(path_type=Path), help="Folder for fingerprint, figures and report.")
@force_option
@no_progress_option
def command(
    recording: Path, vessel: str, campaign: str, seed: int, output: Path | None, force: bool, no_progress: bool
) -> None:
    """Explain the numbers of the thesis' method on one recording.

    Fits the structures of the thesis the thesis' way and the gauge-aware one, and shows side by side where the
    inertia time that is too small, the damping that is missing between 1 and 10 rad/s, the K_p that
    drifts and the K_i that is always the same come from. With --output the whole report is written too.
    """
    trial, rng = load_trial(vessel, campaign), np.random.default_rng(seed)
    with progress(hidden=no_progress) as steps:
        measurement = measure(recording, trial, progress=steps)
        fits = weighted_fits(measurement, trial, rng=rng, progress=steps)
        other = measure(recording, trial, mode="thesis", progress=steps)
        thesis = thesis_way(other, trial, rng=rng, progress=steps)
    by_name = {fit.structure.name: fit for fit in fits}
    explanation = explain_thesis(thesis, by_name, measurement.spectra.response, trial.vessel)
    if output is not None:
        with output_folder(output, of="explain", force=force) as folder, progress(hidden=no_progress) as steps:
            steps.begin("Finding the intervals")
            fingerprint = fingerprint_of(fits[0], measurement, trial)
            survey = Survey(trial=trial, measurement=measurement, fits=fits, fingerprint=fingerprint)
            other_ways = line_selections(measurement, trial)
            write_results(folder, recording, survey, steps=steps, thesis=thesis, line_selection=other_ways)
    _print(explanation)
    if output is not None:
        print_paths(output)


def _print(explanation: Explanation) -> None:
    tables = (_words.inertia_table, _words.damping_table, _words.gain_table, _words.integral_table)
    for sentence, make in zip(explanation_sentences(explanation), tables, strict=True):
        print_table(make(explanation))
        say(f"{plain_letters(sentence)}\n")
