"""``shaftprint live replay``: a recording judged as if it came in now."""

from __future__ import annotations

from pathlib import Path

import click

from shaftprint.cli._live_options import print_judged
from shaftprint.cli._options import campaign_option, vessel_option
from shaftprint.cli._terminal import answer, details, echo
from shaftprint.late import late

with late():
    from shaftprint.live._replay import replayed
    from shaftprint.recording._read import read_recording
    from shaftprint.survey._trial import load_trial


@click.command("replay")
@click.argument("recording", type=click.Path(path_type=Path))
@vessel_option
@campaign_option
def command(recording: Path, vessel: str, campaign: str) -> None:
    """Judge a recording as if it came in now.

    RECORDING may be the journal of a test that was broken off. CAMPAIGN is the one as it was played, beside the
    recording of a live test. What is shown at the end of each period is what was shown live.
    """
    trial = load_trial(vessel, campaign)
    last = {}
    with read_recording(recording) as opened:
        for time_s, name, judgements in replayed(opened, trial.vessel, trial.campaign):
            last[name] = judgements
            with details():
                echo(f"{time_s:9.2f} s  {name}: {judgements[0].periods if judgements else 0} periods")
    print_judged(tuple(one for lines in last.values() for one in lines))
    answer(f"{recording}: {len(last)} of {len(trial.campaign.excitations)} tests have whole periods.")
