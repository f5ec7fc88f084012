"""How each line stands, in a few values: whether anything was added to it since somebody looked last."""

from collections.abc import Collection, Mapping

import sqlalchemy as sa

from shaftprint.store._nouns import Line, StoredFingerprint
from shaftprint.store.database._reader import Reader
from shaftprint.store.database._tables import EVENT, FINGERPRINT, LINE, SHIP, TRIAL


def line_states(connection: sa.Connection, lines: Collection[int] | None = None) -> dict[int, str]:
    """Return a word for each line that has tests or events, which changes with every fingerprint and event put in.

    ``connection``: a connection that reads. ``lines``: numbers of the lines that are wanted; all where none are given.
    """
    # rows are numbered in their order and never deleted: the last one and how many there are tell all
    tests = (
        sa.select(TRIAL.c.line_id, sa.func.max(FINGERPRINT.c.id), sa.func.count())
        .join(FINGERPRINT, FINGERPRINT.c.trial_id == TRIAL.c.id)
        .group_by(TRIAL.c.line_id)
    )
    events = sa.select(EVENT.c.line_id, sa.func.max(EVENT.c.id), sa.func.count()).group_by(EVENT.c.line_id)
    if lines is not None:
        tests = tests.where(TRIAL.c.line_id.in_(lines))
        events = events.where(EVENT.c.line_id.in_(lines))
    found: dict[int, list[str]] = {}
    for query in (tests, events):
        for line, last, count in connection.execute(query).all():
            found.setdefault(line, []).append(f"{last}-{count}")
    return {line: "/".join(parts) for line, parts in found.items()}


def store_state(connection: sa.Connection) -> str:
    """Return a word that changes with every fingerprint and event that is put in; it looks at the ends of indices only.

    A ship gets another name with a fingerprint only.
    """
    tables = (FINGERPRINT, EVENT, LINE, SHIP)
    return "/".join(str(connection.execute(sa.select(sa.func.max(one.c.id))).scalar() or 0) for one in tables)


def fingerprint_called(reader: Reader, sha256: str) -> StoredFingerprint | None:
    """Return a fingerprint by the SHA-256 of its document; None where there is none."""
    query = (
        sa.select(LINE.c.id, LINE.c.ship_id)
        .join(TRIAL, TRIAL.c.line_id == LINE.c.id)
        .join(FINGERPRINT, FINGERPRINT.c.trial_id == TRIAL.c.id)
        .where(FINGERPRINT.c.sha256 == sha256)
    )
    row = reader.connection.execute(query).first()
    if row is None:
        return None
    ships = [one for one in reader.ships() if one.id == row.ship_id]
    lines: Mapping[int, Line] = {key: line for key, line in reader.lines(ships).items() if key == row.id}
    found = reader.fingerprints(lines, superseded=True).values()
    return next((one for one in found if one.sha256 == sha256), None)
