"""``shaftprint sail``: a raw recording of a simulated tug."""

from __future__ import annotations

import math
from pathlib import Path

import click

from shaftprint.choices import MESSAGES, SERVICE_TROUBLES
from shaftprint.cli._next import print_next
from shaftprint.cli._options import output_options, starboard_option
from shaftprint.cli._sail_both import sail_both_lines
from shaftprint.cli._terminal import answer, echo
from shaftprint.cli._vessel_file import print_disagreements
from shaftprint.cli.output._file_to_write import expect_free
from shaftprint.cli.output._progress import no_progress_option, progress
from shaftprint.late import late

with late():
    from shaftprint.recording.writers._by_ending import expect_known_ending
    from shaftprint.survey._trial import load_trial
    from shaftprint.tug._in_messages import in_messages
    from shaftprint.tug._like_stan_tug import like_stan_tug_1205, with_lever_of
    from shaftprint.tug._sail_as import sail_as
    from shaftprint.tug._truth import truth_path
    from shaftprint.tug.service._sail_service import sail_service
    from shaftprint.vessel._vessel import load_vessel

MOST_HOURS = 200.0
"""Hours of ordinary service that are simulated at once."""


@click.command("sail")
@click.argument("vessel")
@click.argument("campaign", required=False)
@output_options("Recording to write, or folder with --service")
@starboard_option
@click.option("--seed", type=click.IntRange(min=0), default=1, show_default=True, help="Seed of all randomness.")
@click.option(
    "--messages",
    "rates",
    multiple=True,
    metavar="WHAT=HZ",
    help="What comes over a bus, and how often: torque=100, speed=50 or set-point=50; may be repeated.",
)
@click.option("--jitter", type=click.FloatRange(0.0, 28.0), default=0.0, help="Of messages, % of their cycle (rms).")
@click.option("--lost", type=click.FloatRange(0.0, 99.0), default=0.0, help="Messages that are lost [%].")
@click.option(
    "--service",
    metavar="HOURS",
    help="Ordinary service in place of a campaign, such as 8h: a crew moves the lever, a file an hour is written.",
)
@click.option(
    "--trouble",
    type=click.Choice(SERVICE_TROUBLES),
    help="What is wrong with the logs of --service, such as a lever on another clock.",
)
@click.option("--ending", default=".nc", show_default=True, help="Ending of the files of --service.")
@click.option("--force", is_flag=True, help="Replace an existing recording.")
@no_progress_option
def command(
    vessel: str,
    campaign: str | None,
    output: Path,
    chosen_format: str | None,
    starboard: str | None,
    seed: int,
    rates: tuple[str, ...],
    jitter: float,
    lost: float,
    service: str | None,
    trouble: str | None,
    ending: str,
    force: bool,
    no_progress: bool,
) -> None:
    """Simulate the test of a ship and write the raw recording of its logger.

    VESSEL and CAMPAIGN (the test) are files, or names of shipped ones such as stan-tug-1205 and thesis. Governor,
    delays and noise are those of the Stan Tug 1205; gains are scaled with the inertia. The lever is that of the
    campaign (slope_rpm_per_v; at its offset it asks for offset_rpm, or for the working speed), or of the vessel file
    (table_rpm, or rpm as its unit). Without these -5 V asks for the working speed. With a ship speed in its working
    point the ship sails free, and the lever asks for the working speed at the voltage of the campaign. What was put
    into the recording goes to a file of its own beside it, which nothing that identifies will open. The recording is
    written as the logger of its ending writes it: what that loses is said, and logs of a CAN bus get a DBC file beside
    them. With --messages the shaft torque, a speed in rpm or a set point in % or rpm come over a bus. With --starboard
    both lines of a ship are sailed in one recording; each propeller feels the wash of the other, and both the same sea.

    With --service HOURS the ship works: a crew with habits of its own moves the lever, lets the engine idle and takes
    the clutch out, and no campaign is given. What its logger keeps goes into the folder of --output, a file an hour,
    with the truth beside; stan-tug-1205-service has the sensors for that. With --trouble something is wrong with what
    is logged, as `shaftprint service scan` should find.
    """
    if service is not None:
        if campaign is not None or starboard is not None or rates or jitter or lost:
            raise click.UsageError("--service goes with a vessel, --seed, --trouble, --ending and --force alone.")
        _work(
            vessel, output, hours=_hours(service), trouble=trouble, ending=ending, seed=seed, force=force,
            no_progress=no_progress,
        )  # fmt: skip
        return
    if trouble is not None:
        raise click.UsageError("--trouble goes with --service.")
    if campaign is None:
        raise click.UsageError("Missing argument 'CAMPAIGN': name one such as thesis, or give --service 8h.")
    if output.is_dir():
        raise click.ClickException(f"{output}: expected a file for the recording, found a folder; add a file name.")
    expect_known_ending(output, format=chosen_format)
    for file in (output, truth_path(output)):
        expect_free(file, force=force)
    rates_hz = dict(map(_rate, rates))
    if starboard is not None:
        if rates_hz or jitter or lost:
            raise click.UsageError("--messages, --jitter and --lost are for one line: leave out --starboard.")
        sail_both_lines(vessel, starboard, campaign, output, seed=seed, force=force, no_progress=no_progress)
        return
    trial = load_trial(vessel, campaign)
    print_disagreements(trial.vessel, vessel)
    with progress(hidden=no_progress) as steps:
        steps.begin("Sailing", total=1.0)
        usual = like_stan_tug_1205(trial.vessel, offset_v=trial.campaign.offset_v)
        tug = with_lever_of(usual, trial.vessel, trial.campaign)
        tug = in_messages(tug, trial.vessel, rates_hz=rates_hz, jitter=jitter / 100.0, lost=lost / 100.0)
        remarks: list[str] = []
        truth = sail_as(
            trial.vessel,
            trial.campaign,
            output,
            tug=tug,
            seed=seed,
            overwrite=force,
            progress=steps.reach,
            format=chosen_format,
            told=remarks.append,
        )
    for remark in remarks:
        echo(f"{output}: {remark}", err=True)
    answer(f"{output}: the raw recording of {trial.campaign.duration_s:g} s.")
    answer(
        f"{truth_path(output)}: what was put into it, normalised at {truth.engine_speed_rpm:.0f} rpm and "
        f"{truth.shaft_torque_nm:.0f} N m; `identify --truth` sets it beside what is found, at the speed of the test."
    )
    print_next("inspect", output, "--vessel", vessel, "--campaign", campaign)


