"""``shaftprint sail --starboard``: both lines of a ship in one recording."""

from __future__ import annotations

from pathlib import Path

import click

from shaftprint.choices import NATIVE_ENDINGS
from shaftprint.cli._terminal import answer
from shaftprint.cli._vessel_file import print_disagreements
from shaftprint.cli.output._progress import progress
from shaftprint.late import late

with late():
    from shaftprint.campaign._both_shafts import load_campaign_of_both
    from shaftprint.survey._both_shafts import load_trials_of_both
    from shaftprint.tug._like_stan_tug import like_stan_tug_1205, with_lever_of
    from shaftprint.tug._sail_both import sail_both
    from shaftprint.tug._truth import truth_path


def sail_both_lines(
    port: str, starboard: str, campaign: str, output: Path, *, seed: int, force: bool, no_progress: bool
) -> None:
    """Simulate both lines of a ship in a campaign and write one raw recording.

    Raises click.ClickException if the recording is to be of another format than the native container.
    """
    if output.suffix.lower() not in NATIVE_ENDINGS:
        raise click.ClickException(
            f"{output}: expected a recording of both lines that ends in {', '.join(NATIVE_ENDINGS)}; "
            "`shaftprint convert` writes the other formats from it."
        )
    asked = load_campaign_of_both(campaign)
    trials = load_trials_of_both(port, starboard, asked)
    for trial, name in zip(trials, (port, starboard), strict=True):
        print_disagreements(trial.vessel, name)
    vessels = trials[0].vessel, trials[1].vessel
    usual = (like_stan_tug_1205(trial.vessel, offset_v=trial.campaign.offset_v) for trial in trials)
    tugs = tuple(with_lever_of(tug, trial.vessel, trial.campaign) for tug, trial in zip(usual, trials, strict=True))
    with progress(hidden=no_progress) as steps:
        steps.begin("Sailing", total=1.0)
        sail_both(vessels, asked, output, tugs=(tugs[0], tugs[1]), seed=seed, overwrite=force, progress=steps.reach)
    answer(f"{output}: the raw recording of both lines, {asked.duration_s:g} s.")
    answer(f"{truth_path(output)}: what was put into it.")
