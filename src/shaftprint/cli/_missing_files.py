"""What is missing of a command, all at once, and what of it lies in the folder; files that were given for another."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from shaftprint.late import late

if TYPE_CHECKING:
    from shaftprint.cli._lying_files import LyingFiles

with late():
    from shaftprint.cli import _lying_files
    from shaftprint.file_kinds import kind_of_file
    from shaftprint.spelling import listed

_KINDS = {"vessel": "vessels", "campaign": "campaigns"}
_RECORDINGS = ("recording", "recordings")
"""Names of the arguments that are recordings."""


def missing_words(command: click.Command, ctx: click.Context, typed: list[str]) -> str:
    """Return all that a command lacks, and the files of the folder that would do; empty where it is one thing only."""
    given, _, _ = command.make_parser(ctx).parse_args(list(typed))
    missing = [one for one in command.get_params(ctx) if one.required and _is_lacking(given.get(one.name or ""))]
    if len(missing) < 2 or "drive_file" in given:
        return ""
    lying = _lying_files.lying_files(Path())
    there = {one.name: path for one in missing if (path := _lies_there(one, lying)) is not None}
    names = [_name(one) for one in missing]
    words = f"Missing: {listed(names)}."
    if there:
        words += f" Here lie {', '.join(f'{path} ({_noun(name)})' for name, path in there.items())}."
    return f"{words} `shaftprint start` says what comes next." if there else words


def swapped_words(command: click.Command, ctx: click.Context) -> str:
    """Return that a settings file stands where the recording belongs, and the other way round; empty where not so."""
    recordings = _paths(ctx.params)
    for name in _KINDS:
        settings = ctx.params.get(name)
        other = Path(settings) if isinstance(settings, str) else None
        if other is None or not other.is_file() or kind_of_file(other) is not None:
            continue
        swapped = next((one for one in recordings if one.is_file() and kind_of_file(one) == name), None)
        if swapped is not None:
            return (
                f"{swapped} is a {name} file and {other} is none: they are swapped. The recording comes first, and "
                f"--{name} names the {name} file."
            )
    return ""


def _paths(params: Mapping[str, Any]) -> tuple[Path, ...]:
    given = next((params[name] for name in _RECORDINGS if params.get(name) is not None), ())
    return (given,) if isinstance(given, Path) else tuple(one for one in given if isinstance(one, Path))


def _is_lacking(value: Any) -> bool:
    # what was not typed is nothing, or a mark of click's own
    return not (isinstance(value, str | tuple | list) and value)


def _lies_there(parameter: click.Parameter, lying: LyingFiles) -> Path | None:
    """Return the newest file of the folder that a parameter could be."""
    name = parameter.name or ""
    kind = "recordings" if name in _RECORDINGS else _KINDS.get(name, "")
    paths: tuple[Path, ...] = getattr(lying, kind) if kind else ()
    return paths[-1] if paths else None


def _noun(name: str | None) -> str:
    return "recording" if name in _RECORDINGS else f"{name} file"


def _name(parameter: click.Parameter) -> str:
    """Return a parameter as it is typed."""
    if isinstance(parameter, click.Option):
        return max(parameter.opts, key=len)
    return (parameter.metavar or parameter.name or "").upper().rstrip(".")
