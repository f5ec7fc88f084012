"""``shaftprint limits``: which limits a line has, and how large they are."""

import math
from pathlib import Path

import click
import numpy as np

from shaftprint.cli._options import campaign_option, vessel_option
from shaftprint.cli._results import print_paths, write_results
from shaftprint.cli._terminal import print_findings, say
from shaftprint.cli._validation import print_validation
from shaftprint.cli.output import force_option, give, no_progress_option, output_folder, print_tables, progress
from shaftprint.digits import fine_unit, interval, stated_interval
from shaftprint.distributions import NORMAL_95
from shaftprint.identify.fit import Estimate
from shaftprint.limits import LimitEstimate, LimitFit, identify_limits
from shaftprint.survey import Trial, judged, load_trial, measure, run, with_limits
from shaftprint.tables import MEANING, Symbol, Table, numbers, texts, unit_text, with_deviation

# As for ``identify``.
SEED = 1


@click.command("limits")
@click.argument("recording", type=click.Path(path_type=Path))
@vessel_option
@campaign_option
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    help="Folder for a fingerprint that holds the limits, validated with them, and its report.",
)
@force_option
@no_progress_option
def command(recording: Path, vessel: str, campaign: str, output: Path | None, force: bool, no_progress: bool) -> None:
    """Find which limits a line has, and their levels and rates with uncertainty.

    Looked for are torque limit, motoring limit, smoke limiter, rate limits of rack and set point, deadband, and a set
    point held between messages or rounded to steps. Of what does not act it says up to which level the recording
    excludes it. With --output the line is identified too: limits and line are one model, which exports take.
    """
    trial = load_trial(vessel, campaign)
    if output is not None:
        _identify(recording, trial, output, force=force, no_progress=no_progress)
        return
    with progress(hidden=no_progress) as steps:
        measurement = measure(recording, trial, mode="shaftprint", progress=steps)
        limits = identify_limits(measurement.signals, trial.campaign, trial.vessel, progress=steps.tell)
    print_limits(limits)


def _identify(recording: Path, trial: Trial, output: Path, *, force: bool, no_progress: bool) -> None:
    """Write the fingerprint of a line with its limits, validated with them, and its report."""
    rng = np.random.default_rng(SEED)
    with output_folder(output, of="limits", force=force) as folder:
        with progress(hidden=no_progress) as steps:
            survey = with_limits(
                run(
                    recording, trial.vessel, trial.campaign, sources=trial.sources, rng=rng, judge=False, progress=steps
                ),
                progress=steps,
            )
        if survey.limit_fit is not None:
            print_limits(survey.limit_fit)
        with progress(hidden=no_progress) as steps:
            survey = judged(survey, rng=rng, progress=steps)
        for remark in survey.remarks:
            say(remark)
        for validation in survey.validations:
            print_validation(validation)
        with progress(hidden=no_progress) as steps:
            write_results(folder, recording, survey, steps=steps)
    print_paths(output)


def print_limits(limits: LimitFit) -> None:
    """Print the answer first: limits with their levels, what may be trusted, then the tables."""
    print_findings(
        "Limits", [limits.sentence, *(_answer(limits, number) for number in _first_numbers(limits))], is_answer=True
    )
    give("limits", limits.numbers)
    print_findings("Not seen", list(limits.not_seen.values()))
    print_tables([_number_table(limits), _governor_table(limits)])
    trusted = ", ".join(number.name for number in limits.trusted) or "none"
    doubted = [f"{number.name}: {number.doubt}." for number in limits.numbers if not number.trusted]
    print_findings("Verdict", [f"Numbers that can be trusted: {trusted}.", *doubted])


def _first_numbers(limits: LimitFit) -> list[LimitEstimate]:
    """Return the number by which each limit is known."""
    return [next(number for number in limits.numbers if number.kind is kind) for kind in limits.kinds]


def _answer(limits: LimitFit, number: LimitEstimate) -> str:
    value = stated_interval(number.value, number.lower, number.upper, _std(number), number.unit)
    trust = "trusted" if number.trusted else f"not trusted, {number.doubt}"
    gain = f"Likelihood-ratio statistic {limits.gains[number.kind]:.0f}."
    return f"{number.kind.value}: {number.name} = {value}, {trust}. {gain}"


def _std(number: LimitEstimate) -> float:
    """Return the standard deviation that the digits follow: that of the interval, which is shown."""
    width = 0.5 * (number.upper - number.lower) / NORMAL_95
    return width if math.isfinite(width) and width > 0.0 else number.std


def _number_table(limits: LimitFit) -> Table:
    columns = (*texts("symbol"), *numbers("value ± std", "95 % interval"), *texts("unit", "trusted"), MEANING)
    return Table(title="Numbers of the limits", columns=columns, rows=tuple(map(_number_row, limits.numbers)))


def _number_row(number: LimitEstimate) -> tuple[str, ...]:
    factor, unit = fine_unit(number.unit, number.value, number.std, number.lower, number.upper)
    return (
        Symbol(number.name),
        with_deviation(factor * number.value, factor * number.std),
        interval(factor * number.lower, factor * number.upper, factor * number.std),
        unit_text(unit),
        "yes" if number.trusted else number.doubt,
        number.meaning,
    )


def _governor_table(limits: LimitFit) -> Table:
    columns = (*texts("symbol"), *numbers("value ± std"), *texts("unit"))
    rows = tuple(map(_governor_row, limits.governor))
    return Table(title="Governor that goes with them", columns=columns, rows=rows)


def _governor_row(estimate: Estimate) -> tuple[str, str, str]:
    factor, unit = fine_unit(estimate.unit, estimate.value, estimate.std)
    text = with_deviation(factor * estimate.value, factor * estimate.std)
    return Symbol(estimate.name), text + " (at its bound)" * estimate.at_bound, unit_text(unit)
