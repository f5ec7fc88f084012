"""The option ``--drive`` and what the commands do with it: a drive file in place of vessel and campaign."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import click
from click.core import ParameterSource


def drive_option(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the option ``--drive``; where it is given, vessel and campaign are not needed."""
    return click.option(
        "--drive",
        "drive_file",
        type=click.Path(path_type=Path),
        is_eager=True,
        help="Drive file of a motor or another drive, in place of the files of a ship.",
    )(command)


def is_given(option: str) -> bool:
    """Return whether the user gave an option, or left it at its usual value."""
    source = click.get_current_context().get_parameter_source(option)
    return source not in (ParameterSource.DEFAULT, None)


def expect_not_given(*options: str) -> None:
    """Refuse options of ships beside ``--drive``.

    Raises click.UsageError if one of them was given.
    """
    given = [name for name in options if is_given(name)]
    if given:
        titles = {
            "legs": "leg",
            "records": "record",
            "names": "structure",
            "load_percent": "load-repeatability",
            "foreign": "model",
            "variables": "model-variable",
            "slope_rpm_per_v": "rpm-per-volt",
            "is_shortest": "shortest",
            "stairs": "staircase",
            "limits": "limit",
            "rehearsals": "rehearse",
            "offset_v": "offset",
            "freed": "free",
        }
        title = titles.get(given[0], given[0]).replace("_", "-")
        raise click.UsageError(f"--{title} is for ships; leave it out beside --drive.")


def only_recording(recordings: Sequence[Path]) -> Path:
    """Return the one recording of a ship.

    Raises click.UsageError if there are several.
    """
    if len(recordings) > 1:
        raise click.UsageError(
            f"expected one recording of a ship, found {len(recordings)}; files of one logger are put together by "
            "`shaftprint join`, those of several by `shaftprint merge`."
        )
    return recordings[0]
