"""``shaftprint simulate``: what a model does for a set point."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path

import click

from shaftprint.choices import CRASH_STOP
from shaftprint.cli._known_values import by_name, named_value
from shaftprint.cli._option_sections import SectionedCommand
from shaftprint.cli._options import LIMITED_HELP, NAMES, OWN_FILE_HELP
from shaftprint.cli._ship_options import rpm_per_volt_option
from shaftprint.cli._terminal import answer, say
from shaftprint.cli._vessel_file import checked_vessel
from shaftprint.cli.commands._inertia import picture
from shaftprint.cli.output._file_to_write import expect_free, expect_no_input
from shaftprint.cli.output._fingerprint_file import fingerprint_at, fingerprint_file
from shaftprint.cli.output._progress import no_progress_option, progress
from shaftprint.cli.output._tables import print_table
from shaftprint.digits import rounded, unit_text, with_deviation
from shaftprint.files import written_whole
from shaftprint.late import late
from shaftprint.plain_table import MEANING, Table, numbers, texts

with late():
    import numpy as np

    from shaftprint.arrays import FloatArray
    from shaftprint.campaign._campaign import load_campaign
    from shaftprint.catalogue._own_structure import TypedName
    from shaftprint.forecast import _crash_stop
    from shaftprint.forecast._crash_stop import LeverMove, crash_stop
    from shaftprint.forecast._ship_before_test import ShipBeforeTest
    from shaftprint.forecast._simulation import Simulation, simulated_ship, write_simulation
    from shaftprint.report.charts._pictures import save_chart
    from shaftprint.report.figures._simulation import simulation_chart
    from shaftprint.vessel import _vessel


class _LeverMoveType(click.ParamType):  # type: ignore[type-arg]
    """``TIME:SPEED:GEAR``."""

    name = "move"

    def convert(self, value: object, param: click.Parameter | None, ctx: click.Context | None) -> LeverMove:
        """Return a move as it was typed."""
        try:
            time, speed, gear = str(value).split(":")
            move = LeverMove(time_s=float(time), speed_rpm=float(speed), gear=_crash_stop.GEARS[gear.strip().lower()])
        except (ValueError, KeyError):
            move = None
        if move is None or not (0.0 <= move.time_s < np.inf and 0.0 < move.speed_rpm < np.inf):
            self.fail(
                f"expected a time in s, an engine speed in rpm and one of {', '.join(_crash_stop.GEARS)}, "
                f"such as 5:650:neutral, found {value}.",
                param,
                ctx,
            )
        return move


def span_of_time(
    context: click.Context, parameter: click.Parameter, span: tuple[float, float] | None
) -> tuple[float, float] | None:
    """Return the stretch of time as it was given.

    Raises click.BadParameter if it is not ascending.
    """
    if span is not None and not -np.inf < span[0] < span[1] < np.inf:
        raise click.BadParameter(f"expected begin and end in this order, found {span[0]:g} and {span[1]:g}.")
    return span


@click.command(
    "simulate",
    cls=SectionedCommand,
    example="shaftprint simulate --fingerprint result --campaign test.toml -o response.csv",
    sections={
        "Model": ("--fingerprint", "--structure", "--linear", "--set", "--vessel"),
        "Set point": ("--campaign", "--input", "--hold", "--lever", "--between", "--rpm-per-volt", "--rate"),
    },
)
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
    callback=by_name,
    help="Value of a parameter; may be repeated.",
)
@click.option("--campaign", help=f"Set point of a campaign: {NAMES} thesis.")
@click.option(
    "--input",
    "table",
    type=click.Path(path_type=Path),
    help='Instead of a campaign a CSV, MATLAB or NetCDF file with columns named as the inputs; "set point [rpm]" too.',
)
@click.option(
    "--lever",
    "moves",
    metavar="TIME:RPM:GEAR",
    type=_LeverMoveType(),
    multiple=True,
    help=f"For {CRASH_STOP}: from this time [s] the lever asks for an engine speed and ahead, neutral or astern, such "
    "as 5:650:neutral; may be repeated. Ahead at the working point before.",
)
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
    given: Mapping[str, float],
    campaign: str | None,
    table: Path | None,
    moves: tuple[LeverMove, ...],
    hold: bool,
    vessel: str | None,
    slope_rpm_per_v: float | None,
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
    is_stop = structure is not None and structure.upper() == CRASH_STOP
    if is_stop:
        _expect_only_a_lever(campaign, table, slope_rpm_per_v, linear or None, hold or None)
    elif moves:
        raise click.UsageError(f"--lever is for --structure {CRASH_STOP}, whose engine has clutches.")
    elif (campaign is None) == (table is None):
        raise click.UsageError("expected one set point: either --campaign or --input.")
    load = checked_vessel if is_stop else _vessel.load_vessel
    ship = ShipBeforeTest(
        first_test=identified,
        vessel=None if vessel is None else load(vessel),
        slope_rpm_per_v=slope_rpm_per_v,
        values=given,
    )
    with progress(hidden=no_progress) as steps:
        if is_stop:
            simulation = crash_stop(ship, moves, rate_hz=rate_hz, span=span, progress=steps)
        else:
            simulation = simulated_ship(
                ship,
                load_campaign(campaign) if campaign is not None else Path(str(table)),
                structure=structure,
                linear=linear,
                hold=hold,
                span=span,
                rate_hz=rate_hz,
                progress=steps,
            )
        if figure is not None:
            steps.begin("Drawing")
            chart = simulation_chart(simulation.time_s, simulation.signals, name=simulation.run.model.structure.name)
            with written_whole(figure, overwrite=True) as part:
                save_chart(chart, part)
        steps.begin("Writing")
        write_simulation(output, simulation, overwrite=force)
    for sentence in simulation.answers:
        answer(sentence)
    print_simulation(simulation)
    for path in (output, figure):
        if path is not None:
            answer(path)


def _expect_only_a_lever(*others: object) -> None:
    if any(other is not None for other in others):
        raise click.UsageError(
            f"{CRASH_STOP} is moved by --lever alone, without --campaign, --input, --rpm-per-volt, --linear or --hold."
        )


VALUE_DIGITS, RANGE_DIGITS, STD_DIGITS = 6, 5, 2
# Of the largest value: less is what rounding leaves of zero.
NOTHING = 1e-12


def print_simulation(simulation: Simulation) -> None:
    """Print the parameters with where they come from, the range of every signal, and what a reader must know."""
    model, time_s = simulation.run.model, simulation.time_s
    structure = model.structure
    std = dict(zip(model.uncertain, np.sqrt(np.diag(model.covariance)), strict=True))
    std |= dict.fromkeys(model.not_known, math.inf)
    values = [
        (p.name, _value(value, std.get(p.name)), unit_text(p.unit), origin, p.meaning)
        for p, value, origin in zip(structure.parameters, model.values, model.origins, strict=True)
        if not (p.held and value == 0.0 and origin != "--set")
    ]
    print_table(
        Table(
            title=f"{structure.name}: {structure.title}",
            columns=(*texts("parameter"), *numbers("value"), *texts("unit", "from"), MEANING),
            rows=tuple(values),
        )
    )
    ranges = [
        (
            signal.title,
            signal.unit,
            *(rounded(end, RANGE_DIGITS) for end in _ends(signal.values)),
            "" if signal.std is None else rounded(float(signal.std.max()), STD_DIGITS),
        )
        for signal in simulation.signals
    ]
    print_table(
        Table(
            title=f"From {time_s[0]:g} to {time_s[-1]:g} s",
            columns=(*texts("signal", "unit"), *numbers("lowest", "highest", "largest std")),
            rows=tuple(ranges),
        )
    )
    if model.uncertain:
        say("The standard deviations hold the covariance of the parameters, not noise, weather or load.")
    if model.not_known:
        pronoun = "it" if len(model.not_known) == 1 else "them"
        say(f"The test said nothing of {', '.join(model.not_known)}: the band leaves {pronoun} out.")
    for sentence in simulation.remarks:
        say(sentence)


def _ends(values: FloatArray) -> tuple[float, float]:
    """Return the smallest and the largest value, without what rounding leaves of zero."""
    ends = (float(values.min()), float(values.max()))
    nothing = NOTHING * max(map(abs, ends))
    return tuple(0.0 if abs(end) < nothing else end for end in ends)  # type: ignore[return-value]


def _value(value: float, std: float | None) -> str:
    return rounded(value, VALUE_DIGITS) if std is None else with_deviation(value, std)
