"""``shaftprint merge``: recordings of several loggers on one clock, in one file."""

from pathlib import Path

import click

from shaftprint.cli._options import NAMES
from shaftprint.cli._terminal import answer
from shaftprint.cli.output import expect_no_input, print_tables
from shaftprint.clocks import align, logger_clocks, merged
from shaftprint.recording import Recording, read_recording, write_recording
from shaftprint.signals import Content, content_of
from shaftprint.tables import clock_map_table
from shaftprint.vessel import Vessel, load_vessel

RATE_HZ = 50.0
"""Rate at which contents are compared [Hz]."""


@click.command("merge")
@click.argument("reference", type=click.Path(path_type=Path))
@click.argument("other", type=click.Path(path_type=Path))
@click.option(
    "--shared",
    required=True,
    metavar="CHANNEL=CHANNEL",
    help="The channel of REFERENCE and that of OTHER which show the same, such as PTM_e=EngineSpeed.",
)
@click.option("--vessel", help=f"Vessel file, {NAMES} stan-tug-1205: says which channels hold pulses.")
@click.option("--latency", "latency_ms", type=float, default=0.0, help="How late OTHER shows it [ms]; 0 by default.")
@click.option("--latency-std", "latency_std_ms", type=float, default=0.0, help="Standard deviation of that [ms].")
@click.option("-o", "--output", type=click.Path(path_type=Path), required=True, help="Recording to write.")
@click.option("--force", is_flag=True, help="Replace an earlier recording.")
def command(
    reference: Path,
    other: Path,
    shared: str,
    vessel: str | None,
    latency_ms: float,
    latency_std_ms: float,
    output: Path,
    *,
    force: bool,
) -> None:
    """Bring the recordings of two loggers onto the clock of the first.

    The offset and drift of OTHER's clock are found from a channel that both have logged. Samples are not moved: the
    channels of OTHER get another start and rate in the file that is written.
    """
    expect_no_input(output, reference, other)
    ship = None if vessel is None else load_vessel(vessel)
    names = _names(shared)
    with read_recording(reference) as still, read_recording(other) as moving:
        alignment = align(
            _content(moving, names[1], ship),
            _content(still, names[0], ship),
            latency_s=1e-3 * latency_ms,
            latency_std_s=1e-3 * latency_std_ms,
        )
        both = merged(still, [(moving, alignment)])
        print_tables([clock_map_table(logger_clocks(both))])
        write_recording(output, both.channels.values(), attributes=both.attributes, overwrite=force)
    answer(output)


def _names(shared: str) -> tuple[str, str]:
    first, sign, second = shared.partition("=")
    if not (first and sign and second):
        raise click.BadParameter(f"expected CHANNEL=CHANNEL, found {shared}.", param_hint="--shared")
    return first, second


def _content(recording: Recording, name: str, ship: Vessel | None) -> Content:
    sensors = {} if ship is None else {sensor.channel: sensor for sensor in ship.sensors.speed}
    return content_of(recording.channel(name), sensors.get(name), rate_hz=RATE_HZ)
