"""How a command speaks: the options ``--json``, ``--xlsx``, ``--verbose`` and ``--quiet``, which every command has."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from pathlib import Path
from typing import Any

import click

from shaftprint.cli._terminal import Document, output
from shaftprint.errors import RequestError
from shaftprint.late import late

with late():
    from shaftprint.cli.output._workbook import workbook_at


def _as_json(context: click.Context, parameter: click.Parameter, chosen: bool) -> None:
    if chosen:
        output().document = Document(command=context.info_name or "")


def _verbose(context: click.Context, parameter: click.Parameter, chosen: bool) -> None:
    output().verbose = chosen


def _quiet(context: click.Context, parameter: click.Parameter, chosen: bool) -> None:
    output().quiet = chosen


def _as_workbook(context: click.Context, parameter: click.Parameter, chosen: Path | None) -> None:
    if chosen is not None:
        output().workbook = workbook_at(chosen)


def _options() -> list[click.Option]:
    return [
        click.Option(
            ["--json", "as_json"],
            is_flag=True,
            expose_value=False,
            callback=_as_json,
            help="Print answer, findings, tables and numbers with all digits as one JSON object.",
        ),
        click.Option(
            ["--xlsx"],
            type=click.Path(path_type=Path),
            metavar="FILE",
            expose_value=False,
            callback=_as_workbook,
            help="Write tables, and numbers with all digits, into a workbook too, those of the details as well.",
        ),
        click.Option(
            ["-v", "--verbose"],
            is_flag=True,
            expose_value=False,
            callback=_verbose,
            help="Print details too, and name each step of long work with its time on the error output.",
        ),
        click.Option(
            ["-q", "--quiet"],
            is_flag=True,
            expose_value=False,
            callback=_quiet,
            help="Print only the answer, and no progress.",
        ),
    ]


def speaking(command: click.Command) -> click.Command:
    """Return a command with the options that say how it speaks, which says how it is called when asked wrongly."""
    if not any(parameter.name == "as_json" for parameter in command.params):
        command.params += _options()
        command.callback = _saying_how_it_is_called(command.callback)
    return command


def _saying_how_it_is_called(callback: Callable[..., Any] | None) -> Callable[..., Any]:
    assert callback is not None  # noqa: S101 - every command does something

    @wraps(callback)
    def called(*args: Any, **kwargs: Any) -> Any:
        try:
            return callback(*args, **kwargs)
        except RequestError as error:
            raise click.UsageError(str(error)) from error

    return called
