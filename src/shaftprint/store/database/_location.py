"""Where a store is: a file of SQLite, or a database of PostgreSQL by its URL; no password is ever shown."""

import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final
from urllib.parse import quote, unquote

import sqlalchemy as sa

from shaftprint.errors import StoreError

_POSTGRESQL: Final = frozenset({"postgresql", "postgres", "postgresql+psycopg"})
_HOW: Final = "expected a file such as shaftprint.db, or a URL such as postgresql://user@host/database"


@dataclass(frozen=True, kw_only=True, slots=True)
class Location:
    """Where a store is."""

    shown: str
    """How it is called, without a password."""
    path: Path | None
    """Its file; None for one in PostgreSQL."""
    url: sa.URL | None = field(default=None, repr=False)
    """URL of the database; None for a file."""
    secrets: tuple[str, ...] = field(default=(), repr=False)
    """What must not be shown, the longest first."""

    def redacted(self, text: str) -> str:
        """Return a text without the secrets of the URL."""
        for secret in self.secrets:
            text = text.replace(secret, "***")
        return text


def location_of(text: str) -> Location:
    """Return the place that a text names: the path of a file, or a URL.

    Raises StoreError if it is neither.
    """
    scheme, mark, rest = text.partition("://")
    if not mark:
        return _file(text)
    if scheme.lower() == "sqlite":
        if not rest.startswith("/") or "?" in rest:
            raise StoreError("--store: expected sqlite:///FILE or sqlite:////FOLDER/FILE; or name the file alone.")
        return _file(rest[1:])
    if scheme.lower() not in _POSTGRESQL:
        shown = scheme if re.fullmatch(r"[a-z0-9+]{1,30}", scheme) else "another one"
        raise StoreError(f"--store: {_HOW}, found a URL of {shown}.")
    return _server(rest)


def _file(text: str) -> Location:
    if not text or "\0" in text or text.startswith(":memory:"):
        raise StoreError(f"--store: {_HOW}, found none; a store is kept.")
    return Location(shown=text, path=Path(text))


def _server(rest: str) -> Location:
    """Return the place that a URL of PostgreSQL names; of one that cannot be read nothing is repeated."""
    if rest.count("@") > 1:
        raise StoreError("--store: expected one @ in the URL, found more; write that of a password as %40.")
    try:
        url = sa.make_url(f"postgresql+psycopg://{rest}")
    except (sa.exc.ArgumentError, ValueError):
        raise StoreError(
            f"--store: {_HOW}, found a URL that cannot be read; write / : @ of a password as %2F %3A %40."
        ) from None
    hidden = [url.password or ""]
    for name, value in url.query.items():
        if "pass" in name.lower():
            hidden += [value] if isinstance(value, str) else list(value)
    forms = {
        form for secret in hidden if secret for form in (secret, quote(secret), quote(secret, safe=""), unquote(secret))
    }
    shown = sa.URL.create("postgresql", username=url.username, host=url.host, port=url.port, database=url.database)
    return Location(
        shown=shown.render_as_string(hide_password=True),
        path=None,
        url=url,
        secrets=tuple(sorted(forms, key=len, reverse=True)),
    )
