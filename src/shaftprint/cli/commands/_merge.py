"""``shaftprint merge``: recordings of several loggers on one clock, in one file."""

from __future__ import annotations

from pathlib import Path

import click

from shaftprint.cli._next import print_next
from shaftprint.cli._options import NAMES
from shaftprint.cli._terminal import answer
from shaftprint.cli.output._file_to_write import expect_no_input
from shaftprint.cli.output._tables import print_tables
from shaftprint.late import late

with late():
    import numpy as np

    from shaftprint.clocks import _coarse
    from shaftprint.clocks._align import align
    from shaftprint.clocks._alignment import Alignment
    from shaftprint.clocks._clock_map import ClockMap
    from shaftprint.clocks._logger_clock import logger_clocks
    from shaftprint.clocks._merge import merged
    from shaftprint.recording._read import read_recording
    from shaftprint.recording._recording import Recording
    from shaftprint.recording._write import write_recording
    from shaftprint.signals._content import Content, content_of
    from shaftprint.tables._recording import clock_map_table
    from shaftprint.vessel._vessel import Vessel, load_vessel


RATE_HZ, SHORT_RATE_HZ = 50.0, 200.0
"""Rate at which contents are compared [Hz], and that at which short ones are, where a shaft that rings tells most."""


@click.command("merge")
@click.argument("reference", type=click.Path(path_type=Path))
@click.argument("other", type=click.Path(path_type=Path))
@click.option(
    "--shared",
    metavar="CHANNEL=CHANNEL",
    help="The channel of REFERENCE and that of OTHER which show the same, such as PTM_e=EngineSpeed.",
)
@click.option(
    "--same-clock",
    is_flag=True,
    help="In place of it: both count seconds from the same instant on one clock, as a counter card in the logger does.",
)
@click.option("--vessel", help=f"Vessel file, {NAMES} stan-tug-1205: says which channels hold pulses.")
@click.option("--latency", "latency_ms", type=float, default=0.0, help="How late OTHER shows it [ms]; 0 by default.")
@click.option("--latency-std", "latency_std_ms", type=float, default=0.0, help="Standard deviation of that [ms].")
@click.option("-o", "--output", type=click.Path(path_type=Path), required=True, help="Recording to write.")
@click.option("--force", is_flag=True, help="Replace an earlier recording.")
def command(
    reference: Path,
    other: Path,
    shared: str | None,
    vessel: str | None,
    latency_ms: float,
    latency_std_ms: float,
    output: Path,
    *,
    same_clock: bool,
    force: bool,
) -> None:
    """Bring the recordings of two loggers onto the clock of the first.

    The offset and drift of OTHER's clock are found from a channel that both have logged, unless they have one clock.
    Samples are not moved: the channels of OTHER get another start and rate in the file that is written.
    """
    expect_no_input(output, reference, other)
    if (shared is None) != same_clock:
        raise click.UsageError("expected one of --shared and --same-clock.")
    ship = None if vessel is None else load_vessel(vessel)
    names = None if shared is None else _names(shared)
    with read_recording(reference) as still, read_recording(other) as moving:
        if names is None:
            alignment = _one_clock(moving)
        else:
            alignment = align(
                *_contents(moving, still, names, ship),
                latency_s=1e-3 * latency_ms,
                latency_std_s=1e-3 * latency_std_ms,
            )
        both = merged(still, [(moving, alignment)])
        print_tables([clock_map_table(logger_clocks(both))])
        write_recording(output, both.channels.values(), attributes=both.attributes, began=both.began, overwrite=force)
    answer(output)
    print_next("inspect", output)


def _one_clock(other: Recording) -> Alignment:
    """Return the alignment of a logger that has the clock of the other."""
    starts_s = [channel.start_s for channel in other.channels.values()]
    stops_s = [channel.start_s + channel.duration_s for channel in other.channels.values()]
    same = ClockMap(offset_s=0.0, drift=0.0, middle_s=0.0, covariance=np.zeros((2, 2)))
    return Alignment(map=same, span_s=(min(starts_s), max(stops_s)))


def _names(shared: str) -> tuple[str, str]:
    first, sign, second = shared.partition("=")
    if not (first and sign and second):
        raise click.BadParameter(f"expected CHANNEL=CHANNEL, found {shared}.", param_hint="--shared")
    return first, second


def _contents(
    other: Recording, reference: Recording, names: tuple[str, str], ship: Vessel | None
) -> tuple[Content, Content]:
    """Return what the shared channels of both show."""
    channels = other.channel(names[1]), reference.channel(names[0])
    rate_hz = SHORT_RATE_HZ if min(channel.duration_s for channel in channels) < _coarse.LONG_S else RATE_HZ
    sensors = {} if ship is None else {sensor.channel: sensor for sensor in ship.sensors.speed}
    moving, still = (content_of(channel, sensors.get(channel.name), rate_hz=rate_hz) for channel in channels)
    return moving, still
