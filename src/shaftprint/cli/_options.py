"""Options that several commands have: vessel, campaign, and what a recording does not say itself."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import click

from shaftprint.choices import CLOSED_LOOPS, COMBINED_LOOP, PITCHED_LOOP, WRITTEN_ENDINGS, WRITTEN_FORMATS

OWN_FILE_HELP = "one of `shaftprint structures`, or my_ship.py:my_loop of your own file, which is Python and is run"
DEFAULT_HELP = (
    f"{CLOSED_LOOPS['engine']}, {CLOSED_LOOPS['motor']} where a motor drives the line, {CLOSED_LOOPS['hybrid']} where "
    f"one helps an engine, {PITCHED_LOOP} where the campaign moves a logged pitch, {COMBINED_LOOP} with a "
    "combinator, or FREE-LOG underway"
)
LIMITED_HELP = (
    "GAUGE-QUADRATIC, GAUGE-TORQUE, GAUGE-TORQUE-RATE and so on: GAUGE-CLOSED at large, with limits; "
    "HYBRID-TORQUE-CLUTCH and so on: GAUGE-HYBRID, whose clutch slips"
)
NAMES = "a path, or the name of a shipped one such as"


NEEDED_BESIDE_DRIVE = "Needed (a ship: --vessel and --campaign; a drive: --drive)"
"""Heading of what a command needs that takes a ship or a drive."""


class SettingsPath(click.types.StringParamType):
    """The path or name of a settings file; where it is missing, how to come by one is said."""

    name = "text"

    def __init__(self, kind: str, example: str) -> None:
        self.kind, self.example = kind, example

    def get_missing_message(self, param: click.Parameter, ctx: click.Context | None) -> str:
        """Return how to come by such a file."""
        return (
            f"Write one with `shaftprint new {self.kind} my_{self.kind}.toml` and fill it in, or name a shipped one "
            f"such as {self.example}."
        )


class NeededOfShips(click.Option):
    """An option that has to be given, but beside ``--drive``."""

    def get_help_record(self, ctx: click.Context) -> tuple[str, str] | None:
        """Return name and help; beside ``--drive`` the heading says of what it is needed."""
        record = super().get_help_record(ctx)
        has_drive = any(one.name == "drive_file" for one in ctx.command.params)
        return (record[0], record[1].replace("  [required]", "")) if record is not None and has_drive else record

    def process_value(self, ctx: click.Context, value: object) -> object:
        """Return the value; None where it is missing beside ``--drive``."""
        # of an option that was not given click holds a mark of its own here
        if isinstance(ctx.params.get("drive_file"), Path) and self.value_is_missing(value):
            return None
        return super().process_value(ctx, value)


def vessel_option(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the option ``--vessel``."""
    kind = SettingsPath("vessel", "stan-tug-1205")
    words = f"Vessel file: {NAMES} stan-tug-1205."
    return click.option("--vessel", cls=NeededOfShips, required=True, type=kind, help=words)(command)


def campaign_option(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the option ``--campaign``."""
    kind = SettingsPath("campaign", "thesis")
    words = f"Campaign file: {NAMES} thesis."
    return click.option("--campaign", cls=NeededOfShips, required=True, type=kind, help=words)(command)


def starboard_option(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the option ``--starboard``."""
    return click.option(
        "--starboard",
        metavar="VESSEL",
        help="Vessel file of the starboard line in the same recording; the other vessel is the line to port then, and "
        "the campaign is one of both shafts, such as at-once or in-turn.",
    )(command)


READING_SECTION = {
    "What the file does not say itself": (
        "--sample-rate", "--time-unit", "--columns", "--delimiter", "--decimal", "--encoding", "--dbc", "--interleaved",
    ),
}  # fmt: skip
"""The options of ``reading_options`` in the help of a command that has its options in sections."""


READING_BESIDE_CARD = {
    "What a recording does not say itself, beside --sample-rate": READING_SECTION["What the file does not say itself"][
        1:
    ],
}
"""The options of ``further_reading_options`` in the help of a command that has those of a card too."""


def reading_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the options that say what a file does not say itself: its rate, its columns, its letters, its messages."""
    rate = click.option("--sample-rate", type=float, help="Samples a second, where the file has no clock [Hz].")
    return rate(further_reading_options(command))


def further_reading_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the same without the rate, which a card has too."""
    time_unit = click.option(
        "--time-unit", metavar="UNIT", help="Unit of times whose file gives none: s, ms, us, ns, min, h or days."
    )
    columns = click.option(
        "--columns",
        metavar="NAME,...",
        help='Titles of a text file or MATLAB table without them, such as "time [s],u,y [rad/s]".',
    )
    delimiter = click.option("--delimiter", help="What stands between the columns of a text file.")
    decimal = click.option("--decimal", type=click.Choice([".", ","]), help="Decimal sign of a text file.")
    encoding = click.option("--encoding", help="Encoding of a text file that is not UTF-8, such as cp1252.")
    dbc = click.option(
        "--dbc", type=click.Path(path_type=Path), help="DBC or ARXML file: what frames of a CAN bus hold."
    )
    interleaved = click.option(
        "--interleaved", type=click.IntRange(min=2), help="Signals that each TDMS channel holds, sample by sample."
    )
    return time_unit(columns(delimiter(decimal(encoding(dbc(interleaved(command)))))))


def output_options(what: str) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Return what adds the options ``--output`` and ``--format`` of a recording.

    ``what``: what ``--output`` is, up to its endings.
    """
    endings = f"{', '.join(WRITTEN_ENDINGS[:-1])} or {WRITTEN_ENDINGS[-1]}"
    output = click.option("-o", "--output", required=True, type=click.Path(path_type=Path), help=f"{what}: {endings}.")
    chosen = click.option(
        "--format",
        "chosen_format",
        type=click.Choice(WRITTEN_FORMATS),
        help="Format, where the ending stands for several: tdms-appended, or nmea2000 in .blf, .asc or .log.",
    )

    def add(command: Callable[..., Any]) -> Callable[..., Any]:
        return output(chosen(command))

    return add


def cut_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the options ``--from`` and ``--to``."""
    begin = click.option("--from", "from_s", type=float, help="First second to keep, as counted by the recording [s].")
    end = click.option("--to", "to_s", type=float, help="Second before which to end [s]; times stay as they are.")
    return begin(end(command))


def hints_of(**said: object) -> dict[str, Any]:
    """Return what was said, under the names that readers know, without what was not."""
    names = {"sample_rate": "sample_rate_hz"}
    return {names.get(name, name): value for name, value in said.items() if value is not None}


def of_card_and_reading(said: Mapping[str, object]) -> tuple[dict[str, object], dict[str, object]]:
    """Return the options of a card among those that were given, and those of ``further_reading_options``."""
    names = [option.removeprefix("--").replace("-", "_") for option in next(iter(READING_BESIDE_CARD.values()))]
    return (
        {name: value for name, value in said.items() if name not in names},
        {name: value for name, value in said.items() if name in names},
    )


def reading_words(**said: object) -> tuple[object, ...]:
    """Return the options of ``reading_options`` as they are typed, without those that were not said."""
    given = ((f"--{name.replace('_', '-')}", value) for name, value in said.items() if value is not None)
    return tuple(word for name, value in given for word in (name, _typed(value)))


def _typed(value: object) -> object:
    """Return a value as it is typed: 2000 for the rate 2000.0."""
    return f"{value:.12g}" if isinstance(value, float) else value
