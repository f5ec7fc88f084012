"""``shaftprint new``: a commented settings file to fill in, or the campaign that a recording shows."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal

import click

from shaftprint.cli._card_options import CARD_SECTIONS, card_of, card_options, channels_of
from shaftprint.cli._next import free, plan_words, print_next
from shaftprint.cli._option_sections import SectionedCommand
from shaftprint.cli._options import (
    NAMES,
    READING_BESIDE_CARD,
    further_reading_options,
    hints_of,
    of_card_and_reading,
    reading_words,
)
from shaftprint.cli._terminal import answer, echo, print_findings
from shaftprint.cli._vessel_file import write_from_card
from shaftprint.cli.output._file_to_write import expect_free
from shaftprint.errors import SettingsError
from shaftprint.files import write_bytes
from shaftprint.late import late

with late():
    from shaftprint.bench._recorded_drive import recorded_drive
    from shaftprint.campaign._file_text import campaign_text
    from shaftprint.forecast._shipped_test import shipped_test
    from shaftprint.recording._read import read_recording
    from shaftprint.settings import write_template
    from shaftprint.signals._describe_recording import describe_set_point
    from shaftprint.signals.description._describe import Description
    from shaftprint.vessel._vessel import load_vessel


TESTS: Mapping[str, str] = {
    "12min": "12 minutes, two speeds",
    "5min": "5 minutes, two speeds",
    "short": "14 minutes of sines",
    "thesis": "the thesis' 3.2 hours",
}
"""Shipped campaigns to begin with, and what they are."""
_CALLED = {"vessel": "a vessel", "campaign": "a campaign", "conditions": "the conditions of a test", "drive": "a drive"}


@click.command(
    "new",
    cls=SectionedCommand,
    example="shaftprint new vessel mine.toml\nshaftprint new campaign --test 12min test.toml",
    sections={"File": ("--output", "--test", "--from", "--vessel"), **CARD_SECTIONS, **READING_BESIDE_CARD},
)
@click.argument("kind", type=click.Choice(["vessel", "campaign", "conditions", "drive"]))
@click.argument("file", type=click.Path(path_type=Path), required=False)
@click.option(
    "--test",
    type=click.Choice([*TESTS]),
    help=f"A campaign to begin with: {'; '.join(f'{name}, {words}' for name, words in TESTS.items())}.",
)
@click.option(
    "--from",
    "recorded",
    metavar="RECORDING",
    type=click.Path(path_type=Path),
    help="A recording: the campaign file says what its set point shows, with --vessel; the drive file begins with its "
    "channels.",
)
@click.option(
    "--vessel",
    help=f"Vessel file of that recording or test, {NAMES} stan-tug-1205: says which channel and which lever it is.",
)
@click.option("-o", "--output", type=click.Path(path_type=Path), help="The file, in place of FILE.")
@card_options
@further_reading_options
def command(
    kind: Literal["vessel", "campaign", "conditions", "drive"],
    file: Path | None,
    test: str | None,
    recorded: Path | None,
    vessel: str | None,
    output: Path | None,
    **said: object,
) -> None:
    """Write a commented vessel, campaign, conditions or drive file to fill in.

    FILE must not exist yet. It can be loaded as it stands; every key carries its unit in its name. The campaigns of
    --test are made for the Stan Tug 1205; with --vessel they move the lever of that ship, about its working speed.

    With --from RECORDING and --vessel the campaign file says what the recorded set point shows, each sine, multisine,
    binary sequence, chirp, staircase and ramp with its times; what is none of these is named. A drive file --from
    RECORDING begins with its channels and their units: a motor where they are voltage, current and speed, else a lag
    from one of them to the others.

    With the ship's main particulars the vessel file is filled in. That needs --power-kw, --rated-rpm, --cylinders,
    --diameter-m, --blades, --pitch-ratio and --ratio or --propeller-rpm; the rest is derived or usual, and comments in
    the file say where each number is from and how uncertain it is.
    """
    of_card, reading = of_card_and_reading(said)
    if recorded is not None and kind != "vessel":
        reading["sample_rate"] = of_card.pop("sample_rate_hz", None)
    words, hints = reading_words(**reading), hints_of(**reading)
    if words and recorded is None:
        raise click.UsageError(f"{words[0]} says how a recording is read; name it with --from.")
    card = card_of(of_card)
    path = _path(file, output)
    if test is not None and kind != "campaign":
        raise click.UsageError("--test names a campaign to begin with; write `shaftprint new campaign`.")
    if card is not None and kind != "vessel":
        raise click.UsageError("Main particulars make a vessel file; write `shaftprint new vessel`.")
    if recorded is not None and kind == "drive":
        if vessel is not None or test is not None or card is not None:
            raise click.UsageError("--from makes a drive file of a recording; write `shaftprint new drive` alone.")
        expect_free(path, force=False)
        drive = recorded_drive(recorded, **hints)
        write_bytes(path, drive.text.encode(), noun="drive file", error=SettingsError)
        answer(f"{path}: {len(drive.channels)} channels of {recorded}; {drive.moved} as the input, by a guess.")
        if drive.left_out:
            echo(f"On other clocks or without a number, and not in the file: {', '.join(drive.left_out)}.")
        print_next("identify", recorded, *words, "--drive", path, "-o", free("result"))
        return
    if recorded is not None and vessel is not None:
        if kind != "campaign" or test is not None or card is not None:
            raise click.UsageError(
                "--from makes a campaign file of a recording; write `shaftprint new campaign` alone."
            )
        write_recorded_campaign(recorded, vessel, path, **hints)
        print_next("inspect", recorded, *words, "--vessel", vessel, "--campaign", path)
        return
    if test is not None and vessel is not None:
        ship = load_vessel(vessel)
        campaign, smaller = shipped_test(test, ship, title=f"{TESTS[test]}, {ship.name}")
        text = campaign_text(campaign, remarks=f"{TESTS[test]}, for the lever of {vessel}.")
        write_bytes(path, text.encode(), noun="campaign file", error=SettingsError)
        answer(f"{path}: {TESTS[test]}, for the lever of {vessel}.")
        if smaller:
            answer(smaller)
        print_next("predict", "--vessel", vessel, "--campaign", path)
        print_next("sail", vessel, path, "-o", free("sailed.nc"), label="Tried:")
        return
    if recorded is not None or vessel is not None:
        raise click.UsageError(
            "--from needs --vessel, which says what is in the recording, and --vessel --from or --test."
        )
    if card is not None:
        write_from_card(card, path, stated=channels_of(of_card))
        has_lever = bool(card.lever.pairs) or card.lever.unit == "rpm"
        print_next(*plan_words(path, has_lever=has_lever, rated_rpm=card.rated_speed_rpm))
        return
    write_template(kind, path, shipped=test)
    answer(f"{path}: {_CALLED[kind]} to fill in." if test is None else f"{path}: {TESTS[test]}, for the Stan Tug 1205.")
    if test is not None:
        echo("With --vessel FILE it is made for the lever of another ship.")
    if kind == "vessel":
        print_next("inertia", path)


def _path(file: Path | None, output: Path | None) -> Path:
    """Return the file to write, which is named once."""
    if file is not None and output is None:
        return file
    if output is not None and file is None:
        return output
    raise click.UsageError("expected the file to write once: FILE or -o FILE.")


def write_recorded_campaign(recording: Path, vessel: str, file: Path, **hints: Any) -> None:
    """Write the campaign that the set point of a recording shows.

    ``recording``, ``vessel``: the recording, and the vessel file that says which channel is the set point. ``file``:
    the campaign file, which must not exist yet. ``hints``: what the recording does not say itself.
    """
    expect_free(file, force=False)
    with read_recording(recording, **hints) as opened:
        shown = describe_set_point(opened, load_vessel(vessel))
    lines = [
        f"What the set point of {recording.name} shows. Before settled_s the response to the begin dies out: a guess."
    ]
    lines += [f"Not described: {sentence}" for sentence in _left_out(shown)]
    campaign = shown.campaign.model_copy(update={"read_off": recording.name})
    text = campaign_text(campaign, remarks="\n".join(lines))
    write_bytes(file, text.encode(), noun="campaign file", error=SettingsError)
    tests = shown.campaign.summary().facts
    counts = [f"{kind}: {tests[kind]}" for kind in _KINDS if tests.get(kind)]
    answer(f"{file}: {'; '.join(counts)}.")
    if shown.unexplained_s:
        print_findings("Set point that no test of the file describes", _left_out(shown))


_KINDS = ("staircases", "sines", "multisines", "binary sequences", "chirps")


def _left_out(shown: Description) -> list[str]:
    """Return a sentence for each stretch that is not in the campaign."""
    return [f"from {begin_s:.1f} to {end_s:.1f} s" for begin_s, end_s in shown.unexplained_s]
