"""Lines of a class as ``drift`` holds them against each other."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from shaftprint.choices import NEWEST_TESTS
from shaftprint.late import late
from shaftprint.store._line_history import LineHistory

with late():
    from shaftprint.drift._class_numbers import sister_of
    from shaftprint.drift._history import history_of

if TYPE_CHECKING:
    from shaftprint.drift._class_numbers import Sister


def sisters_of(
    lines: Sequence[LineHistory], *, newest: int | None = None
) -> tuple[tuple[Sister, ...], tuple[str, ...]]:
    """Return the lines that have a test that can be judged as sisters, and the names of those that have none.

    ``lines``: lines of one class; they are called by their ship, and by their position too where there are several.
    ``newest``: tests that stand for a ship, ``choices.NEWEST_TESTS`` by default.
    """
    several = len({one.line.position for one in lines}) > 1
    sisters, left_out = [], []
    for one in lines:
        name = f"{one.line.ship.name}, {one.line.position}" if several else one.line.ship.name
        history = history_of(one.fingerprints, one.events)
        if history.tests:
            sisters.append(sister_of(name, history, newest=newest or NEWEST_TESTS))
        else:
            left_out.append(name)
    return tuple(sisters), tuple(left_out)
