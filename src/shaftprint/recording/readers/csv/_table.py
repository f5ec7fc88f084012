"""Where in a text file the rows of numbers stand, and what separates their columns."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from shaftprint.recording.readers.csv._fields import DELIMITERS, GAP, TAB, TEXT, WHITE_SPACE, kinds_of, split_row

# Words in a row speak against a delimiter: a decimal comma taken for one leaves some.
_WORDS = 0.5
# Only so many rows tell the kind of a column.
_ROWS = 400


@dataclass(frozen=True, kw_only=True, slots=True)
class Table:
    """The rows of numbers of a text file, as its first lines show them."""

    delimiter: str
    """What stands between two columns; a space for white space of any length."""
    first: int
    """Place of the first row among the lines."""
    width: int
    """Number of fields of a row, empty ones at its end counted."""
    kinds: str
    """What each column holds, a letter each."""
    rows: tuple[tuple[str, ...], ...]
    """Fields of the first rows."""


def find_table(lines: Sequence[str], *, delimiter: str | None = None, width: int = 0) -> Table | None:
    """Return the largest table among some lines; nothing where there is none.

    A table is rows below each other of the same number of fields, of which those of a column are of one kind: numbers,
    dates or words, each with gaps. At least one column is of numbers.

    ``lines``: first lines of the file. ``delimiter``: what stands between columns, where the caller knows it.
    ``width``: how many columns there are, where the caller knows it; two or more else.
    """
    best: tuple[float, Table] | None = None
    for candidate in (delimiter,) if delimiter else DELIMITERS:
        sized = _table(lines, candidate, width)
        if sized is not None and (best is None or sized[0] > best[0]) and not _splits_dates(best, sized[1]):
            best = sized
    return None if best is None else best[1]


def _splits_dates(best: tuple[float, Table] | None, table: Table) -> bool:
    """Return whether white space has more columns than tabs only because it stands in dates."""
    tabs = None if best is None or best[1].delimiter != TAB else best[1]
    return (
        tabs is not None
        and table.delimiter == WHITE_SPACE
        and TEXT not in tabs.kinds
        and len(tabs.rows) >= len(table.rows)
    )


@dataclass(slots=True)
class _Run:
    """Rows that fit below each other."""

    places: list[int]
    """Their places among the lines."""
    kinds: str
    """What their columns hold together."""


def _table(lines: Sequence[str], delimiter: str, width: int) -> tuple[float, Table] | None:
    """Return the largest table with a delimiter, and how large it is."""
    runs = [run for run in _runs(lines, delimiter, width) if not width or len(run.kinds) == width]
    # rows that are apart by a damaged one, or by titles that come again, are of one table
    tables = [[other for other in runs if _are_alike(run, other)] for run in runs]
    sizes = [sum(len(run.places) * _worth(run.kinds) for run in table) for table in tables]
    size = max(sizes, default=0.0)
    if size <= 0.0:
        return None
    of_table = _below_the_titles(lines, delimiter, tables[sizes.index(size)])
    count = len(of_table[0].kinds)
    places = [place for run in of_table for place in run.places]
    fields = [split_row(lines[place], delimiter) for place in places[:_ROWS]]
    rows = tuple(tuple((row + [""] * count)[:count]) for row in fields)
    return size, Table(
        delimiter=delimiter,
        first=_with_damaged_rows_above(lines, delimiter, places[0], of_table[0].kinds),
        width=count,
        kinds="".join(map(_kind_of, zip(*rows, strict=True))),
        rows=rows,
    )


def _below_the_titles(lines: Sequence[str], delimiter: str, runs: list[_Run]) -> list[_Run]:
    """Return the runs of a table without a row of numbers above its titles, as of channels' numbers."""
    first = runs[0].places
    if len(runs) == 1 or len(first) > 1:
        return runs
    between = (kinds_of(split_row(line, delimiter)) for line in lines[first[0] + 1 : runs[1].places[0]])
    are_titles = any(
        len(kinds) == len(runs[0].kinds) and not set(kinds) - {GAP, TEXT} and TEXT in kinds for kinds in between
    )
    return runs[1:] if are_titles else runs


def _are_alike(one: _Run, other: _Run) -> bool:
    return len(one.kinds) == len(other.kinds) and _fitting(one.kinds, other.kinds) is not None


def _worth(kinds: str) -> float:
    words = kinds.count(TEXT)
    return len(kinds) - kinds.count(GAP) - words - _WORDS * words


def _runs(lines: Sequence[str], delimiter: str, width: int) -> list[_Run]:
    """Return rows that fit below each other: at least two, or one without words."""
    runs: list[_Run] = []
    current: _Run | None = None
    for place, line in enumerate(lines):
        if not line.strip(" \t\r\n\0"):
            continue
        kinds = kinds_of(split_row(line, delimiter))
        if (len(kinds) < 2 and width != 1) or not set(kinds) - {GAP, TEXT}:
            current = None
            continue
        both = None if current is None else _fitting(current.kinds, kinds)
        if current is not None and both is not None:
            current.places.append(place)
            current.kinds = both
        else:
            current = _Run([place], kinds)
            runs.append(current)
    return [run for run in runs if len(run.places) > 1 or TEXT not in run.kinds]


def _fitting(above: str, below: str) -> str | None:
    """Return what the columns of two rows hold together; nothing where a column of numbers would hold words.

    A row may be shorter by gaps or words: remarks at its end.
    """
    size = max(len(above), len(below))
    both = []
    for one, other in zip(above.ljust(size, GAP), below.ljust(size, GAP), strict=True):
        if one != other and GAP not in (one, other):
            return None
        both.append(other if one == GAP else one)
    if set(both[min(len(above), len(below)) :]) - {GAP, TEXT}:
        return None
    has_common = any(one == other not in (GAP, TEXT) for one, other in zip(above, below, strict=False))
    return "".join(both) if has_common else None


def _with_damaged_rows_above(lines: Sequence[str], delimiter: str, first: int, kinds: str) -> int:
    """Return the place of the first row, with those above it that begin as rows do but are damaged."""
    lead = next(column for column, kind in enumerate(kinds) if kind not in (GAP, TEXT))
    while first > 0:
        above = kinds_of(split_row(lines[first - 1], delimiter))
        if len(above) <= lead or above[lead] != kinds[lead] or TEXT in above[:lead]:
            return first
        first -= 1
    return first


def _kind_of(column: Sequence[str]) -> str:
    """Return the kind of most fields of a column that are no gaps; a gap where all are."""
    counts = Counter(kinds_of(column))
    del counts[GAP]
    return counts.most_common(1)[0][0] if counts else GAP
