"""The campaign file that a recording shows, with what of it no such file can say."""

from __future__ import annotations

from pathlib import Path

from shaftprint.cli._terminal import answer, print_findings
from shaftprint.cli.output._file_to_write import expect_free
from shaftprint.errors import SettingsError
from shaftprint.files import write_bytes
from shaftprint.late import late

with late():
    from shaftprint.campaign._file_text import campaign_text
    from shaftprint.recording._read import read_recording
    from shaftprint.signals._describe_recording import describe_set_point
    from shaftprint.signals.description._describe import Description
    from shaftprint.vessel._vessel import load_vessel


def write_recorded_campaign(recording: Path, vessel: str, file: Path) -> None:
    """Write the campaign that the set point of a recording shows.

    ``recording``, ``vessel``: the recording, and the vessel file that says which channel is the set point. ``file``:
    the campaign file, which must not exist yet.
    """
    expect_free(file, force=False)
    with read_recording(recording) as opened:
        shown = describe_set_point(opened, load_vessel(vessel))
    lines = [
        f"What the set point of {recording.name} shows. Before settled_s the response to the begin dies out: a guess."
    ]
    lines += [f"Not described: {sentence}" for sentence in _left_out(shown)]
    text = campaign_text(shown.campaign, remarks="\n".join(lines))
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
