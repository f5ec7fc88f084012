"""Tables of results: data beside a page (``docs/results/*.tsv``), which the page shows.

What a benchmark writes stands between two marks of its page. Sentences and headings stay there; a table becomes a file
of tab separated values with the same cells, which the built page shows, and a long one is a link to its file. A hyphen
for no value becomes a dash: alone in a cell it is a list.
"""

import csv
import re
from collections.abc import Sequence
from pathlib import Path

FOLDER = "results"
LONGEST = 40
"""Rows of the longest table that is shown; a longer one is linked."""
_TABLE = re.compile(r"(?:^\|[^\n]*(?:\n|\Z))+", flags=re.MULTILINE)
_SHOWN = re.compile(
    r"^```\{csv-table\}\n:file: (\S+)\n(?::[^\n]*\n)*```$|^\[[^\]\n]*\]\((\S+\.tsv)\)$", flags=re.MULTILINE
)


def write_between_marks(path: Path, text: str, begin_mark: str, end_mark: str, *, beside: bool = True) -> None:
    """Replace what stands between the two marks of a document; ``beside``: tables go into files beside it.

    Raises
    ------
    ValueError
        If the document does not have both marks.
    """
    before, _, after = _around(path, begin_mark, end_mark)
    if beside:
        text = tables_beside(path, text, _name(begin_mark))
    path.write_text(f"{before}{begin_mark}\n{text.strip()}\n\n{end_mark}{after}", encoding="utf-8")


def read_between_marks(path: Path, begin_mark: str, end_mark: str) -> str:
    """Return what stands between the two marks of a document, tables as lines with bars.

    Raises
    ------
    ValueError
        If the document does not have both marks.
    """
    _, between, _ = _around(path, begin_mark, end_mark)
    return whole_text(path, between)


def tables_beside(page: Path, text: str, name: str) -> str:
    """Write each table of a text into a file beside a page, and return the text that shows them.

    Parameters
    ----------
    page
        The page on which the text stands.
    text
        Markdown with tables.
    name
        First part of the files' names; the second is the heading above the table, or its number.
    """
    folder = page.parent / FOLDER
    folder.mkdir(exist_ok=True)
    for old in folder.glob("*.tsv"):
        # an earlier run may have had more tables
        if re.fullmatch(rf"{re.escape(name)}(-\d+)?", old.stem):
            old.unlink()
    tables = list(_TABLE.finditer(text))
    for number, found in reversed(list(enumerate(tables, start=1))):
        rows = [_cells(line) for line in found.group().splitlines()]
        file = f"{name}-{number}.tsv" if len(tables) > 1 else f"{name}.tsv"
        write_rows(folder / file, [rows[0], *rows[2:]])
        place = f"{FOLDER}/{file}"
        shown = shown_table(place) if len(rows) - 2 <= LONGEST else f"[All {len(rows) - 2} rows]({place})"
        text = f"{text[: found.start()]}{shown}\n{text[found.end() :]}"
    return text


def whole_text(page: Path, text: str) -> str:
    """Return a text of a page with the tables that it shows as lines with bars."""
    return _SHOWN.sub(lambda found: bars(read_rows(page.parent / (found[1] or found[2]))), text)


def shown_table(place: str) -> str:
    """Return the block that shows a file, named from its page."""
    return f"```{{csv-table}}\n:file: {place}\n:delim: tab\n:header-rows: 1\n:widths: auto\n```"


def bars(rows: Sequence[Sequence[str]]) -> str:
    """Return rows, the first of headings, as lines with bars."""
    head, *others = (f"| {' | '.join(row)} |" for row in rows)
    return "\n".join([head, "|" + "---|" * len(rows[0]), *others])


def write_rows(path: Path, rows: Sequence[Sequence[str]]) -> None:
    """Write rows as tab separated values."""
    with path.open("w", encoding="utf-8", newline="") as file:
        csv.writer(file, delimiter="\t", lineterminator="\n").writerows(rows)


def read_rows(path: Path) -> list[list[str]]:
    """Return the rows of a file of tab separated values."""
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.reader(file, delimiter="\t"))


def _around(path: Path, begin_mark: str, end_mark: str) -> tuple[str, str, str]:
    whole = path.read_text(encoding="utf-8")
    before, begin, rest = whole.partition(begin_mark)
    between, end, after = rest.partition(end_mark)
    if not begin or not end:
        raise ValueError(f"{path}: expected the marks {begin_mark!r} and {end_mark!r}, found not both.")
    return before, between, after


def _cells(line: str) -> list[str]:
    cells = [cell.strip().replace("\\|", "|") for cell in re.split(r"(?<!\\)\|", line.strip())[1:-1]]
    return ["\u2013" if cell == "-" else cell for cell in cells]


def _name(mark: str) -> str:
    """Return the name of a mark for files: that of the benchmark or of what it is about."""
    words = re.sub(r"^<!-- |: begin -->\s*$|\bbenchmarks/|\.py\b|\btables? of ", "", mark)
    return re.sub(r"[^a-z0-9]+", "-", words.lower()).strip("-")
