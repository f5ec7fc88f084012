"""``shaftprint merge``: recordings of several loggers on one clock, in one file."""

from pathlib import Path

import click
import numpy as np

from shaftprint.cli._inputs import NAMES
from shaftprint.cli._tables import print_table
from shaftprint.clocks import Alignment, align, merged
from shaftprint.recording import Recording, read_recording, write_recording
from shaftprint.signals import Content, content_of
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
    ship = None if vessel is None else load_vessel(vessel)
    names = _names(shared)
    with read_recording(reference) as still, read_recording(other) as moving:
        found = align(
            _content(moving, names[1], ship),
            _content(still, names[0], ship),
            latency_s=1e-3 * latency_ms,
            latency_std_s=1e-3 * latency_std_ms,
        )
        _print(found, moving)
        both = merged(still, [(moving, found.map)])
        write_recording(output, both.channels.values(), attributes=_facts(found, moving), overwrite=force)
    click.echo(output)


def _names(shared: str) -> tuple[str, str]:
    first, sign, second = shared.partition("=")
    if not (first and sign and second):
        raise click.BadParameter(f"expected CHANNEL=CHANNEL, found {shared}.", param_hint="--shared")
    return first, second


def _content(recording: Recording, name: str, ship: Vessel | None) -> Content:
    sensors = {} if ship is None else {sensor.channel: sensor for sensor in ship.sensors.speed}
    return content_of(recording.channel(name), sensors.get(name), rate_hz=RATE_HZ)


def _print(found: Alignment, moving: Recording) -> None:
    clock = found.map
    offset_std, drift_std = np.sqrt(np.diag(clock.covariance))
    rows = [
        (
            "offset",
            "s",
            f"{clock.offset_s:.6f}",
            f"{offset_std:.2g}",
            f"at {clock.middle_s:.0f} s of {moving.path.name}",
        ),
        ("drift", "ppm", f"{1e6 * clock.drift:.3f}", f"{1e6 * drift_std:.2g}", "of the reference against it"),
        ("worst within the recording", "ms", "", f"{1e3 * found.worst_std_s:.2g}", ""),
        ("minutes compared", "", str(len(found.stretches)), "", f"scatter {found.scatter:.2f} of what noise explains"),
    ]
    print_table(
        "Clock map", ("quantity", "unit", "value", "standard deviation", "remark"), rows, numbers={2, 3}, spare=True
    )


def _facts(found: Alignment, moving: Recording) -> dict[str, str | float]:
    clock = found.map
    return {
        "clock_of": moving.path.name,
        "clock_sha256": moving.sha256,
        "clock_offset_s": clock.offset_s,
        "clock_drift": clock.drift,
        "clock_middle_s": clock.middle_s,
        "clock_offset_std_s": float(np.sqrt(clock.covariance[0, 0])),
        "clock_drift_std": float(np.sqrt(clock.covariance[1, 1])),
    }
