"""``shaftprint predict``: what a test would find, before it is made."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import click

from shaftprint.cli._drive_judge import predict_on_the_bench
from shaftprint.cli._drive_options import drive_option, expect_not_given
from shaftprint.cli._fingerprint_tables import print_assumed
from shaftprint.cli._known_values import by_name, named_value
from shaftprint.cli._limit_uses import print_limit_uses
from shaftprint.cli._option_sections import SectionedCommand
from shaftprint.cli._options import DEFAULT_HELP, NAMES, OWN_FILE_HELP, campaign_option
from shaftprint.cli._ship_options import known_options
from shaftprint.cli._terminal import print_findings, say
from shaftprint.cli._vessel_file import checked_vessel
from shaftprint.cli.output._json import give
from shaftprint.cli.output._progress import no_progress_option, progress
from shaftprint.cli.output._tables import print_table, print_tables
from shaftprint.digits import fine_unit, interval, plain, unit_text, with_deviation
from shaftprint.late import late
from shaftprint.plain_table import MEANING, Symbol, Table, numbers, texts

with late():
    from shaftprint.campaign._campaign import load_campaign
    from shaftprint.catalogue._own_structure import TypedName
    from shaftprint.drift._visible import VisibleChange
    from shaftprint.forecast._predict import PredictedTest, predict_test
    from shaftprint.forecast._ship_before_test import ShipBeforeTest
    from shaftprint.identify.fit._estimate import Estimate
    from shaftprint.identify.prediction._accuracy import Accuracy
    from shaftprint.identify.prediction._identifiability import Identifiability
    from shaftprint.identify.uncertainty._profile import Interval
    from shaftprint.spectra._frequency_response import FrequencyResponse


@click.command(
    "predict",
    cls=SectionedCommand,
    example="shaftprint predict --campaign test.toml --vessel mine.toml --from noise.csv",
    sections={
        "Test": ("--campaign", "--rpm-per-volt"),
        "What is known of the ship": (
            "--vessel", "--from", "--from-campaign", "--structure", "--prior", "--free", "--hold", "--value",
        ),
        "With --drive": ("--drive", "--input", "--noise", "--fingerprint"),
    },
)  # fmt: skip
@drive_option
@click.option(
    "--input",
    "inputs",
    multiple=True,
    type=click.Path(path_type=Path),
    help="With --drive: a file with the planned inputs, a column each; may be repeated.",
)
@click.option(
    "--noise",
    "noise",
    multiple=True,
    metavar="NAME=STD",
    type=named_value,
    callback=by_name,
    help="With --drive: noise of one sample of an output; may be repeated.",
)
@click.option(
    "--fingerprint",
    type=click.Path(path_type=Path),
    help="With --drive: a result of identify, for values and noise.",
)
@campaign_option
@click.option("--structure", "name", metavar="NAME", help=f"Structure: {OWN_FILE_HELP}; {DEFAULT_HELP} by default.")
@click.option("--vessel", help=f"Vessel file, for what it knows of parameters: {NAMES} stan-tug-1205.")
@click.option(
    "--from",
    "recording",
    type=click.Path(path_type=Path),
    help="A recording of the ship, for its noise; without it the noise of the Stan Tug 1205 is assumed.",
)
@click.option("--from-campaign", "recorded", help="Campaign of that recording; --campaign when not given.")
@known_options
@no_progress_option
def command(
    drive_file: Path | None,
    inputs: tuple[Path, ...],
    noise: Mapping[str, float],
    fingerprint: Path | None,
    campaign: str,
    name: TypedName | None,
    vessel: str | None,
    recording: Path | None,
    recorded: str | None,
    known: ShipBeforeTest,
    no_progress: bool,
) -> None:
    """Predict the accuracy of a planned test.

    Prints the standard deviation of every parameter that the lines of a campaign would give, what they cannot
    separate, and what no test of these outputs can find. With --vessel also where the test would leave the limits of
    ship and engine. --prior, --free, --hold and --value may be repeated.
    With --drive, the records of planned inputs are predicted instead.
    """
    if drive_file is not None:
        expect_not_given("campaign", "vessel", "recording", "recorded", "slope_rpm_per_v", "freed")
        chosen_names = () if name is None else (name,)
        predict_on_the_bench(drive_file, inputs, chosen_names, noise, fingerprint, known)
        return
    if inputs or noise or fingerprint is not None:
        raise click.UsageError("--input, --noise and --fingerprint need --drive.")
    installation = None if vessel is None else checked_vessel(vessel)
    ship = replace(known, vessel=installation, recording=recording, recorded=recorded)
    with progress(hidden=no_progress) as steps:
        predicted = predict_test(load_campaign(campaign), ship, structure=name, progress=steps)
    print_prediction(predicted)


def print_prediction(predicted: PredictedTest) -> None:
    """Print how accurate a planned test would be, and where it would leave the limits of ship and engine."""
    possible, accuracy, intervals = predicted.possible, predicted.accuracy, predicted.intervals
    responses, visible = predicted.responses, predicted.visible
    structure = possible.structure
    # first what may spoil it
    print_findings("What the test will find", [*predicted.at_limits, *accuracy.sentences], is_answer=True)
    print_table(_accuracy_table(possible, accuracy, intervals))
    speeds = sum(response.inputs == responses[0].inputs for response in responses)
    at_all = "at all" if speeds == 1 else "at one speed, however long"
    print_findings(f"What these outputs can tell {at_all}", possible.sentences)
    print_tables([_visible_table(visible)])
    say(f"{predicted.campaign.name}; {structure.name}: {structure.title}")
    _print_conditions(responses, predicted.noise_source, accuracy)
    give("parameters", accuracy.parameters)
    give("combinations", accuracy.combinations)
    give("visible_changes", visible)
    give("intervals_95", {name: (ends.lower, ends.upper) for name, ends in intervals.items()})
    if predicted.limits is not None:
        print_limit_uses(predicted.limits, is_expected=True)
    for name in predicted.left_out:
        say(f"What {name} does to engine and gauge is not in these limits: keep room for it.")


def _visible_table(visible: Sequence[VisibleChange]) -> Table:
    rows = tuple((one.cause.name, f"{plain(one.cause.in_unit(one.size), 1)} {one.cause.unit}") for one in visible)
    return Table(
        title="What a second test like it would see of a change",
        columns=(*texts("what may change"), *numbers("seen in four of five pairs")),
        rows=rows,
        note="With this noise in both tests, and one cause alone. A change of the propeller is not predicted.",
    )


def _print_conditions(responses: Sequence[FrequencyResponse], noise: str, accuracy: Accuracy) -> None:
    used = [
        name for response in responses for name, is_used in zip(response.lines, response.used, strict=True) if is_used
    ]
    say(noise, indent="  ")
    say(f"lines used: {', '.join(used)}", indent="  ")
    for name, remark in (item for response in responses for item in response.remarks.items()):
        say(f"{name} not used: {remark}", indent="  ")
    priors = {name: (prior.mean, prior.std) for name, prior in accuracy.priors.items()}
    held = {p.name: p.value for p in accuracy.objective.parameters if p.held}
    print_assumed(priors, held, {estimate.name: estimate.unit for estimate in accuracy.parameters})


def _accuracy_table(possible: Identifiability, accuracy: Accuracy, intervals: Mapping[str, Interval]) -> Table:
    meanings = {p.name: p.meaning for p in accuracy.objective.parameters}
    meanings |= {c.name: c.meaning for c in (*possible.combinations, *accuracy.objective.combinations)}
    rows = tuple(
        (*_accuracy_cells(estimate, intervals.get(estimate.name)), meanings[estimate.name])
        for estimate in accuracy.numbers
    )
    return Table(
        title="Predicted accuracy with these lines",
        columns=(
            *texts("quantity"),
            *numbers("value ± std", "std [%]", "95 % interval"),
            *texts("unit"),
            MEANING,
        ),
        rows=rows,
        note="An end of an interval with an asterisk is a bound of the search and not a result.",
    )


def _accuracy_cells(estimate: Estimate, ends: Interval | None) -> tuple[str, ...]:
    limits = () if ends is None else (ends.lower, ends.upper)
    factor, unit = fine_unit(estimate.unit, estimate.value, estimate.std, *limits)
    return (
        Symbol(estimate.name),
        with_deviation(factor * estimate.value, factor * estimate.std),
        _percent(estimate),
        "" if ends is None else _interval_text(ends, factor, factor * estimate.std),
        unit_text(unit),
    )


def _percent(estimate: Estimate) -> str:
    if not math.isfinite(estimate.std) or estimate.value == 0.0:
        return ""
    percent = 100.0 * estimate.std / abs(estimate.value)
    return f"{percent:.0f}" if percent >= 100.0 else f"{percent:.2g}"


def _interval_text(ends: Interval, factor: float, std: float) -> str:
    """Return a profile interval; an end that only a bound of the search sets is marked."""
    lower, _, upper = interval(factor * ends.lower, factor * ends.upper, std).partition(" to ")
    return f"{lower}{'*' * ends.lower_open} to {upper}{'*' * ends.upper_open}"
