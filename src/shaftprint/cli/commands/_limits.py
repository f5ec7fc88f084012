"""``shaftprint limits``: which limits a line has, and how large they are."""

from pathlib import Path

import click

from shaftprint.cli._options import campaign_option, vessel_option
from shaftprint.cli._terminal import print_findings
from shaftprint.cli.output import no_progress_option, print_tables, progress
from shaftprint.limits import LimitEstimate, LimitFit, identify_limits
from shaftprint.survey import load_trial, measure
from shaftprint.tables import Symbol, Table, numbers, texts, unit_text, with_deviation


@click.command("limits")
@click.argument("recording", type=click.Path(path_type=Path))
@vessel_option
@campaign_option
@no_progress_option
def command(recording: Path, vessel: str, campaign: str, no_progress: bool) -> None:
    """Find which limits a line has, and their levels and rates with uncertainty.

    Looked for are torque limit, motoring limit, smoke limiter, rate limits of rack and set point, deadband, and a set
    point held between messages or rounded to steps. Of what does not act it says up to which level the recording
    excludes it.
    """
    trial = load_trial(vessel, campaign)
    with progress(hidden=no_progress) as steps:
        measurement = measure(recording, trial, mode="shaftprint", progress=steps)
        limits = identify_limits(measurement.signals, trial.campaign, trial.vessel, progress=steps.begin)
    print_limits(limits)


def print_limits(limits: LimitFit) -> None:
    """Print the answer first: limits with their levels, what may be trusted, then the tables."""
    print_findings("Limits", [limits.sentence, *(_answer(limits, number) for number in _first_numbers(limits))])
    print_findings("Not seen", list(limits.not_seen.values()))
    print_tables([_number_table(limits), _governor_table(limits)])
    trusted = ", ".join(number.name for number in limits.trusted) or "none"
    doubted = [f"{number.name}: {number.doubt}." for number in limits.numbers if not number.trusted]
    print_findings("Verdict", [f"Numbers that can be trusted: {trusted}.", *doubted])


def _first_numbers(limits: LimitFit) -> list[LimitEstimate]:
    """Return the number by which each limit is known."""
    return [next(number for number in limits.numbers if number.kind is kind) for kind in limits.kinds]


def _answer(limits: LimitFit, number: LimitEstimate) -> str:
    unit = "" if number.unit == "-" else f" {number.unit}"
    trust = "trusted" if number.trusted else f"not trusted, {number.doubt}"
    return (
        f"{number.kind.value}: {number.name} = {number.value:.4g}{unit}, 95 % interval {_interval(number)}{unit} "
        f"({trust}). Likelihood-ratio statistic {limits.gains[number.kind]:.0f}."
    )


def _interval(number: LimitEstimate) -> str:
    return f"{number.lower:.4g} to {number.upper:.4g}"


def _number_table(limits: LimitFit) -> Table:
    rows = tuple(
        (
            Symbol(number.name),
            with_deviation(number.value, number.std),
            _interval(number),
            unit_text(number.unit),
            "yes" if number.trusted else number.doubt,
            number.meaning,
        )
        for number in limits.numbers
    )
    columns = (*texts("symbol"), *numbers("value ± std", "95 % interval"), *texts("unit", "trusted", "meaning"))
    return Table(title="Numbers of the limits", columns=columns, rows=rows)


def _governor_table(limits: LimitFit) -> Table:
    rows = tuple(
        (
            Symbol(estimate.name),
            with_deviation(estimate.value, estimate.std) + (" (at its bound)" if estimate.at_bound else ""),
            unit_text(estimate.unit),
        )
        for estimate in limits.governor
    )
    columns = (*texts("symbol"), *numbers("value ± std"), *texts("unit"))
    return Table(title="Governor that goes with them", columns=columns, rows=rows)
