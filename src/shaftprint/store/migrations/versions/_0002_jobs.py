"""Jobs, and the SHA-256 of files that were read for them."""

import sqlalchemy as sa
from alembic import op

revision = "0002"
down_revision = "0001"

# what a schema was stays as it is here, whatever the program's own tables become
ID = sa.BigInteger().with_variant(sa.Integer, "sqlite")
TIME = sa.DateTime(timezone=True).with_variant(sa.String(27), "sqlite")


def upgrade() -> None:
    """Make the tables."""
    op.create_table(
        "job",
        sa.Column("id", ID, primary_key=True, autoincrement=False),
        *(sa.Column(name, sa.Text, nullable=False) for name in ("key", "kind", "args", "version", "state")),
        sa.Column("tries", sa.Integer, nullable=False),
        sa.Column("enqueued_at", TIME, nullable=False),
        *(sa.Column(name, TIME, nullable=True) for name in ("ended_at", "lease_until")),
        *(sa.Column(name, sa.Text, nullable=True) for name in ("owner", "progress", "sentence")),
        sa.Column("result", sa.Text, sa.ForeignKey("fingerprint.sha256"), nullable=True),
        sa.UniqueConstraint("key"),
    )
    is_open = sa.text("state IN ('waiting', 'running')")
    op.create_index("job_open", "job", ["id"], sqlite_where=is_open, postgresql_where=is_open)
    op.create_index("job_state", "job", ["state", "id"])
    op.create_table(
        "hashed_file",
        sa.Column("path", sa.Text, primary_key=True),
        sa.Column("size", sa.BigInteger, nullable=False),
        *(sa.Column(name, sa.Text, nullable=False) for name in ("mtime_ns", "inode", "sha256")),
    )
