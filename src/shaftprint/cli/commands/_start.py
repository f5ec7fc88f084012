"""``shaftprint start``: what lies in a folder, and what comes next."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import click

from shaftprint.cli._after_test import after_test
from shaftprint.cli._card_options import CARD_SECTIONS, ask_card, card_of, card_options, channels_of, stated_of
from shaftprint.cli._command_group import options_for_arguments
from shaftprint.cli._lying_files import LyingFiles, lying_files
from shaftprint.cli._next import VESSEL_FILE, after_drive, first_plan, free, print_steps
from shaftprint.cli._option_sections import SectionedCommand
from shaftprint.cli._options import (
    READING_BESIDE_CARD,
    further_reading_options,
    hints_of,
    of_card_and_reading,
    reading_words,
)
from shaftprint.cli._recorded_sensors import RecordedSensors, recorded_sensors, with_recorded
from shaftprint.cli._terminal import answer, echo, print_findings
from shaftprint.cli._vessel_file import print_disagreements, write_from_card
from shaftprint.cli.output._fingerprint_file import fingerprint_at
from shaftprint.errors import RecordingError, ShaftprintError
from shaftprint.late import late

with late():
    from shaftprint.campaign._campaign import load_campaign
    from shaftprint.vessel._vessel import load_vessel


@click.command(
    "start",
    cls=SectionedCommand,
    example="shaftprint start",
    sections={**CARD_SECTIONS, **READING_BESIDE_CARD},
)
@click.argument("folder", type=click.Path(path_type=Path, file_okay=False, exists=True), default=Path())
@click.option("--yes", is_flag=True, help="Ask nothing: what is not stated is derived, or taken as usual.")
@card_options
@further_reading_options
def command(folder: Path, *, yes: bool, **said: object) -> None:
    """Say what lies in a folder and what comes next; ask for the ship's main particulars first.

    FOLDER is where you are if none is named. Where there is no vessel file yet, power, speed, gearbox, propeller,
    sensors and lever are asked for step by step, and vessel.toml is written; options answer beforehand, as those of
    `shaftprint new vessel`. Needed are power, rated speed, cylinders, ratio, and diameter, blades and pitch of the
    propeller; channels and units come from a recording that lies there. From then on each command ends with the next
    one. A motor or another drive has a drive file in place of the vessel file. Where the recording cannot be read, or
    lacks a sensor, nothing is written.
    """
    lying = lying_files(folder)
    _print(lying)
    vessel = lying.vessels[-1] if lying.vessels else None
    if vessel is not None:
        print_disagreements(load_vessel(vessel), str(vessel), is_recorded=bool(lying.recordings))
    of_card, reading = of_card_and_reading(said)
    is_said = bool(stated_of(of_card))
    if vessel is None:
        recorded, reading = _recorded(lying, reading, of_card.get("sample_rate_hz"))
        words = reading_words(**reading)
        steps = None if is_said or yes else _of_drive(lying, recorded, words)
        if steps is not None:
            print_steps(*steps)
            return
        if recorded.refusal:
            raise RecordingError(f"{recorded.refusal.rstrip('.')}; no vessel file was written.")
        if yes and is_said and recorded.channels:
            of_card = with_recorded(of_card, recorded, lying.recordings[-1])
        asked = of_card if yes else _asked(of_card, recorded.options)
        vessel = _written(folder, asked, lying, recorded)
    else:
        words = reading_words(**reading)
        if is_said:
            there = f"{vessel} is there: what was stated of the ship was not used."
            answer(f"{there} `shaftprint new vessel` writes another.")
    print_steps(*_next(vessel, lying, words))


def _recorded(
    lying: LyingFiles, reading: dict[str, object], rate_hz: object
) -> tuple[RecordedSensors, dict[str, object]]:
    """Return what the newest recording says of the sensors, and the options with which it is read.

    The rate of the card is that of the recording where this has no clock of its own.
    """
    if not lying.recordings or lying.drives:
        return RecordedSensors(options={}), reading
    file = lying.recordings[-1]
    recorded = recorded_sensors(file, hints_of(**reading))
    if recorded.refusal and rate_hz is not None:
        reading = {**reading, "sample_rate": rate_hz}
        recorded = recorded_sensors(file, hints_of(**reading))
    for remark in recorded.remarks:
        answer(f"{file}: {options_for_arguments(remark)}")
    return recorded, reading


def _print(lying: LyingFiles) -> None:
    """Print what lies there, and which of several is taken."""
    kinds: dict[str, tuple[Path, ...]] = {
        **({"Drive file": lying.drives} if lying.drives else {}),
        **({} if lying.drives and not lying.vessels else {"Vessel file": lying.vessels, "Campaign": lying.campaigns}),
        "Recording": lying.recordings,
        **({"DBC file": lying.databases} if lying.databases else {}),
        "Result": lying.results,
    }
    sentences = []
    for kind, paths in kinds.items():
        if paths:
            before = f"; older: {', '.join(map(str, paths[-2::-1]))}" if len(paths) > 1 else ""
            sentences.append(f"{kind}: {paths[-1]}{before}.")
        else:
            sentences.append(f"{kind}: none.")
    if lying.others:
        sentences.append(f"Not used: {', '.join(str(path) for path in lying.others)}.")
    print_findings("What lies here", sentences, is_answer=True)


def _of_drive(
    lying: LyingFiles, recorded: RecordedSensors, reading: tuple[object, ...]
) -> list[tuple[object, ...]] | None:
    """Return the next commands where what lies there is of a drive that is no ship; None of a ship."""
    if not lying.recordings:
        return None
    recording = lying.recordings[-1]
    if lying.drives:
        drive = lying.drives[-1]
        if lying.results and lying.results[-1].stat().st_mtime >= recording.stat().st_mtime:
            return [after_drive(drive, lying.results[-1])]
        return [("identify", recording, *reading, "--drive", drive, "-o", free("result"))]
    if not recorded.is_of_no_ship:
        return None
    answer(
        f"{recording} has neither a shaft torque nor a lever by its names and units: if it is of a motor or another "
        "drive, go on as below; if of a ship, state power and speed as well, --power-kw and --rated-rpm.\n"
    )
    return [("new", "drive", "--from", recording, *reading, "-o", free(f"{recording.stem}.toml"))]


def _written(folder: Path, said: Mapping[str, object], lying: LyingFiles, recorded: RecordedSensors) -> Path:
    """Return the vessel file that is written from the card.

    Raises click.UsageError if the card lacks what cannot be derived.
    """
    card = card_of(said)
    if card is None:
        raise click.UsageError(
            "--yes needs the ship's main particulars by options, such as --power-kw 221; see --help."
        )
    path = free(str(folder / VESSEL_FILE))
    file = lying.recordings[-1] if lying.recordings else None
    write_from_card(card, path, stated=channels_of(said), recording=file, channels=recorded.channels)
    return path


def _asked(said: Mapping[str, object], recorded: Mapping[str, object]) -> dict[str, object]:
    """Return what was said, and what is asked for in addition.

    Raises click.UsageError where nobody is there who could answer.
    """
    try:
        return ask_card(said, _prompt, recorded=recorded)
    except click.Abort:
        if sys.stdin.isatty():
            raise
        echo(err=True)
        raise click.UsageError(
            "expected an answer, found the end of what was typed; state the main particulars as options, with --yes."
        ) from None


def _prompt(text: str, kind: Any, default: object) -> object:
    """Ask for one answer on the error output, so that the output holds what was found alone."""
    if default is not None:
        return click.prompt(text, type=kind, default=default, err=True)
    return click.prompt(text, default="", show_default=False, value_proc=_answered(kind), err=True)


def _answered(kind: Any) -> Callable[[str], object]:
    """Return a type of answers that says of an empty one that it is none, where click would ask again for ever."""
    of_kind = click.types.convert_type(kind)

    def convert(text: str) -> object:
        if not text.strip():
            raise click.UsageError("an answer is needed; Ctrl+C ends.")
        return of_kind(text)

    return convert


def _next(vessel: Path, lying: LyingFiles, reading: tuple[object, ...]) -> list[tuple[object, ...]]:
    """Return the next commands, the first to be done first."""
    ship = load_vessel(vessel)
    if not lying.recordings:
        if not lying.campaigns:
            return [first_plan(vessel, ship)]
        return [("sail", vessel, lying.campaigns[-1], "-o", free("sailed.nc"))]
    recording = lying.recordings[-1]
    files = (recording, *reading, "--vessel", vessel)
    if not lying.campaigns:
        return [("new", "campaign", free("campaign.toml"), "--from", *files)]
    # a campaign that was written after the recording is that of the next test
    written = recording.stat().st_mtime
    campaign = [lying.campaigns[0], *(one for one in lying.campaigns if one.stat().st_mtime <= written)][-1]
    of_test = (*files, "--campaign", campaign)
    if not lying.results or lying.results[-1].stat().st_mtime < recording.stat().st_mtime:
        return [("inspect", *of_test), ("identify", *of_test, "-o", free("result"))]
    result = lying.results[-1]
    try:
        fingerprint = fingerprint_at(result)
    except ShaftprintError:
        return [("show", result)]
    following = after_test(
        (recording, vessel, campaign), (result, fingerprint), ship, load_campaign(campaign), reading=reading
    )
    return following or [("show", result)]
