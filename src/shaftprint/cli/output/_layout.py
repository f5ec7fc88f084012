"""A table as lines of text: what does not fit a line goes into a block below, and no name or number is cut.

Numbers and names of parameters are never wrapped; text is, between words. The first column comes again in every block.
"""

import textwrap
from collections.abc import Sequence
from itertools import zip_longest

from shaftprint.digits import plain_letters
from shaftprint.escape import printable
from shaftprint.plain_table import Column, Symbol, Table

GAP = "   "
# Text in a column narrower than this is harder to read than in a block of its own.
NARROWEST_TEXT = 26
_TOGETHER = "\u00a0"


def table_lines(table: Table, width: int) -> list[str]:
    """Return the lines of a table without its title and note.

    ``width``: letters that a line may have; a name or number that is longer has a longer line.
    """
    columns = [_Cells(table, place) for place in range(len(table.columns))]
    blocks = _dealt(columns, width)
    lines: list[str] = []
    for block in blocks:
        lines += [*([""] if lines else []), *_block_lines(block, width)]
    return lines


class _Cells:
    """A column with its cells as they are printed."""

    def __init__(self, table: Table, place: int) -> None:
        column: Column = table.columns[place]
        cells = [row[place] for row in table.rows]
        self.is_number = column.number
        self.heading = _shown(column.heading)
        self.cells = [_shown(cell) for cell in cells]
        self.is_name = isinstance(column.heading, Symbol) or all(isinstance(cell, Symbol) for cell in cells)
        self.natural = max(map(len, (self.heading, *self.cells)))
        longest_word = max((len(word) for text in (self.heading, *self.cells) for word in text.split(" ")), default=0)
        longest_cell = max(map(len, self.cells), default=0)
        kept = longest_cell if self.is_number or self.is_name else 0
        self.narrowest = max(kept, longest_word)
        self.least = max(self.narrowest, min(longest_cell, NARROWEST_TEXT))

    def wrapped(self, text: str, width: int) -> list[str]:
        lines = textwrap.wrap(text, width, break_long_words=False, break_on_hyphens=False) or [""]
        lines = [line.replace(_TOGETHER, " ") for line in lines]
        return [line.rjust(width) if self.is_number else line.ljust(width) for line in lines]


def _shown(text: str) -> str:
    return printable(plain_letters(text)).replace(" +/- ", f"{_TOGETHER}+/-{_TOGETHER}")


def _dealt(columns: Sequence[_Cells], width: int) -> list[list[_Cells]]:
    """Return the columns in as few blocks as lines of this width can hold, each with the first column."""
    first, *others = columns
    blocks = [[first]]
    for column in others:
        if len(blocks[-1]) > 1 and _least_width([*blocks[-1], column]) > width:
            blocks.append([first])
        blocks[-1].append(column)
    return blocks


def _least_width(block: Sequence[_Cells]) -> int:
    return sum(column.least for column in block) + len(GAP) * (len(block) - 1) + 1


def _block_lines(block: Sequence[_Cells], width: int) -> list[str]:
    widths = _widths(block, width)
    heading = _row_lines([column.heading for column in block], block, widths)
    rule = " " + "─" * (sum(widths) + len(GAP) * (len(block) - 1))
    rows = [_row_lines(cells, block, widths) for cells in zip(*(column.cells for column in block), strict=True)]
    return [*heading, rule, *(line for row in rows for line in row)]


def _widths(block: Sequence[_Cells], width: int) -> list[int]:
    """Return what each column gets: its natural width where there is room, the widest texts giving way first."""
    widths = [column.natural for column in block]
    excess = sum(widths) + len(GAP) * (len(block) - 1) + 1 - width
    for floors in ([column.least for column in block], [column.narrowest for column in block]):
        while excess > 0 and widths != floors:
            above = [place for place, floor in enumerate(floors) if widths[place] > floor]
            widths[max(above, key=lambda place: widths[place])] -= 1
            excess -= 1
    return widths


def _row_lines(texts: Sequence[str], block: Sequence[_Cells], widths: Sequence[int]) -> list[str]:
    cells = [column.wrapped(text, size) for text, column, size in zip(texts, block, widths, strict=True)]
    blanks = [" " * size for size in widths]
    return [
        f" {GAP.join(blank if cell is None else cell for cell, blank in zip(line, blanks, strict=True))}".rstrip()
        for line in zip_longest(*cells)
    ]
