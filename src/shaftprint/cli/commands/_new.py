"""``shaftprint new``: a commented settings file to fill in."""

from collections.abc import Mapping
from pathlib import Path
from typing import Literal

import click

from shaftprint.card import write_vessel
from shaftprint.cli._card_options import card_of, card_options
from shaftprint.cli._terminal import answer
from shaftprint.cli._vessel_file import print_disagreements
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
@card_options
def command(kind: Literal["vessel", "campaign"], file: Path, test: str | None, **said: object) -> None:
    """Write a commented vessel or campaign file to fill in.

    FILE must not exist yet. It can be loaded as it stands; every key carries its unit in its name. The campaigns of
    --test are made for the Stan Tug 1205: predict says what they would ask of another ship.

    With what stands on a ship's card the vessel file is filled in. It needs --power-kw, --rated-rpm, --cylinders,
    --diameter-m, --blades, --pitch-ratio and --ratio or --propeller-rpm; the rest is derived or usual, and comments in
    the file say where each number is from and how uncertain it is.
    """
    card = card_of(said)
    if test is not None and kind != "campaign":
        raise click.UsageError("--test names a campaign to begin with; write `shaftprint new campaign`.")
    if card is not None and kind != "vessel":
        raise click.UsageError("A ship's card makes a vessel file; write `shaftprint new vessel`.")
    if card is not None:
        print_disagreements(write_vessel(card, file), str(file))
        answer(f"{file}: a vessel file from the card; its comments say what was derived and what is usual only.")
        return
    write_template(kind, file, shipped=test)
    answer(f"{file}: a {kind} to fill in." if test is None else f"{file}: {TESTS[test]}, for the Stan Tug 1205.")
