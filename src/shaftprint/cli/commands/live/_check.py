"""``shaftprint live check``: a campaign held against the envelope of a ship."""

from __future__ import annotations

from pathlib import Path

import click

from shaftprint.cli._command_group import NOT_REACHED
from shaftprint.cli._live_options import fingerprint_option, proved, prover, slope_option
from shaftprint.cli._options import campaign_option, vessel_option
from shaftprint.cli._terminal import answer
from shaftprint.late import late

with late():
    from shaftprint.live._envelope import envelope_of
    from shaftprint.survey._trial import load_trial


@click.command("check")
@vessel_option
@campaign_option
@fingerprint_option
@slope_option
@click.pass_context
def command(
    context: click.Context, vessel: str, campaign: str, fingerprint: Path | None, slope_rpm_per_v: float | None
) -> None:
    """Prove that a campaign stays within the envelope of a ship; nothing is played.

    The waveform as it would be played, and the predicted motion with its band, are held against [envelope] of the
    vessel file. Ends with 3 where the campaign may not be played, with every reason.
    """
    trial = load_trial(vessel, campaign)
    proves = prover(trial, envelope_of(trial.vessel), fingerprint=fingerprint, slope_rpm_per_v=slope_rpm_per_v)
    proof = proved(proves(trial.campaign))
    if proof.refusals:
        answer(f"{trial.campaign.name} may not be played.")
        context.exit(NOT_REACHED)
    answer(f"{trial.campaign.name} stays within the envelope.")
