"""``shaftprint convert``: recordings of other formats into the native container, or into another format."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import click

from shaftprint.choices import NATIVE_ENDINGS
from shaftprint.cli._next import print_next
from shaftprint.cli._options import cut_options, hints_of, output_options, reading_options
from shaftprint.cli._terminal import answer, echo
from shaftprint.cli.output._file_to_write import expect_no_input
from shaftprint.cli.output._progress import no_progress_option, progress
from shaftprint.errors import RecordingError
from shaftprint.late import late

with late():
    from shaftprint.recording._channel import Channel
    from shaftprint.recording._cut import cut
    from shaftprint.recording._read import read_recording
    from shaftprint.recording._recording import Recording
    from shaftprint.recording.writers._by_ending import expect_known_ending, held_date, write_by_ending
    from shaftprint.signals._at_rate import at_rate


@click.command("convert")
@click.argument("recordings", nargs=-1, required=True, metavar="IN...", type=click.Path(path_type=Path))
@output_options("Folder for several inputs, which get .nc there, or file to write")
@click.option("--channel", "chosen", multiple=True, help="Only this channel; may be given several times.")
@click.option("--unit", "units", multiple=True, metavar="CHANNEL=UNIT", help="Unit of a channel whose file gives none.")
@click.option(
    "--rate",
    "rate_hz",
    type=float,
    help="Rate for all channels [Hz]: faster ones are filtered, slower and uneven ones splined. Not for pulses.",
)
@click.option("--force", is_flag=True, help="Replace an existing file.")
@cut_options
@reading_options
@no_progress_option
def command(
    recordings: tuple[Path, ...],
    output: Path,
    chosen_format: str | None,
    chosen: tuple[str, ...],
    units: tuple[str, ...],
    rate_hz: float | None,
    force: bool,
    from_s: float | None,
    to_s: float | None,
    no_progress: bool,
    **said: object,
) -> None:
    """Write recordings of any readable format as NetCDF or in another format.

    Channels keep their own clocks and counts. The ending of the output chooses another format. --from and --to cut;
    what is left keeps its times, so that a campaign file holds for it too. Input files are not changed.
    """
    into_folder = output.is_dir()
    if len(recordings) > 1 and not into_folder:
        raise click.UsageError(f"{output}: expected an existing folder for {len(recordings)} recordings.")
    targets = [output / f"{path.name.removesuffix('.gz')}.nc" if into_folder else output for path in recordings]
    for target in targets:
        expect_no_input(target, *recordings)
    unit_of = dict(_unit(text) for text in units)
    with progress(hidden=no_progress) as steps:
        for source, target in zip(recordings, targets, strict=True):
            expect_known_ending(target, format=chosen_format)
            steps.begin(f"Converting {source.name}")
            with read_recording(source, **hints_of(**said)) as recording:
                opened = cut(_only(recording, chosen), from_s=from_s, to_s=to_s)
                opened = opened if rate_hz is None else at_rate(opened, rate_hz)
                channels = [_with_unit(opened, name, unit_of) for name in opened.channels]
                losses = write_by_ending(
                    target,
                    channels,
                    attributes=opened.attributes,
                    began=opened.began,
                    overwrite=force,
                    format=chosen_format,
                )
                left_out = dict(opened.left_out) | _facts_left_out(opened, target, chosen_format)
            for remark in recording.remarks:
                echo(f"{source}: {remark}", err=True)
            for loss in losses:
                echo(f"{target}: {loss}", err=True)
            for name, reason in left_out.items():
                echo(f"{source}: left out {name}: {reason}", err=True)
            answer(f"{target}: {len(channels)} channels of {source}.")
    print_next("inspect", targets[0])


def _only(recording: Recording, chosen: tuple[str, ...]) -> Recording:
    """Return a recording with some of its channels, in the order in which they were asked for; all if none was."""
    if not chosen:
        return recording
    return replace(recording, channels={name: recording.channel(name) for name in chosen})


def _facts_left_out(opened: Recording, target: Path, format: str | None) -> dict[str, str]:
    """Return which facts on the whole recording the target cannot hold, with the reason."""
    if target.suffix.lower() in NATIVE_ENDINGS:
        return {}
    only = "only the native container (.nc) holds it"
    facts = {f"the attribute {name}": only for name in opened.attributes}
    facts |= {f"the jumps of the clock of {name}": only for name, one in opened.channels.items() if one.clock_jumps}
    held = held_date(target, opened.began, format=format)
    if opened.began is not None and held != opened.began:
        what = "the date of second 0" if held is None else "the offset from UTC of the date of second 0"
        facts[what] = f"{opened.began.isoformat(sep=' ')}: the native container (.nc) holds it"
    return facts


def _unit(text: str) -> tuple[str, str]:
    name, separator, unit = text.rpartition("=")
    if not separator or not name:
        raise click.UsageError(f'--unit: expected CHANNEL=UNIT such as M_s="N m", found "{text}".')
    return name, unit


def _with_unit(opened: Recording, name: str, units: dict[str, str]) -> Channel:
    """Return a channel with the unit that was given for it, which must not contradict the file's."""
    channel = opened.channel(name)
    if name not in units or units[name] == channel.unit:
        return channel
    if channel.unit:
        raise RecordingError(
            f'{opened.path}, channel {name}: expected no other unit than the file\'s "{channel.unit}", found '
            f'"{units[name]}"; leave --unit out.'
        )
    return channel.with_unit(units[name])
