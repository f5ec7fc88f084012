"""The tables, as the newest migration leaves them; a test holds both against each other.

Numbers stand in a narrow table whose primary key is fingerprint and quantity, and the newest is found by a query: a
table of newest ones would be written by all. Every row but those numbers, which are held against their document,
carries the SHA-256 of its own content; those of jobs, which change while they are worked on, do not.
"""

from datetime import datetime
from typing import Any, Final

import sqlalchemy as sa

from shaftprint.errors import StoreError
from shaftprint.store._stated import utc_iso

HEAD: Final = "0002"
"""Name of the newest schema, which this version of the program reads and writes."""
VERSION_TABLE: Final = "shaftprint_schema"
"""Where a database says which schema it has: a name that no other program has."""
METADATA: Final = sa.MetaData()
"""All tables."""


class Utc(sa.types.TypeDecorator[datetime]):
    """An instant: with its zone in PostgreSQL, as text of one length in UTC in SQLite."""

    impl = sa.String(27)
    cache_ok = True

    def load_dialect_impl(self, dialect: sa.Dialect) -> sa.types.TypeEngine[Any]:
        """Return the type of the column."""
        is_text = dialect.name == "sqlite"
        return dialect.type_descriptor(sa.String(27) if is_text else sa.DateTime(timezone=True))

    def process_bind_param(self, value: datetime | None, dialect: sa.Dialect) -> Any:
        """Return an instant as it is kept."""
        return utc_iso(value) if value is not None and dialect.name == "sqlite" else value

    def process_result_value(self, value: Any, dialect: sa.Dialect) -> datetime | None:
        """Return an instant from what is kept.

        Raises StoreError if it is none.
        """
        if value is None or (isinstance(value, datetime) and value.tzinfo is not None):
            return value
        try:
            instant = datetime.fromisoformat(value)
        except (TypeError, ValueError):
            instant = None
        if instant is None or instant.tzinfo is None:
            raise StoreError(
                f"expected a time, found {str(value)[:40]!r}; the store is damaged: shaftprint store check."
            )
        return instant


def _id() -> sa.Column[int]:
    return sa.Column("id", sa.BigInteger().with_variant(sa.Integer, "sqlite"), primary_key=True, autoincrement=False)


def _of(name: str, *, nullable: bool = False) -> sa.Column[int]:
    column_type = sa.BigInteger().with_variant(sa.Integer, "sqlite")
    target = name.removesuffix("_id") if name.endswith("_id") else "fingerprint"
    return sa.Column(name, column_type, sa.ForeignKey(f"{target}.id"), nullable=nullable)


def _text(name: str, *, nullable: bool = False) -> sa.Column[str]:
    return sa.Column(name, sa.Text, nullable=nullable)


def _number(name: str) -> sa.Column[float]:
    return sa.Column(name, sa.Double, nullable=True)


def _time(name: str, *, nullable: bool = False) -> sa.Column[datetime]:
    return sa.Column(name, Utc, nullable=nullable)


