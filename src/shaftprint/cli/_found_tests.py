"""Where the tests of a campaign are in the recorded set point, as a table and as lines of a campaign file."""

from __future__ import annotations

from contextlib import nullcontext
from pathlib import Path

from shaftprint.cli._terminal import answer, details, echo, say
from shaftprint.cli.output._file_to_write import expect_free
from shaftprint.cli.output._tables import print_table
from shaftprint.errors import SettingsError, SignalError
from shaftprint.files import write_bytes
from shaftprint.late import late
from shaftprint.plain_table import Table, numbers, texts

with late():
    from shaftprint.campaign import _excitations
    from shaftprint.campaign._campaign import Campaign
    from shaftprint.campaign._file_text import campaign_text, tests_text
    from shaftprint.signals.excitation._found_test import FoundTest, common_shift_s
    from shaftprint.signals.excitation._proposed_campaign import proposed_campaign


def print_found_tests(found: tuple[FoundTest, ...], campaign: Campaign, recording: Path) -> None:
    """Print when and how every test was made; where that is other than planned, the lines that fit too.

    ``recording``: the file, off which the campaign may have been read.
    """
    same = "read off this recording" if campaign.is_read_off(recording) else "yes"
    columns = (
        *texts("test"),
        *numbers("planned at [s]", "begins at [s]", "phase [deg]", "frequency [Hz]", "amplitude [V]"),
        *texts("as planned"),
    )
    print_table(
        Table(title="Tests in the recorded set point", columns=columns, rows=tuple(_row(test, same) for test in found))
    )
    if not any(test.differences for test in found):
        return
    shift_s = common_shift_s(found)
    if shift_s:
        say(f"All tests are found {abs(shift_s):.3f} s {'later' if shift_s > 0.0 else 'earlier'} than planned.\n")
    try:
        text = tests_text(proposed_campaign(found, campaign))
    except SignalError as error:
        say(f"No proposal for the campaign file: {error}\n")
        return
    # where the tests are only shifted, the next command writes them so
    is_shifted_only = bool(shift_s) and all(test.is_same for test in found)
    with details() if is_shifted_only else nullcontext():
        echo("Proposal for the campaign file: these tests in place of those that it has\n")
        for line in text.splitlines():
            echo(line)
        echo()


def write_proposal(found: tuple[FoundTest, ...], campaign: Campaign, file: Path, recording: Path) -> None:
    """Write a campaign with its tests where the recorded set point shows them.

    ``found``: where they are. ``campaign``: what was asked. ``file``: the campaign file, which must not exist yet.
    ``recording``: the file that shows them. Raises SignalError if the set point shows too little of them.
    """
    expect_free(file, force=False)
    shift_s = common_shift_s(found)
    moved = f"; all of them {abs(shift_s):.2f} s {'later' if shift_s > 0.0 else 'earlier'}" if shift_s else ""
    remarks = f"{campaign.name}, with its tests at the times that the recorded set point shows{moved}."
    proposed = proposed_campaign(found, campaign).model_copy(update={"read_off": recording.name})
    text = campaign_text(proposed, remarks=remarks)
    write_bytes(file, text.encode(), noun="campaign file", error=SettingsError)
    answer(f"{file}: {remarks}\n")


def _row(test: FoundTest, same: str) -> tuple[str, ...]:
    planned = test.planned
    if not test.is_found:
        return (planned.name, f"{planned.start_s:g}", "not found", "", "", "", "no")
    sine = isinstance(planned, _excitations.Sine)
    return (
        planned.name,
        f"{planned.start_s:g}",
        f"{test.begin_s:.2f}",
        f"{round(test.phase_deg)}" if sine else ("180" if test.is_inverted else "0"),
        f"{test.frequency_hz:.5g}" if sine else "",
        f"{test.amplitude_v:.3g}" if sine else "",
        "no: " + "; ".join(test.differences) if test.differences else same,
    )
