"""``shaftprint store add``: fingerprints into the store."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from datetime import UTC, datetime, tzinfo
from pathlib import Path

import click

from shaftprint.cli._dates import zone_option
from shaftprint.cli._store_options import moment_option, opened_store, store_option
from shaftprint.cli._terminal import answer
from shaftprint.cli.output._fingerprint_file import any_fingerprint_at, fingerprint_file
from shaftprint.cli.output._json import give
from shaftprint.errors import StoreError
from shaftprint.late import late
from shaftprint.spelling import listed

with late():
    from shaftprint.fingerprint._design import differences_of_design
    from shaftprint.store._add import add, refusals
    from shaftprint.store._line_history import line_history
    from shaftprint.store._nouns import Added
    from shaftprint.store._stated import Stated
    from shaftprint.store._store import Store


SHOWN_HASH = 12
# So many of the newest tests of a line are looked at.
FEWEST = 2


@click.command("add")
@click.argument("results", nargs=-1, required=True, type=click.Path(path_type=Path), metavar="RESULT...")
@store_option
@click.option("--ship", metavar="NAME", help="Name of the ship, where the fingerprint does not say it.")
@click.option(
    "--imo", type=int, metavar="NUMBER", help="IMO number of the ship, where the fingerprint does not say it."
)
@click.option("--line", metavar="NAME", help="Shaft line, such as port, where the fingerprint does not say it.")
@click.option("--class", "class_name", metavar="NAME", help="What sister ships have in common, as `sisters` takes it.")
@moment_option("--tested-at", "When the recording began, where the fingerprint does not say it.")
@zone_option("Zone of a time without an offset, such as Europe/Amsterdam.")
def command(
    results: tuple[Path, ...],
    url: str,
    *,
    ship: str | None,
    imo: int | None,
    line: str | None,
    class_name: str | None,
    tested_at: datetime | None,
    zone: tzinfo | None,
) -> None:
    """Put fingerprints into the store.

    RESULT is a fingerprint's JSON file, or the folder in which identify or demo has put it. Ship, line and time of the
    test come from it; what it does not say is stated by the options. Another fingerprint of the same recording takes
    the place of the earlier one, which stays: history --all shows it.
    """
    if tested_at is not None and len(results) > 1:
        raise click.UsageError(f"--tested-at: expected one RESULT, found {len(results)}; each test has its own time.")
    stated = Stated(ship=ship, imo_number=imo, line=line, tested_at=tested_at, class_name=class_name)
    outcomes = []
    with _opened(url, [fingerprint_file(place) for place in results], stated, zone) as store:
        for place in results:
            if place.is_dir():
                # a folder whose page shows another fingerprint is refused
                any_fingerprint_at(place)
            added = add(store, fingerprint_file(place), now=datetime.now(UTC), stated=stated, zone=zone)
            outcomes.append(added)
            answer(f"{place}: {_in_words(added)}{_of_another_design(store, added, place)}")
    give("added", outcomes)


@contextmanager
def _opened(url: str, files: list[Path], stated: Stated, zone: tzinfo | None) -> Iterator[Store]:
    """Open the store; where that fails, say at once what the fingerprints lack too."""
    with ExitStack() as stack:
        try:
            store = stack.enter_context(opened_store(url))
        except StoreError as refusal:
            others = refusals(files, now=datetime.now(UTC), stated=stated, zone=zone)
            raise StoreError(" ".join([str(refusal), *others])) from None
        yield store


def _of_another_design(store: Store, added: Added, place: Path) -> str:
    """Return that a fingerprint is of another ship than the other tests of its line, in words; empty where it is not.

    A ship may have got another engine: it is kept, and said.
    """
    kept = any_fingerprint_at(place)
    history = line_history(store, added.line.ship, line=added.line.position, newest=FEWEST)
    for other in history.fingerprints.values():
        if designs := differences_of_design(other.stated_fields, kept.stated_fields):
            return (
                f" But it is of {kept.title}, and other tests of this line are of another ship, {other.title}: "
                f"{listed([one.both for one in designs])}. Put it into the store with its own --ship, unless that was "
                "rebuilt."
            )
    return ""


def _in_words(added: Added) -> str:
    name, line = f"fingerprint {added.sha256[:SHOWN_HASH]}", f"{added.line.ship.name}, {added.line.position}"
    other = "" if added.other is None else added.other[:SHOWN_HASH]
    match added.outcome:
        case "known":
            return f"{name} of {line} is in the store already; it is not kept twice."
        case "supersedes":
            return f"{name} of {line} takes the place of {other}, which is of the same recording and is kept."
        case "superseded":
            return f"{name} of {line} is kept; {other}, made later of the same recording, stays in its place."
        case "added":
            return f"{name} of {line} is kept."
