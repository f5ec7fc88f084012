"""``shaftprint simulate``: what a model does for a set point."""

from pathlib import Path

import click
import numpy as np

from shaftprint.catalogue._crash_stop import CRASH_STOP
from shaftprint.catalogue._own_structure import TypedName
from shaftprint.cli._crash_stop import LeverMove, crash_stop_run, is_crash_stop, lever_option
from shaftprint.cli._known_values import named_value, rpm_per_volt_option
from shaftprint.cli._options import NAMES, OWN_FILE_HELP
from shaftprint.cli._simulated_model import LIMITED_HELP, simulated_model
from shaftprint.cli._simulated_set_point import Drive, Place, campaign_drive, file_drive, place_of
from shaftprint.cli._simulation_run import Prediction, Run, predicted, signals_of, write_signals
from shaftprint.cli._simulation_tables import print_simulation
from shaftprint.cli._terminal import answer
from shaftprint.cli.commands._inertia import picture
from shaftprint.cli.output._file_to_write import expect_free, expect_no_input
from shaftprint.cli.output._fingerprint_file import fingerprint_at, fingerprint_file
from shaftprint.cli.output._progress import no_progress_option, progress
from shaftprint.files import written_whole
from shaftprint.models._structure import Structure
from shaftprint.report.charts._pictures import save_chart
from shaftprint.report.figures._simulation import SimulatedSignal, simulation_chart


def span_of_time(
    context: click.Context, parameter: click.Parameter, span: tuple[float, float] | None
) -> tuple[float, float] | None:
    """Return the stretch of time as it was given.

    Raises
    ------
    click.BadParameter
        If it is not ascending.
    """
    if span is not None and not -np.inf < span[0] < span[1] < np.inf:
        raise click.BadParameter(f"expected begin and end in this order, found {span[0]:g} and {span[1]:g}.")
    return span


@click.command("simulate")
@click.option("--fingerprint", type=click.Path(path_type=Path), help="Fingerprint to take values and uncertainty from.")
@click.option(
    "--structure",
    metavar="NAME",
    help=f"Model structure, the fingerprint's with its limits by default: {OWN_FILE_HELP}; or {LIMITED_HELP}; or "
    f"{CRASH_STOP}, a ship that is stopped by its clutches.",
)
@click.option(
    "--linear", is_flag=True, help="Model for small signals, although the fingerprint has the line with its limits."
)
@click.option(
    "--set",
    "given",
    metavar="NAME=VALUE",
    type=named_value,
    multiple=True,
    help="Value of a parameter; may be repeated.",
)
@click.option("--campaign", help=f"Set point of a campaign: {NAMES} thesis.")
@click.option(
    "--input",
    "table",
    type=click.Path(path_type=Path),
    help='Instead of a campaign a CSV, MATLAB or NetCDF file with columns named as the inputs; "set point [rpm]" too.',
)
@lever_option
@click.option("--hold", is_flag=True, help="Keep each value of --input until the next; straight in between otherwise.")
@click.option(
    "--vessel",
    help=f"Vessel file, for a working point without a fingerprint, or the ship that is stopped: {NAMES} stan-tug-1205.",
)
@rpm_per_volt_option
@click.option(
    "--between",
    "span",
    type=float,
    nargs=2,
    metavar="BEGIN END",
    callback=span_of_time,
    help="Part of the set point [s]; the ship runs steadily before it.",
)
@click.option(
    "--rate",
    "rate_hz",
    type=click.FloatRange(min=0.1, max=1000.0),
    default=50.0,
    show_default=True,
    help="Rows a second, for a campaign; a file keeps its own.",
)
@click.option("-o", "--output", required=True, type=click.Path(path_type=Path), help="CSV file to write.")
@click.option("--figure", type=click.Path(path_type=Path), callback=picture, help="Picture to draw: SVG, PNG or PDF.")
@click.option("--force", is_flag=True, help="Replace earlier files.")
@no_progress_option
def command(
    fingerprint: Path | None,
    structure: TypedName | None,
    linear: bool,
    given: tuple[tuple[str, float], ...],
    campaign: str | None,
    table: Path | None,
    moves: tuple[LeverMove, ...],
    hold: bool,
    vessel: str | None,
    rpm_per_volt: float | None,
    span: tuple[float, float] | None,
    rate_hz: float,
    output: Path,
    figure: Path | None,
    force: bool,
    no_progress: bool,
) -> None:
    """Simulate speed and torque for a set point, with limits where the model has them.

    Delays are exact. With a fingerprint, every output has its standard deviation from the covariance of the
    parameters. A working point, of the fingerprint or a vessel file, turns deviations into rpm and N m.
    """
    for path in (output, figure):
        if path is not None:
            expect_no_input(path, table, None if fingerprint is None else fingerprint_file(fingerprint))
            expect_free(path, force=force)
    identified = None if fingerprint is None else fingerprint_at(fingerprint)
    values = dict(given)
    if is_crash_stop(structure):
        _expect_only_a_lever(campaign, table, rpm_per_volt, linear or None, hold or None)
        run = crash_stop_run(vessel, identified, values, moves, rate_hz=rate_hz, span=span)
    else:
        _expect_no_lever(moves)
        place = place_of(identified, vessel, rpm_per_volt)
        model = simulated_model(structure, identified, values, linear=linear)
        run = Run(
            model=model,
            place=place,
            drive=_drive(campaign, table, model.structure, place, hold=hold, span=span, rate_hz=rate_hz),
        )
    with progress(hidden=no_progress) as steps:
        prediction = predicted(run.model, run.drive, steps=steps)
        signals = signals_of(run.drive, prediction, run.place)
        if figure is not None:
            steps.begin("Drawing")
            _draw(run, signals, figure)
        steps.begin("Writing")
        write_signals(output, run.drive.time_s, signals, overwrite=force)
    for sentence in run.answers(prediction):
        answer(sentence)
    warnings = _warnings(run.model.structure, run.drive, prediction)
    print_simulation(run.model, run.drive.time_s, signals, warnings=warnings)
    for path in (output, figure):
        if path is not None:
            answer(path)


