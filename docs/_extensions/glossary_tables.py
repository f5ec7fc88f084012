"""Tables of the glossary that come from the code: symbols of the catalogue, and quantities of each room."""

import importlib
import pkgutil
import re
from collections import defaultdict
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import shaftprint
from shaftprint.catalogue import STRUCTURES, structure

if TYPE_CHECKING:
    from sphinx.application import Sphinx

PAGE = "glossary"
RULE = re.compile(r"^=+(?: +=+)+$")


def table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table in Markdown; a bar within a cell is no end of it."""
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |" for row in lines)


def code(text: str) -> str:
    """Return a symbol or unit as code; a dash, which stands for no unit, as it is."""
    return text if text == "-" else f"`{text}`"


def symbol_rows() -> list[tuple[str, ...]]:
    """Return symbol, meaning, unit, physical form and structures of all parameters and combinations, by symbol."""
    used = defaultdict(list)
    for name in STRUCTURES:
        shipped = structure(name)
        for item in (*shipped.parameters, *shipped.combinations):
            form = None if item.role is None else item.role.physical
            physical = "" if form is None else f"{form.name} [{form.unit}]"
            used[item.name, item.unit, item.meaning, physical].append(name)
    ordered = sorted(used.items(), key=lambda entry: (" " in entry[0][0], entry[0][0].lower(), entry[0]))
    return [
        (code(symbol), meaning, code(unit), physical, ", ".join(names))
        for (symbol, unit, meaning, physical), names in ordered
    ]


def quantity_rows() -> list[tuple[str, ...]]:
    """Return quantity, meaning, unit and room of every table of quantities at the door of a room."""
    rows = []
    for room in sorted(module.name for module in pkgutil.iter_modules(shaftprint.__path__) if module.ispkg):
        lines = (importlib.import_module(f"shaftprint.{room}").__doc__ or "").splitlines()
        rows += [(quantity, meaning, unit, room) for quantity, unit, meaning in _cells(lines)]
    return rows


def _cells(lines: list[str]) -> list[list[str]]:
    """Return the rows of a docstring's first table if it is one of quantities; a row may go on below itself."""
    rules = [number for number, line in enumerate(lines) if RULE.match(line)]
    if len(rules) < 3 or not lines[rules[0] + 1].startswith("quantity"):
        return []
    starts = [match.start() for match in re.finditer(r"=+", lines[rules[0]])]
    ends = [*starts[1:], None]
    rows: list[list[str]] = []
    for line in lines[rules[1] + 1 : rules[2]]:
        cells = [line[start:end].strip() for start, end in zip(starts, ends, strict=True)]
        if cells[0]:
            rows.append(cells)
        else:
            rows[-1] = [f"{before} {more}".strip() for before, more in zip(rows[-1], cells, strict=True)]
    return rows


TABLES = {
    "symbols": lambda: table(("symbol", "meaning", "unit", "in the units of the ship", "structures"), symbol_rows()),
    "quantities": lambda: table(("quantity", "meaning and sign", "unit", "room"), quantity_rows()),
}


def fill(app: "Sphinx", page: str, source: list[str]) -> None:
    """Put each table where the page names it."""
    if page == PAGE:
        source[0] = re.sub(r"<!-- table: (\w+) -->", lambda match: TABLES[match[1]](), source[0])


def setup(app: "Sphinx") -> dict[str, bool]:
    """Fill the page before it is read."""
    app.connect("source-read", fill)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
