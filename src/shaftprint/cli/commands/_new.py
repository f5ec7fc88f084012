"""``shaftprint new``: a commented settings file to fill in."""

from collections.abc import Mapping
from pathlib import Path
from typing import Literal

import click

from shaftprint.cli._terminal import answer
from shaftprint.settings import write_template

TESTS: Mapping[str, str] = {
    "12min": "12 minutes, two speeds",
    "5min": "5 minutes, two speeds",
    "short": "14 minutes of sines",
    "thesis": "the thesis' 3.2 hours",
}
"""Shipped campaigns to begin with, and what they are."""


@click.command("new")
@click.argument("kind", type=click.Choice(["vessel", "campaign"]))
@click.argument("file", type=click.Path(path_type=Path))
@click.option(
    "--test",
    type=click.Choice([*TESTS]),
    help=f"A campaign to begin with: {'; '.join(f'{name}, {words}' for name, words in TESTS.items())}.",
)
def command(kind: Literal["vessel", "campaign"], file: Path, test: str | None) -> None:
    """Write a commented vessel or campaign file to fill in.

    FILE must not exist yet. It can be loaded as it stands; every key carries its unit in its name. The campaigns of
    --test are made for the Stan Tug 1205: predict says what they would ask of another ship.
    """
    if test is not None and kind != "campaign":
        raise click.UsageError("--test names a campaign to begin with; write `shaftprint new campaign`.")
    write_template(kind, file, shipped=test)
    answer(f"{file}: a {kind} to fill in." if test is None else f"{file}: {TESTS[test]}, for the Stan Tug 1205.")
