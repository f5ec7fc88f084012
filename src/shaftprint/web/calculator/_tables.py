"""Tables as JSON: what a page and a program are given alike."""

from collections.abc import Iterable
from typing import Any

from shaftprint.plain_table import Symbol, Table


def table_content(table: Table) -> dict[str, Any]:
    """Return a table for JSON."""
    return {
        "title": table.title,
        "columns": [
            {"heading": one.heading, "number": one.number, "symbol": isinstance(one.heading, Symbol)}
            for one in table.columns
        ],
        "rows": [list(row) for row in table.rows],
        "symbols": [isinstance(row[0], Symbol) for row in table.rows],
        "note": table.note,
    }


def table_contents(tables: Iterable[Table]) -> list[dict[str, Any]]:
    """Return tables for JSON; those without a row are left out."""
    return [table_content(one) for one in tables if one.rows]
