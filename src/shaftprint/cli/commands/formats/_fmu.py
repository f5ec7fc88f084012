"""``shaftprint export fmu``: a model as a functional mock-up unit."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Literal

import click

from shaftprint.cli._next import after_drive, print_next
from shaftprint.cli._terminal import answer, say
from shaftprint.cli.commands.formats._exported import (
    file_to_write,
    fingerprint_argument,
    force_option,
    linear_option,
    model_to_export,
    output_option,
    set_option,
    structure_option,
)
from shaftprint.cli.output._progress import no_progress_option, progress
from shaftprint.digits import plain_letters, rounded
from shaftprint.export._fmu_build import PLATFORMS
from shaftprint.late import late

with late():
    import numpy as np

    from shaftprint.catalogue._own_structure import TypedName
    from shaftprint.export._fmu import WrittenFmu, write_fmu


ALL, WINDOWS = "all", "win64"


@click.command("fmu")
@fingerprint_argument
@structure_option
@linear_option
@set_option
@click.option(
    "--fmi", "version", type=click.Choice(["2", "3"]), default="2", show_default=True, help="Version of the interface."
)
@click.option(
    "--platform",
    "platforms",
    type=click.Choice([*PLATFORMS, ALL]),
    multiple=True,
    help="System to compile for, may be repeated; this computer's by default. Others than this one need the extra fmu.",
)
@click.option("--source-only", is_flag=True, help="Compile nothing; the user's tool compiles the sources.")
@click.option(
    "--sample",
    "samples",
    type=click.IntRange(min=0, max=10000),
    default=0,
    show_default=True,
    help="Samples of the parameters by their covariance, one of which is chosen by the parameter posterior_sample.",
)
@click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True, help="Start of the random numbers.")
@output_option
@force_option
@no_progress_option
def command(
    fingerprint: Path,
    structure: TypedName | None,
    linear: bool,
    given: Mapping[str, float],
    version: str,
    platforms: tuple[str, ...],
    source_only: bool,
    samples: int,
    seed: int,
    output: Path | None,
    force: bool,
    no_progress: bool,
) -> None:
    """Write an FMU (FMI 2.0 or 3.0) for Simulink, Open Simulation Platform and others.

    FINGERPRINT is the JSON file, or the folder in which identify or demo has put it. The FMU is for
    co-simulation and model exchange, has exact delays and its sources, and every parameter of the
    structure can be tuned. Inputs and outputs are absolute rpm and N m, not deviations. Choose
    co-simulation where your tool has it: the FMU then takes its own steps.
    """
    if source_only and platforms:
        raise click.UsageError("--source-only compiles nothing: leave --platform out.")
    model = model_to_export(fingerprint, structure, given, linear=linear)
    path = file_to_write(output, model, ".fmu", inputs=(fingerprint,), force=force)
    number: Literal[2, 3] = 2 if version == "2" else 3
    with progress(hidden=no_progress) as steps:
        steps.begin("Compiling, for other systems the first time for some minutes", total=1.0)
        written = write_fmu(
            model,
            path,
            version=number,
            platforms=() if source_only else tuple(PLATFORMS) if ALL in platforms else platforms or None,
            samples=samples,
            rng=np.random.default_rng(seed),
            overwrite=force,
            progress=steps.reach,
        )
    _print(written)
    if not (source_only or platforms or WINDOWS in written.platforms):
        say(f"for Simulink on Windows add --platform {WINDOWS}")
    if model.is_of_a_ship:
        print_next("validate", "LOG", "--vessel", "VESSEL", "--campaign", "CAMPAIGN", "--model", written.path)
    else:
        print_next(*after_drive("DRIVE", fingerprint))


def _print(written: WrittenFmu) -> None:
    kinds = "co-simulation and model exchange" if written.model_exchange else "co-simulation only"
    say(f"FMI {written.version}.0, {kinds}, sources, binaries for {', '.join(written.platforms) or 'no system'}")
    step_s = written.internal_step_s
    largest_ms = 1e3 * written.largest_step_s
    stable = f"; stable up to {plain_letters(rounded(largest_ms, 2))} ms" if largest_ms else ""
    say(f"internal step {1e3 * step_s:g} ms{stable}")
    if written.model_exchange:
        say("choose co-simulation in your tool: in model exchange the tool's own solver must stop at every event")
    for name in written.late_outputs:
        say(f"{name} comes later than its time stamp in the recording, by lateness.{name} in the FMU")
    answer(written.path)
    if written.failed:
        raise click.ClickException(
            f"{written.path} has binaries for {', '.join(written.platforms)} only. {' '.join(written.failed)} What was "
            "compiled is kept: to try the others again, give --force as well."
        )
