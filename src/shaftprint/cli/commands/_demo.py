"""``shaftprint demo``: the whole way, from a ship whose truth is known to its fingerprint."""

from __future__ import annotations

from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

import click

from shaftprint.cli._fingerprint_tables import print_found
from shaftprint.cli._fleet_answers import print_answers, print_commands
from shaftprint.cli._fleet_demo import all_tested, fleet_of_the_demo, tests_of_the_demo
from shaftprint.cli._found import thesis_sentences
from shaftprint.cli._results import print_comparison, print_paths, write_results
from shaftprint.cli._signal_tables import print_lines
from shaftprint.cli._terminal import details, echo, say
from shaftprint.cli.output._output_folder import force_option, output_folder
from shaftprint.cli.output._progress import Steps, no_progress_option, progress
from shaftprint.cli.output._tables import print_table
from shaftprint.late import late

with late():
    import numpy as np

    from shaftprint.rehearsal._true_fingerprint import fingerprint_truth
    from shaftprint.spectra._frequency_response import FrequencyResponse
    from shaftprint.store._add import add
    from shaftprint.store._event import record_event
    from shaftprint.store._store import create_store
    from shaftprint.survey import _measurement, _thesis_way
    from shaftprint.survey._survey import Survey, survey_of
    from shaftprint.survey._thesis_mode import ThesisMode
    from shaftprint.survey._thesis_way import thesis_way, weighted_fits
    from shaftprint.survey._trial import Trial, load_trial, settings_text
    from shaftprint.tables._structures import fits_table
    from shaftprint.tug._sail import sail
    from shaftprint.tug._truth import Truth


VESSEL = "stan-tug-1205"
FULL, SHORT = "thesis", "short"
RECORDING, STORE = "recording.nc", "fleet.db"


@click.command("demo")
@click.option(
    "-o", "--output", type=click.Path(path_type=Path),
    help="Folder for the recording and the results: demo, with --fleet demo-fleet.",
)  # fmt: skip
@click.option("--seed", type=click.IntRange(min=0), default=1, show_default=True, help="Seed of noise and starts.")
@click.option("--short", is_flag=True, help="Sail a test of 14 minutes instead of the thesis' one of three hours.")
@click.option("--fleet", is_flag=True, help="Fill a store with eight sister ships over five years.")
@click.option("--keep-recordings", is_flag=True, help="With --fleet: keep the 80 raw recordings, 0.8 GB.")
@force_option
@no_progress_option
def command(
    output: Path | None, seed: int, short: bool, *, fleet: bool, keep_recordings: bool, force: bool, no_progress: bool
) -> None:
    """Simulate the Stan Tug 1205 and identify it from its recording.

    The raw recording is written as a logger would write it, and the fingerprint is identified from that
    file alone. The truth is opened at the end, to be printed beside what was found.

    With --fleet eight sister ships are tested twice a year for five years, and their fingerprints put into a store:
    propellers foul and are cleaned in dock, one governor is set lower, one injection wears.
    """
    if fleet:
        _fleet(output or Path("demo-fleet"), seed=seed, keep=keep_recordings, force=force, no_progress=no_progress)
    else:
        _ship(output or Path("demo"), seed=seed, short=short, force=force, no_progress=no_progress)


def _fleet(output: Path, *, seed: int, keep: bool, force: bool, no_progress: bool) -> None:
    """Sail, identify and keep the tests of the fleet, and say what its store tells."""
    with output_folder(output, of="demo", force=force) as folder, create_store(str(folder / STORE)) as store:
        fleet, tests = fleet_of_the_demo(seed), tests_of_the_demo()
        with progress(hidden=no_progress) as steps:
            steps.begin(f"{len(tests)} tests of {len(fleet.ships)} ships", total=float(len(tests)))
            for path in all_tested(tests, folder, seed=seed, recordings=folder if keep else None):
                add(store, path, now=datetime.now(UTC))
                steps.advance(1.0)
        noted = [(ship.name, work) for ship in fleet.ships for work in ship.works if work.is_noted]
        for name, work in noted:
            record_event(store, name, work.kind, at=work.at)
        print_answers(store)
    print_commands(output / STORE)


def _ship(output: Path, *, seed: int, short: bool, force: bool, no_progress: bool) -> None:
    campaign = SHORT if short else FULL
    trial = load_trial(VESSEL, campaign)
    with output_folder(output, of="demo", force=force) as folder:
        with progress(hidden=no_progress) as steps:
            truth = _sail(folder, trial, campaign, seed=seed, steps=steps)
            results = _identify(folder / RECORDING, trial, seed=seed, steps=steps)
        survey, thesis = results.survey, results.thesis
        true = fingerprint_truth(truth, survey.identification.structure, survey.signals)
        # the answer first: the report takes as long again
        further = thesis_sentences(survey.fingerprint, thesis.identifications["OL1"])
        print_found(survey.fingerprint, truth=true, further=further)
        with details():
            _print_details(survey, thesis)
        with progress(hidden=no_progress) as steps:
            write_results(
                folder,
                folder / RECORDING,
                survey,
                steps=steps,
                thesis=thesis,
                line_selection=results.line_selection,
                truth=true,
            )
    _print_paths(output)


def _sail(folder: Path, trial: Trial, campaign: str, *, seed: int, steps: Steps) -> Truth:
    """Write the recording, its truth and both settings files into the folder."""
    steps.begin(f"Sailing {trial.campaign.duration_s:g} s", total=1.0)
    truth = sail(trial.vessel, trial.campaign, folder / RECORDING, seed=seed, progress=steps.reach)
    (folder / "vessel.toml").write_bytes(settings_text("vessel", VESSEL))
    (folder / "campaign.toml").write_bytes(settings_text("campaign", campaign))
    return truth


@dataclass(frozen=True, kw_only=True, slots=True)
class _Results:
    """What the recording gives."""

    survey: Survey
    """The gauge-aware structure and those of the thesis."""
    thesis: ThesisMode
    """The latter once more the thesis' way."""
    line_selection: Mapping[str, FrequencyResponse]
    """The response by other ways to measure a sine."""


def _identify(recording: Path, trial: Trial, *, seed: int, steps: Steps) -> _Results:
    rng = np.random.default_rng(seed)
    with ThreadPoolExecutor(max_workers=1) as beside:
        # the file is read both ways at once: most of either is done by compiled code
        other = beside.submit(_measurement.measure, recording, trial, mode="thesis")
        measurement = _measurement.measure(recording, trial, progress=steps)
        selections = beside.submit(_thesis_way.line_selections, measurement, trial)
        fits = weighted_fits(measurement, trial, rng=rng, progress=steps)
        thesis = thesis_way(other.result(), trial, rng=rng, progress=steps)
        survey = survey_of(fits, measurement, trial, rng=rng, progress=steps)
        return _Results(survey=survey, thesis=thesis, line_selection=selections.result())


def _print_details(survey: Survey, thesis: ThesisMode) -> None:
    for remark in survey.remarks:
        say(remark)
    print_lines(survey.spectra)
    print_table(fits_table("Structures of the thesis, on the same signals, weighted by their noise", survey.fits[1:]))
    print_table(
        fits_table(
            "Structures of the thesis, signals and fits done the thesis' way", tuple(thesis.identifications.values())
        )
    )
    for comparison in survey.comparisons:
        print_comparison(comparison)


def _print_paths(output: Path) -> None:
    print_paths(output)
    again = f"shaftprint identify {output / RECORDING} --vessel {output / 'vessel.toml'}"
    echo(f"Again:       {again} --campaign {output / 'campaign.toml'} -o again")
    echo("Your ship:   shaftprint start")
