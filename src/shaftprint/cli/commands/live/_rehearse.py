"""``shaftprint live rehearse``: a test played on a simulated ship."""

from __future__ import annotations

from pathlib import Path

import click

from shaftprint.cli._command_group import NOT_REACHED
from shaftprint.cli._live_options import (
    fingerprint_option,
    page_option,
    plan_option,
    print_outcome,
    proved,
    prover,
    recording_option,
    shown_on_pages,
    slope_option,
    tell_and_listen,
    within_option,
)
from shaftprint.cli._terminal import echo
from shaftprint.late import late

with late():
    from shaftprint.design.files._plan_json import read_plan
    from shaftprint.live._envelope import envelope_of
    from shaftprint.live._outcome import Operator
    from shaftprint.live._rehearse import faults_named, rehearse, rehearsed_slope
    from shaftprint.survey._trial import load_trial


@click.command("rehearse")
@click.argument("vessel")
@click.argument("campaign")
@recording_option
@fingerprint_option
@slope_option
@plan_option
@within_option
@page_option
@click.option("--seed", type=click.IntRange(min=0), default=1, show_default=True, help="Seed of all randomness.")
@click.option("--pace", type=click.FloatRange(0.1, 100.0), help="Times the clock; as fast as possible without it.")
@click.option(
    "--over",
    type=click.Choice(["opcua", "mqtt"]),
    help="Behind a real server on this computer, by the clock; MQTT needs the broker mosquitto.",
)
@click.option(
    "--fault",
    "faults",
    multiple=True,
    metavar="KIND@SECOND",
    help="Something that goes wrong: frozen, silent, stale, not-a-number, stuck or deaf, such as silent@60; or "
    "late-revert; may be repeated.",
)
@click.pass_context
def command(
    context: click.Context,
    vessel: str,
    campaign: str,
    output: Path,
    fingerprint: Path | None,
    slope_rpm_per_v: float | None,
    place: Path | None,
    within_s: float | None,
    port: int | None,
    seed: int,
    pace: float | None,
    over: str | None,
    faults: tuple[str, ...],
) -> None:
    """Play a test on a simulated ship, as fast as it can be calculated, by the clock, or behind a real server.

    VESSEL and CAMPAIGN are files, or names of shipped ones. Without [envelope] in the vessel file idle speed, rated
    speed and rated torque bound the rehearsal; on board the file has to state it. Ends with 3 where the test was
    refused or aborted.
    """
    if over is not None and pace is not None:
        raise click.UsageError(
            "expected one of --pace and --over, found both: over a server a ship sails by the clock."
        )
    trial = load_trial(vessel, campaign)
    wrong = faults_named(faults)
    envelope = envelope_of(trial.vessel, is_rehearsed=True)
    if not envelope.is_stated:
        echo(f"{vessel}: no [envelope]; idle speed, rated speed and rated torque are taken.", err=True)
    slope = rehearsed_slope(trial.vessel, trial.campaign) if slope_rpm_per_v is None else slope_rpm_per_v
    proves, operator = prover(trial, envelope, fingerprint=fingerprint, slope_rpm_per_v=slope), Operator()
    proved(proves(trial.campaign)).expect_within()
    with shown_on_pages(port, operator) as pages:
        outcome, left = rehearse(
            trial.vessel,
            trial.campaign,
            envelope,
            output,
            seed=seed,
            pace=pace,
            over=over,
            faults=wrong,
            planned=None if place is None else read_plan(place),
            proves=lambda changed: proves(changed).refusals,
            most_s=within_s,
            operator=operator,
            told=tell_and_listen(operator),
            pages=pages,
        )
    print_outcome(outcome, left, vessel=vessel)
    if outcome.word != "played":
        context.exit(NOT_REACHED)
