"""How near a test comes to the limits of ship and engine, as a table and in sentences."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from shaftprint.digits import plain
from shaftprint.plain_table import Table, numbers, texts

if TYPE_CHECKING:
    from shaftprint.design.operation._limit_use import LimitUse


def limit_use_table(uses: Sequence["LimitUse"], *, note: str) -> Table:
    """Return for each limit the instant that comes nearest to it, or leaves it furthest.

    ``uses``: from ``limit_uses``: for each limit the worst excitation comes first. ``note``: what the numbers are, such
    as a prediction without noise.
    """
    worst = {use.limit: use for use in reversed(uses)}
    rows = tuple(
        (
            use.limit,
            plain(use.value, 0),
            plain(use.allowed, 0),
            use.unit,
            use.excitation,
            f"{use.time_s:.1f}",
            f"{use.beyond_s:.1f}" if use.is_beyond else "",
        )
        for use in reversed(worst.values())
    )
    columns = (
        *texts("limit"),
        *numbers("reached", "allowed"),
        *texts("unit", "excitation"),
        *numbers("at [s]", "beyond [s]"),
    )
    return Table(title="Limits of ship and engine", columns=columns, rows=rows, note=note)


def limit_use_sentences(uses: Sequence["LimitUse"]) -> list[str]:
    """Return a sentence for each excitation and limit that it leaves."""
    return [use.sentence for use in uses if use.is_beyond]