def _drive(
    campaign: str | None,
    table: Path | None,
    structure: Structure,
    place: Place | None,
    *,
    hold: bool,
    span: tuple[float, float] | None,
    rate_hz: float,
) -> Drive:
    if (campaign is None) == (table is None):
        raise click.UsageError("expected one set point: either --campaign or --input.")
    if campaign is not None:
        return campaign_drive(campaign, structure, place, rate_hz=rate_hz, span=span)
    assert table is not None  # noqa: S101 - one of both was given
    return file_drive(table, structure, place, hold=hold, span=span)


def _expect_only_a_lever(*others: object) -> None:
    if any(other is not None for other in others):
        raise click.UsageError(
            f"{CRASH_STOP} is moved by --lever alone, without --campaign, --input, --rpm-per-volt, --linear or --hold."
        )


def _expect_no_lever(moves: tuple[LeverMove, ...]) -> None:
    if moves:
        raise click.UsageError(f"--lever is for --structure {CRASH_STOP}, whose engine has clutches.")


def _draw(run: Run, signals: tuple[SimulatedSignal, ...], path: Path) -> None:
    with written_whole(path, overwrite=True) as part:
        save_chart(simulation_chart(run.drive.time_s, signals, name=run.model.structure.name), part)


def _warnings(structure: Structure, drive: Drive, prediction: Prediction) -> list[str]:
    """Return where the set point lies, and what a linear structure leaves out of a propeller's torque."""
    remarks = [drive.remark] if drive.remark else []
    if prediction.not_exact:
        remarks.append(f"Outputs may be up to 2.5 ms early or late where a held value jumps: {prediction.not_exact}")
    linear = all(block.is_linear for block in structure.blocks)
    if not linear or structure.input != "n_set" or not {"n", "M_s"} <= set(prediction.outputs):
        return remarks
    neglected = float(np.max(prediction.outputs["n"] ** 2))
    if neglected < 0.01:
        return remarks
    return [
        *remarks,
        f"The torque of {structure.name} is linear in the speed; at the quay it goes with the square, up to "
        f"{100.0 * neglected:.0f} % of the working-point torque more. --structure GAUGE-QUADRATIC has the square, "
        "GAUGE-TORQUE-RATE limits too.",
    ]
