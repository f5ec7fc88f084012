"""A store and recordings for fleet runs."""

import pytest

from shaftprint.store import create_store

pytest.importorskip("sqlalchemy", reason="the store is an extra: pip install shaftprint[store]")
pytest.importorskip("alembic", reason="the store is an extra: pip install shaftprint[store]")


@pytest.fixture
def url(tmp_path):
    """Where a store may be made."""
    return str(tmp_path / "fleet.db")


@pytest.fixture
def store(url):
    """An empty store in a file."""
    with create_store(url) as made:
        yield made
