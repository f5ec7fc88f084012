"""Tables of a page as files: what stands in them is read from the page itself, so that a file says what it says."""

import csv
import io
from collections.abc import Sequence
from html.parser import HTMLParser
from typing import Final

from starlette.exceptions import HTTPException
from starlette.responses import Response

from shaftprint.escape import csv_cell, plain_name
from shaftprint.plain_table import Column, Table
from shaftprint.tables._workbook import Sheet, sheet_of, shown, write_workbook

XLSX: Final = "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet"
_CELLS: Final = frozenset({"th", "td"})


def tables_in(page: str) -> list[Table]:
    """Return the tables of a page, without columns in which nothing is written."""
    reader = _Tables()
    reader.feed(page)
    return reader.tables


def file_of_tables(page: str, *, kind: str, number: str, name: str) -> Response:
    """Return one table of a page as CSV, or all of them as sheets of a workbook.

    ``page``: the page. ``kind``: ``csv`` or ``xlsx``. ``number``: which table, from 1 on. ``name``: what the file is
    called, without its ending. Raises HTTPException if there is no such table; ServerError without the package.
    """
    tables = [sheet_of(one) for one in tables_in(page)]
    at = int(number) if number.isascii() and number.isdecimal() and len(number) < 4 else 0
    if kind not in ("csv", "xlsx") or not tables or (kind == "csv" and not 0 < at <= len(tables)):
        raise HTTPException(404)
    content, media = (_csv(tables[at - 1]), "text/csv; charset=utf-8") if kind == "csv" else (_xlsx(tables), XLSX)
    title = plain_name(f"{name} {tables[at - 1].title}" if kind == "csv" else name)[:80]
    plain = "".join(one if one.isascii() and (one.isalnum() or one in "-._") else "-" for one in title)
    heads = {"content-disposition": f'attachment; filename="{plain.strip("-.") or "table"}.{kind}"'}
    return Response(content, media_type=media, headers=heads)


def _xlsx(tables: Sequence[Sheet]) -> bytes:
    content = io.BytesIO()
    write_workbook(content, tables)
    return content.getvalue()


def _csv(table: Sheet) -> bytes:
    text = io.StringIO()
    lines = csv.writer(text)
    for row in ([one.heading for one in table.columns], *table.rows):
        lines.writerow([csv_cell(cell) if isinstance(cell, str) else shown(cell) for cell in row])
    # a spreadsheet takes a file for UTF-8 by this mark
    return text.getvalue().encode("utf-8-sig")


class _Tables(HTMLParser):
    """Reads tables: the caption, the headings, and the text of every cell."""

    def __init__(self) -> None:
        super().__init__()
        self.tables: list[Table] = []
        self._caption = ""
        self._rows: list[list[str]] = []
        self._numbers: set[int] = set()
        self._in_caption = self._in_table = False

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Begin a table, a row or a cell."""
        if tag == "table":
            self._caption, self._rows, self._numbers, self._in_table = "", [], set(), True
        elif tag == "caption":
            self._in_caption = True
        elif self._in_table and tag == "tr":
            self._rows.append([])
        elif self._in_table and tag in _CELLS and self._rows:
            self._rows[-1].append("")
            if dict(attrs).get("class") == "number":
                self._numbers.add(len(self._rows[-1]) - 1)
        elif tag == "br":
            self.handle_data(" ")
        elif tag == "sub":
            self.handle_data("_")

    def handle_endtag(self, tag: str) -> None:
        """End a caption or a table."""
        if tag == "caption":
            self._in_caption = False
        elif tag == "table" and self._in_table:
            self._in_table = False
            self._keep()

    def handle_data(self, data: str) -> None:
        """Take the text of a caption or a cell."""
        if self._in_caption:
            self._caption += data
        elif self._in_table and self._rows and self._rows[-1]:
            self._rows[-1][-1] += data

    def _keep(self) -> None:
        rows = [[" ".join(cell.split()) for cell in row] for row in self._rows]
        wide = len(rows[0]) if rows else 0
        body = [row for row in rows[1:] if len(row) == wide]
        # one without rows counts too: the links of the page have numbers
        said = [at for at in range(wide) if any(row[at] for row in body)] or range(wide)
        columns = tuple(Column(rows[0][at], number=at in self._numbers) for at in said)
        cells = tuple(tuple(row[at] for at in said) for row in body)
        self.tables.append(Table(title=" ".join(self._caption.split()), columns=columns, rows=cells))
