"""``shaftprint predict``: what a test would find, before it is made."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import click

from shaftprint.cli._drive_judge import predict_on_the_bench
from shaftprint.cli._drive_options import drive_option, expect_not_given
from shaftprint.cli._known_values import by_name, known_options, named_value
from shaftprint.cli._options import DEFAULT_HELP, NAMES, OWN_FILE_HELP, campaign_option
from shaftprint.cli._prediction_tables import print_prediction
from shaftprint.cli._vessel_file import checked_vessel
from shaftprint.cli.output._progress import no_progress_option, progress
from shaftprint.late import late

with late():
    from shaftprint.campaign._campaign import load_campaign
    from shaftprint.catalogue._own_structure import TypedName
    from shaftprint.forecast._predict import predict_test
    from shaftprint.forecast._ship_before_test import ShipBeforeTest


@click.command("predict")
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
