"""The lines of all ships of one class, each with its tests: what sister ships are compared by."""

from shaftprint.arguments import refusing_none
from shaftprint.errors import StoreError
from shaftprint.spelling import meant
from shaftprint.store._history import newest as newest_of_lines
from shaftprint.store._line_history import LineHistory, line_history
from shaftprint.store._store import Store


@refusing_none(StoreError)
def class_histories(
    store: Store, class_name: str, *, line: str | None = None, newest: int | None = None
) -> tuple[LineHistory, ...]:
    """Return every line of the ships of a class that has a test, by name of the ship and line.

    ``class_name``: what the ships have in common, as their fingerprints state it. ``line``: which of their lines; all
    when not given. ``newest``: as for ``line_history``. Raises StoreError if there is no such class, or none of its
    ships has such a line.
    """
    tested = [summary.line for summary in newest_of_lines(store) if summary.tests]
    known = sorted({one.ship.class_name for one in tested if one.ship.class_name is not None})
    of_class = [one for one in tested if one.ship.class_name == class_name]
    if not of_class:
        how = "state it with --class of store add or fleet run, or as class_name of [ship] in the vessel files"
        there = f" It has {', '.join(known[:12])}." if known else f" It has none yet: {how}."
        advice = meant(class_name, known) or there
        raise StoreError(f"{class_name}: expected a class of ships in the store, found none.{advice}")
    wanted = [one for one in of_class if line in (None, one.position)]
    if not wanted:
        positions = ", ".join(sorted({one.position for one in of_class}))
        raise StoreError(f"{class_name}: expected one of its lines, {positions}, found {line!r}.")
    wanted.sort(key=lambda one: (one.ship.name, one.position))
    return tuple(line_history(store, one.ship, line=one.position, newest=newest) for one in wanted)
