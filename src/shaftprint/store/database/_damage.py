"""What is wrong with the rows of a store: SQLite's own check, references, and the seal of every row."""

from collections.abc import Collection, Iterator
from typing import Any

import sqlalchemy as sa

from shaftprint.errors import StoreError
from shaftprint.store._nouns import Fault
from shaftprint.store.database._database import Database
from shaftprint.store.database._seal import seal
from shaftprint.store.database._tables import EVENT, FINGERPRINT, LINE, QUANTITY, SHIP, TRIAL

_SEALED = (SHIP, LINE, EVENT, TRIAL, QUANTITY, FINGERPRINT)
_MOST = 100


def database_faults(database: Database) -> Iterator[Fault]:
    """Give what is wrong with the rows, but for documents and their numbers."""
    if database.is_file:
        yield from _guarded(_file_faults(database), "file")
    for table in _SEALED:
        yield from _guarded(_seal_faults(database, table), f"table {table.name}")


def _guarded(faults: Iterator[Fault], record: str) -> Iterator[Fault]:
    """Give faults; that a table cannot be read is one of them."""
    try:
        yield from faults
    except StoreError as error:
        yield Fault(record=record, found=str(error))


def _file_faults(database: Database) -> Iterator[Fault]:
    with database.unlocked() as raw:
        said = [str(row[0]) for row in raw.execute(f"PRAGMA integrity_check({_MOST})")]
        yield from (Fault(record="file", found=line) for line in said if line != "ok")
        for table, row, parent, _ in raw.execute("PRAGMA foreign_key_check").fetchmany(_MOST):
            yield Fault(record=f"{table} {row}", found=f"it refers to a {parent} that is not there")


def _seal_faults(database: Database, table: sa.Table) -> Iterator[Fault]:
    with database.reading() as connection:
        for row in connection.execution_options(yield_per=1000).execute(sa.select(table)):
            fault = _fault(table, dict(row._mapping))
            if fault is not None:
                yield Fault(record=f"{table.name} {row.id}", found=fault)


def line_faults(connection: sa.Connection, lines: Collection[int]) -> tuple[Fault, ...]:
    """Return which rows of some lines are not as they were written."""
    wanted = list(lines)
    ships = sa.select(LINE.c.ship_id).where(LINE.c.id.in_(wanted))
    trials = sa.select(TRIAL.c.id).where(TRIAL.c.line_id.in_(wanted))
    of_lines = {
        SHIP: SHIP.c.id.in_(ships),
        LINE: LINE.c.id.in_(wanted),
        EVENT: EVENT.c.line_id.in_(wanted),
        TRIAL: TRIAL.c.line_id.in_(wanted),
        FINGERPRINT: FINGERPRINT.c.trial_id.in_(trials),
    }
    found = []
    for table, condition in of_lines.items():
        for row in connection.execute(sa.select(table).where(condition)):
            fault = _fault(table, dict(row._mapping))
            if fault is not None:
                found.append(Fault(record=f"{table.name} {row.id}", found=fault))
    return tuple(found)


def _fault(table: sa.Table, row: dict[str, Any]) -> str | None:
    return None if seal(table, row) == row["seal"] else "it is not as it was written"
