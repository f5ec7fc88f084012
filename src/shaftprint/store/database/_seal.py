"""The seal of a row: the SHA-256 of its content, by which a changed letter is found."""

import hashlib
import json
from collections.abc import Mapping
from datetime import datetime
from typing import Any

import sqlalchemy as sa

from shaftprint.store._stated import utc_iso


def seal(table: sa.Table, row: Mapping[str, Any]) -> str:
    """Return the seal of a row of a table."""
    content = [table.name, *(_plain(row[column.name]) for column in table.columns if column.name != "seal")]
    return hashlib.sha256(json.dumps(content).encode()).hexdigest()


def sealed(table: sa.Table, row: Mapping[str, Any]) -> dict[str, Any]:
    """Return a row with its seal."""
    return {**row, "seal": seal(table, row)}


def _plain(value: Any) -> Any:
    if isinstance(value, datetime):
        return utc_iso(value)
    return value if isinstance(value, str | int | float | None) else repr(value)
