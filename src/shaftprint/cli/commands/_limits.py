"""``shaftprint limits``: which limits a line has, and how large they are."""

from pathlib import Path

import click

from shaftprint.cli._fingerprint_tables import print_findings
from shaftprint.cli._inputs import campaign_option, vessel_option
from shaftprint.cli._numbers import with_uncertainty
from shaftprint.cli._progress import no_progress_option, progress
from shaftprint.cli._tables import print_table
from shaftprint.limits import LimitEstimate, LimitFit, identify_limits
from shaftprint.survey import load_trial, measure


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
        found = identify_limits(measurement.signals, trial.campaign, trial.vessel, progress=steps.begin)
    print_limits(found)


def print_limits(found: LimitFit) -> None:
    """Print the answer first: limits with their levels, what may be trusted, then the tables."""
    print_findings("Limits", [found.sentence, *(_answer(found, number) for number in _first_numbers(found))])
    print_findings("Not seen", list(found.not_seen.values()))
    if found.numbers:
        print_table(
            "Numbers of the limits",
            ("symbol", "value +/- 1 std", "95 % interval", "unit", "trusted", "meaning"),
            [_row(number) for number in found.numbers],
        )
    print_table(
        "Governor that goes with them",
        ("symbol", "value +/- 1 std", "unit"),
        [
            (e.name, f"{with_uncertainty(e.value, e.std)}{' at bound' if e.at_bound else ''}", e.unit)
            for e in found.governor
        ],
    )
    trusted = ", ".join(number.name for number in found.trusted) or "none"
    doubted = [f"{number.name}: {number.doubt}." for number in found.numbers if not number.trusted]
    print_findings("Verdict", [f"Numbers that can be trusted: {trusted}.", *doubted])


def _first_numbers(found: LimitFit) -> list[LimitEstimate]:
    """Return the number by which each limit is known."""
    return [next(number for number in found.numbers if number.kind is kind) for kind in found.kinds]


def _answer(found: LimitFit, number: LimitEstimate) -> str:
    unit = "" if number.unit == "-" else f" {number.unit}"
    trust = "trusted" if number.trusted else f"not trusted, {number.doubt}"
    return (
        f"{number.kind.value}: {number.name} = {number.value:.4g}{unit}, 95 % interval {_interval(number)}{unit} "
        f"({trust}). Likelihood-ratio statistic {found.gains[number.kind]:.0f}."
    )


def _interval(number: LimitEstimate) -> str:
    return f"{number.lower:.4g} to {number.upper:.4g}"


def _row(number: LimitEstimate) -> tuple[str, ...]:
    value = with_uncertainty(number.value, number.std)
    trusted = "yes" if number.trusted else number.doubt
    return number.name, value, _interval(number), number.unit, trusted, number.meaning
