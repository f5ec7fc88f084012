"""Ships, lines, events, trials, and fingerprints with their documents and numbers."""

import sqlalchemy as sa
from alembic import op

revision = "0001"
down_revision = None

# what a schema was stays as it is here, whatever the program's own tables become
ID = sa.BigInteger().with_variant(sa.Integer, "sqlite")
TIME = sa.DateTime(timezone=True).with_variant(sa.String(27), "sqlite")


def _id() -> sa.Column[int]:
    return sa.Column("id", ID, primary_key=True, autoincrement=False)


def _of(name: str, table: str, *, key: bool = False, nullable: bool = False) -> sa.Column[int]:
    column = sa.ForeignKey(f"{table}.id")
    return sa.Column(name, ID, column, primary_key=key, autoincrement=False, nullable=nullable)


def _texts(*names: str, nullable: bool = False) -> list[sa.Column[str]]:
    return [sa.Column(name, sa.Text, nullable=nullable) for name in names]


def _numbers(*names: str) -> list[sa.Column[float]]:
    return [sa.Column(name, sa.Double, nullable=True) for name in names]


def upgrade() -> None:
    """Make the tables."""
    _ships()
    _tests()
    _values()


def _ships() -> None:
    op.create_table(
        "ship",
        _id(),
        sa.Column("imo", sa.Integer, nullable=True),
        *_texts("name"),
        *_texts("class_of", nullable=True),
        *_texts("seal"),
        sa.UniqueConstraint("imo"),
    )
    op.create_index("ship_name", "ship", ["name"])
    without = sa.text("imo IS NULL")
    op.create_index("ship_without_imo", "ship", ["name"], unique=True, sqlite_where=without, postgresql_where=without)
    op.create_table(
        "line", _id(), _of("ship_id", "ship"), *_texts("position", "seal"), sa.UniqueConstraint("ship_id", "position")
    )
    op.create_table(
        "event",
        _id(),
        _of("line_id", "line"),
        sa.Column("at", TIME, nullable=False),
        *_texts("kind", "numbers_affected", "note", "seal"),
        sa.UniqueConstraint("line_id", "at", "kind"),
    )


def _tests() -> None:
    op.create_table(
        "trial",
        _id(),
        _of("line_id", "line"),
        sa.Column("tested_at", TIME, nullable=False),
        *_texts("place", nullable=True),
        *_numbers("draught_m", "trim_m", "water_c", "density_kg_m3", "depth_m", "wind_m_s"),
        *_texts("recording_sha256", nullable=True),
        *_texts("seal"),
        sa.UniqueConstraint("line_id", "recording_sha256"),
    )
    op.create_index("trial_time", "trial", ["line_id", "tested_at"])
    op.create_table(
        "fingerprint",
        _id(),
        _of("trial_id", "trial"),
        sa.Column("made_at", TIME, nullable=False),
        sa.Column("added_at", TIME, nullable=False),
        *_texts("sha256", "structure", "version"),
        *_texts("vessel_sha256", nullable=True),
        sa.Column("trustworthy", sa.Boolean, nullable=False),
        _of("supersedes", "fingerprint", nullable=True),
        *_texts("stated", "seal"),
        sa.UniqueConstraint("sha256"),
        sa.UniqueConstraint("supersedes"),
    )
    op.create_index("fingerprint_trial", "fingerprint", ["trial_id", "made_at"])


def _values() -> None:
    op.create_table(
        "document",
        _of("fingerprint_id", "fingerprint", key=True),
        sa.Column("content", sa.LargeBinary, nullable=False),
    )
    op.create_table(
        "quantity", _id(), *_texts("kind", "name", "unit", "seal"), sa.UniqueConstraint("name", "kind", "unit")
    )
    op.create_table(
        "value",
        _of("fingerprint_id", "fingerprint", key=True),
        _of("quantity_id", "quantity", key=True),
        *_numbers("value", "std", "low", "high"),
        sa.Column("trusted", sa.Boolean, nullable=False),
        sqlite_with_rowid=False,
    )
