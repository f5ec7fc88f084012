"""``shaftprint live play``: a test played through a counterpart on board."""

from __future__ import annotations

import os
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
from shaftprint.cli._options import campaign_option, vessel_option
from shaftprint.late import late

with late():
    from shaftprint.design.files._plan_json import read_plan
    from shaftprint.live._envelope import envelope_of
    from shaftprint.live._outcome import Operator
    from shaftprint.live._play_on_board import play_on_board
    from shaftprint.live.counterparts._access import Access
    from shaftprint.survey._trial import load_trial

PASSWORD = "SHAFTPRINT_LIVE_PASSWORD"  # noqa: S105  (the name of the variable, not what it holds)


@click.command("play")
@click.argument("url")
@vessel_option
@campaign_option
@recording_option
@fingerprint_option
@slope_option
@plan_option
@within_option
@page_option
@click.option("--dry", is_flag=True, help="Look at the channels, record them, and write nothing to the counterpart.")
@click.option("--user", help=f"Name of the user; the password is taken from {PASSWORD}, or asked for.")
@click.option(
    "--certificate", type=click.Path(path_type=Path), help="Certificate of this side with its key, PEM; encrypts."
)
@click.option("--authority", type=click.Path(path_type=Path), help="Certificates that vouch for the other side, PEM.")
@click.option(
    "--places", type=click.Path(path_type=Path), help="Which registers or messages hold what, for modbus:// and can://."
)
@click.option("--insecure", is_flag=True, help="Write without user and encryption, on a network nobody else is on.")
@click.pass_context
def command(
    context: click.Context,
    url: str,
    vessel: str,
    campaign: str,
    output: Path,
    fingerprint: Path | None,
    slope_rpm_per_v: float | None,
    place: Path | None,
    within_s: float | None,
    port: int | None,
    dry: bool,
    user: str | None,
    certificate: Path | None,
    authority: Path | None,
    places: Path | None,
    insecure: bool,
) -> None:
    """Play a test through a counterpart on board.

    URL is its address, such as opc.tcp://10.0.0.5:4840 or mqtts://10.0.0.5/prefix; it goes by opc.tcp, mqtt, mqtts,
    sparkplug, sparkplugs, modbus or can. The campaign is proved against [envelope] of the vessel file;
    then channels, heartbeat and revert are looked at, and the bridge is asked. Ctrl-C aborts: the counterpart goes back
    to the lever. Ends with 3 where the test was refused or aborted.
    """
    trial = load_trial(vessel, campaign)
    envelope = envelope_of(trial.vessel, is_rehearsed=dry)
    proves = prover(trial, envelope, fingerprint=fingerprint, slope_rpm_per_v=slope_rpm_per_v)
    proof, operator = proved(proves(trial.campaign)), Operator()
    if not dry:
        proof.expect_within()
    password = None if user is None else os.environ.get(PASSWORD) or click.prompt("Password", hide_input=True, err=True)
    access = Access(user=user, password=password, certificate=certificate, authority=authority, is_insecure=insecure)
    with shown_on_pages(port, operator) as pages:
        outcome, left = play_on_board(
            url,
            trial.vessel,
            trial.campaign,
            envelope,
            output,
            access=access,
            places=places,
            dry=dry,
            planned=None if place is None else read_plan(place),
            slope_rpm_per_v=proof.slope_rpm_per_v,
            confirm=lambda question: click.confirm(question, err=True),
            proves=lambda changed: proves(changed).refusals,
            most_s=within_s,
            operator=operator,
            told=tell_and_listen(operator),
            pages=pages,
        )
    print_outcome(outcome, left, vessel=vessel)
    if outcome.word != "played" and not dry:
        context.exit(NOT_REACHED)
