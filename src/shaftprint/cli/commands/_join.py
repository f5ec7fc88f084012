"""``shaftprint join``: files that one logger wrote one after the other, in one file."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path

import click

from shaftprint.cli._next import print_next
from shaftprint.cli._options import cut_options
from shaftprint.cli._terminal import answer, echo
from shaftprint.cli.output._file_to_write import expect_no_input
from shaftprint.late import late

with late():
    from shaftprint.clocks._merge import joined
    from shaftprint.recording._cut import cut
    from shaftprint.recording._read import read_recording
    from shaftprint.recording._write import write_recording


@click.command("join")
@click.argument("parts", type=click.Path(path_type=Path), nargs=-1, required=True)
@click.option("-o", "--output", type=click.Path(path_type=Path), required=True, help="Recording to write.")
@click.option("--follow-on", is_flag=True, help="Each part begins where the one before ends, whatever its clock says.")
@cut_options
@click.option("--force", is_flag=True, help="Replace an earlier recording.")
def command(
    parts: tuple[Path, ...], output: Path, *, follow_on: bool, from_s: float | None, to_s: float | None, force: bool
) -> None:
    """Join files that one logger wrote one after the other, in the order given.

    Every part must begin where the one before it ends. --from and --to cut the whole; what is left keeps its times.
    """
    expect_no_input(output, *parts)
    with ExitStack() as stack:
        opened = [stack.enter_context(read_recording(part)) for part in parts]
        recording = cut(joined(opened, follow_on=follow_on), from_s=from_s, to_s=to_s)
        write_recording(
            output, recording.channels.values(), attributes=recording.attributes, began=recording.began, overwrite=force
        )
        for channel in recording.channels.values():
            echo(f"{channel.name}: {channel.count} samples, {channel.duration_s:.1f} s")
    answer(output)
    print_next("inspect", output)
