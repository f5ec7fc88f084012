"""``shaftprint live channels``: a list of data channels by ISO 19848, and what is wrong in it."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

import click

from shaftprint.cli._options import SettingsPath
from shaftprint.cli._terminal import answer, print_findings
from shaftprint.cli.output._json import give
from shaftprint.cli.output._tables import print_table
from shaftprint.escape import printable
from shaftprint.late import late
from shaftprint.plain_table import Column, Table, numbers, texts

with late():
    from shaftprint.live.counterparts._channel_list import read_channel_list
    from shaftprint.vessel._vessel import load_vessel

if TYPE_CHECKING:
    from shaftprint.live.counterparts._channel_list import DataChannel


@click.command("channels")
@click.argument("path", metavar="LIST", type=click.Path(path_type=Path))
@click.option(
    "--vessel",
    type=SettingsPath("vessel", "stan-tug-1205"),
    help="Vessel file: its local_ids are looked up in the list, and those alone are shown.",
)
def command(path: Path, vessel: str | None) -> None:
    """Show what a list of data channels (ISO 19848) offers, and what is wrong in it.

    LIST is XML or JSON, as a data server of the ship exports it. With --vessel ends with 1 where a local id of the
    vessel file is not there, or is there twice.
    """
    offered = read_channel_list(path)
    give("list", offered)
    rows = {one.name: one for one in offered.channels}
    if vessel is not None:
        named = load_vessel(vessel).sensors.local_ids
        rows = offered.named({one.channel: one.local_id for one in named})
    print_table(
        Table(
            title=f"{offered.ship} {offered.version}".strip(),
            columns=(
                *texts("channel", "values come as", "measures", "unit"),
                *numbers("each [s]"),
                Column("on board", spare=True),
            ),
            rows=tuple(_row(name, one) for name, one in rows.items()),
        )
    )
    if offered.findings:
        print_findings("What is wrong", offered.findings, is_answer=True)
    known = sum(one.local_id is not None for one in offered.channels)
    answer(
        f"{printable(str(path))}: {len(offered.channels)} channels, {known} of them by the rule dnv-v2; "
        f"{len(offered.findings)} findings."
    )


def _row(name: str, channel: DataChannel) -> tuple[str, ...]:
    local_id = channel.local_id
    measures = "another rule" if local_id is None else local_id.tags.get("qty", "")
    is_asked = local_id is not None and local_id.is_set_point
    return (
        name,
        channel.short_id,
        f"{measures}, set point" if is_asked else measures,
        channel.unit,
        "" if math.isnan(channel.cycle_s) else f"{channel.cycle_s:g}",
        channel.words,
    )