def _work(
    vessel: str, output: Path, *, hours: float, trouble: str | None, ending: str, seed: int, force: bool,
    no_progress: bool,
) -> None:  # fmt: skip
    """Write logs of ordinary service."""
    with progress(hidden=no_progress) as steps:
        steps.begin("Working", total=1.0)
        files, truth = sail_service(
            load_vessel(vessel), output, hours=hours, seed=seed, trouble=trouble, ending=ending, overwrite=force,
            progress=steps.reach,
        )  # fmt: skip
    answer(f"{output}: {len(files)} files of {truth.duration_s / 3600.0:g} hours of ordinary service.")
    answer(f"{truth_path(output / 'log.nc')}: what was put into them.")


def _hours(text: str) -> float:
    """Return a number of hours, with or without their unit."""
    try:
        hours = float(text.strip().removesuffix("h"))
    except ValueError:
        hours = 0.0
    if not 0.0 < hours <= MOST_HOURS:
        raise click.UsageError(f'--service: expected up to {MOST_HOURS:g} hours, such as 8h, found "{text}".')
    return hours


def _rate(text: str) -> tuple[str, float]:
    """Return what comes in messages, and how often [Hz]."""
    name, _, rate = text.partition("=")
    try:
        rate_hz = float(rate)
    except ValueError:
        rate_hz = 0.0
    if name not in MESSAGES or not 0.0 < rate_hz < math.inf:
        raise click.UsageError(
            f'--messages: expected {", ".join(MESSAGES)} with a rate, such as speed=50, found "{text}".'
        )
    return name, rate_hz