SHIP: Final = sa.Table(
    "ship",
    METADATA,
    _id(),
    sa.Column("imo", sa.Integer, unique=True, nullable=True),
    _text("name"),
    _text("class_of", nullable=True),
    _text("seal"),
)
sa.Index("ship_name", SHIP.c.name)
sa.Index(
    "ship_without_imo",
    SHIP.c.name,
    unique=True,
    sqlite_where=SHIP.c.imo.is_(None),
    postgresql_where=SHIP.c.imo.is_(None),
)
LINE: Final = sa.Table(
    "line",
    METADATA,
    _id(),
    _of("ship_id"),
    _text("position"),
    _text("seal"),
    sa.UniqueConstraint("ship_id", "position"),
)
EVENT: Final = sa.Table(
    "event",
    METADATA,
    _id(),
    _of("line_id"),
    _time("at"),
    _text("kind"),
    _text("numbers_affected"),
    _text("note"),
    _text("seal"),
    sa.UniqueConstraint("line_id", "at", "kind"),
)
TRIAL: Final = sa.Table(
    "trial",
    METADATA,
    _id(),
    _of("line_id"),
    _time("tested_at"),
    _text("place", nullable=True),
    _number("draught_m"),
    _number("trim_m"),
    _number("water_c"),
    _number("density_kg_m3"),
    _number("depth_m"),
    _number("wind_m_s"),
    _text("recording_sha256", nullable=True),
    _text("seal"),
    sa.UniqueConstraint("line_id", "recording_sha256"),
)
sa.Index("trial_time", TRIAL.c.line_id, TRIAL.c.tested_at)
FINGERPRINT: Final = sa.Table(
    "fingerprint",
    METADATA,
    _id(),
    _of("trial_id"),
    _time("made_at"),
    _time("added_at"),
    sa.Column("sha256", sa.Text, nullable=False, unique=True),
    _text("structure"),
    _text("version"),
    _text("vessel_sha256", nullable=True),
    sa.Column("trustworthy", sa.Boolean, nullable=False),
    _of("supersedes", nullable=True),
    _text("stated"),
    _text("seal"),
    sa.UniqueConstraint("supersedes"),
)
sa.Index("fingerprint_trial", FINGERPRINT.c.trial_id, FINGERPRINT.c.made_at)
# apart from the rest, so that a query for numbers does not turn over their pages
DOCUMENT: Final = sa.Table(
    "document",
    METADATA,
    sa.Column(
        "fingerprint_id",
        sa.BigInteger().with_variant(sa.Integer, "sqlite"),
        sa.ForeignKey("fingerprint.id"),
        primary_key=True,
        autoincrement=False,
    ),
    sa.Column("content", sa.LargeBinary, nullable=False),
)
QUANTITY: Final = sa.Table(
    "quantity",
    METADATA,
    _id(),
    _text("kind"),
    _text("name"),
    _text("unit"),
    _text("seal"),
    sa.UniqueConstraint("name", "kind", "unit"),
)
VALUE: Final = sa.Table(
    "value",
    METADATA,
    sa.Column(
        "fingerprint_id",
        sa.BigInteger().with_variant(sa.Integer, "sqlite"),
        sa.ForeignKey("fingerprint.id"),
        primary_key=True,
        autoincrement=False,
    ),
    sa.Column(
        "quantity_id",
        sa.BigInteger().with_variant(sa.Integer, "sqlite"),
        sa.ForeignKey("quantity.id"),
        primary_key=True,
        autoincrement=False,
    ),
    _number("value"),
    _number("std"),
    _number("low"),
    _number("high"),
    sa.Column("trusted", sa.Boolean, nullable=False),
    sqlite_with_rowid=False,
)
JOB: Final = sa.Table(
    "job",
    METADATA,
    _id(),
    sa.Column("key", sa.Text, nullable=False, unique=True),
    *(_text(name) for name in ("kind", "args", "version", "state")),
    sa.Column("tries", sa.Integer, nullable=False),
    _time("enqueued_at"),
    *(_time(name, nullable=True) for name in ("ended_at", "lease_until")),
    *(_text(name, nullable=True) for name in ("owner", "progress", "sentence")),
    # done without a result in the store cannot be
    sa.Column("result", sa.Text, sa.ForeignKey("fingerprint.sha256"), nullable=True),
)
OPEN_JOB: Final = sa.text("state IN ('waiting', 'running')")
"""Where a job is still to be done; word by word as its index has it, or SQLite would not use that."""
sa.Index("job_open", JOB.c.id, sqlite_where=OPEN_JOB, postgresql_where=OPEN_JOB)
sa.Index("job_state", JOB.c.state, JOB.c.id)
HASHED_FILE: Final = sa.Table(
    "hashed_file",
    METADATA,
    sa.Column("path", sa.Text, primary_key=True),
    sa.Column("size", sa.BigInteger, nullable=False),
    # numbers of 64 bits without a sign, which no database has
    *(_text(name) for name in ("mtime_ns", "inode", "sha256")),
)
