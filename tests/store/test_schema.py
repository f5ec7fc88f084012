"""The tables are those of the migrations, and a store of another schema is refused with what to do."""

import shutil
import sqlite3

import pytest
import sqlalchemy as sa
from alembic.autogenerate import compare_metadata
from alembic.config import Config
from alembic.migration import MigrationContext
from alembic.script import ScriptDirectory

from shaftprint.errors import StoreError
from shaftprint.store import check, create_store, database, history, open_store
from shaftprint.store._store import upgrade_store

LATER = """
\"\"\"Another column.\"\"\"
import sqlalchemy as sa
from alembic import op

revision = "0003"
down_revision = "0002"


def upgrade():
    with op.batch_alter_table("trial") as trial:
        trial.add_column(sa.Column("sea_state", sa.Integer, nullable=True))
    {more}
"""


def test_the_tables_are_those_of_the_migrations(store):
    with store.database.reading() as connection:
        context = MigrationContext.configure(
            connection, opts={"version_table": "shaftprint_schema", "compare_type": True}
        )
        assert compare_metadata(context, database.METADATA) == []


def test_the_newest_migration_is_the_one_that_the_program_knows():
    config = Config()
    config.set_main_option("script_location", str(database.MIGRATIONS))
    assert ScriptDirectory.from_config(config).get_heads() == [database.HEAD]


def test_a_store_is_made_once(store, url, put):
    put(store)
    with pytest.raises(StoreError, match="expected no store yet, found one; it is as it was"):
        create_store(url)
    assert len(history(store, "Meander").entries) == 1


def test_who_comes_second_leaves_the_store_that_another_made_meanwhile(tmp_path, monkeypatch):
    """The second took away the file that it had found missing, and with it the store of the first."""
    url, connect = str(tmp_path / "fleet.db"), sqlite3.connect

    def connect_after_another(*args, **options):
        monkeypatch.undo()
        create_store(url).close()
        return connect(*args, **options)

    monkeypatch.setattr(sqlite3, "connect", connect_after_another)
    with pytest.raises(StoreError, match="expected no store yet, found one; it is as it was"):
        create_store(url)
    open_store(url).close()


def test_what_fails_on_the_way_leaves_no_file(tmp_path, monkeypatch):
    def fails(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("alembic.command.upgrade", fails)
    with pytest.raises(KeyboardInterrupt):
        create_store(str(tmp_path / "fleet.db"))
    assert list(tmp_path.iterdir()) == []


def test_a_file_keeps_what_it_acknowledges(file_store):
    with file_store.database.unlocked() as raw:
        asked = {
            name: raw.execute(f"PRAGMA {name}").fetchone()[0]
            for name in ("journal_mode", "synchronous", "foreign_keys")
        }
    # 2 is FULL
    assert asked == {"journal_mode": "wal", "synchronous": 2, "foreign_keys": 1}


@pytest.fixture
def later_program(tmp_path, monkeypatch):
    """Let the program be one that knows a later schema."""

    def become(more=""):
        folder = tmp_path / "migrations"
        shutil.copytree(database.MIGRATIONS, folder)
        (folder / "versions" / "_0003_sea_state.py").write_text(LATER.format(more=more), encoding="utf-8")
        for name in ("MIGRATIONS", "HEAD"):
            value = folder if name == "MIGRATIONS" else "0003"
            monkeypatch.setattr(f"shaftprint.store.database._schema.{name}", value)

    return become


def test_an_earlier_store_is_upgraded(store, url, put, later_program, monkeypatch):
    put(store)
    store.close()
    later_program()
    with pytest.raises(StoreError, match=r"expected a store of schema 0003, found the earlier 0002; .* store upgrade"):
        open_store(url)
    assert upgrade_store(url) == ("0002", "0003")
    assert upgrade_store(url) == ("0003", "0003")
    with open_store(url) as opened:
        assert len(history(opened, "Meander").entries) == 1
        assert check(opened) == ()
    monkeypatch.undo()
    with pytest.raises(StoreError, match=r"expected a store of schema 0002, found the later 0003; use the version"):
        open_store(url)


def test_a_store_of_the_first_schema_gets_its_tables_of_jobs(store, url, put):
    put(store)
    with store.database.writing() as connection:
        connection.execute(sa.text("DROP TABLE job"))
        connection.execute(sa.text("DROP TABLE hashed_file"))
        connection.execute(sa.text("UPDATE shaftprint_schema SET version_num = '0001'"))
    store.close()
    with pytest.raises(StoreError, match=r"found the earlier 0001; bring it up to date with shaftprint store upgrade"):
        open_store(url)
    assert upgrade_store(url) == ("0001", "0002")
    with open_store(url) as opened:
        test_the_tables_are_those_of_the_migrations(opened)
        assert len(history(opened, "Meander").entries) == 1


def test_an_upgrade_that_fails_changes_nothing(store, url, put, later_program, monkeypatch):
    put(store)
    store.close()
    later_program('op.execute("SELECT * FROM no_such_table")')
    with pytest.raises(StoreError):
        upgrade_store(url)
    monkeypatch.undo()
    with open_store(url) as opened, opened.database.reading() as connection:
        assert "sea_state" not in {column["name"] for column in sa.inspect(connection).get_columns("trial")}


def test_a_database_of_another_program_is_left_alone(tmp_path):
    path = tmp_path / "mlflow.db"
    with sqlite3.connect(path) as connection:
        connection.execute("CREATE TABLE alembic_version (version_num VARCHAR(32))")
    connection.close()
    before = path.read_bytes()
    for verb in (open_store, upgrade_store):
        with pytest.raises(StoreError, match="expected a store of fingerprints, found a database without one"):
            verb(str(path))
    with pytest.raises(StoreError, match="expected an empty database, found the table 'alembic_version' of another"):
        create_store(str(path))
    assert path.read_bytes() == before


@pytest.mark.slow
def test_a_database_that_has_one_of_the_tables_is_left_alone(server):
    url = server.new_database()
    engine = sa.create_engine(url.replace("postgresql", "postgresql+psycopg"))
    with engine.begin() as connection:
        connection.execute(sa.text("CREATE TABLE ship (id integer)"))
        connection.execute(sa.text("CREATE TABLE other (id integer)"))
    with pytest.raises(StoreError, match="found the table 'ship' of another program"):
        create_store(url)
    with engine.begin() as connection:
        connection.execute(sa.text("DROP TABLE ship"))
    create_store(url).close()
    engine.dispose()


@pytest.mark.slow
def test_letters_that_a_database_does_not_have_are_asked_for(server):
    with pytest.raises(StoreError, match="expected a database in UTF8, found LATIN1"):
        create_store(server.new_database(encoding="LATIN1"))
