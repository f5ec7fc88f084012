"""The file of users: a table for each with the hash of his password, his role and his ships."""

import re
import tomllib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from shaftprint.errors import ServerError
from shaftprint.files import reason, write_bytes
from shaftprint.spelling import meant
from shaftprint.web.access._password import is_hash
from shaftprint.web.access._person import ALL, Person, Role

ROLES: Final = {role.name.lower(): role for role in Role}
"""Roles by their names in the file."""
_FIELDS: Final = ("password", "role", "ships")
_NAME: Final = re.compile(r"[a-z0-9][a-z0-9._-]{0,39}")
_MOST_BYTES: Final = 2**20


@dataclass(slots=True)
class Users:
    """Who may sign in, read anew when the file was written."""

    path: Path
    """The file."""
    _known: dict[str, Person] = field(default_factory=dict)
    _stamp: tuple[int, int] | None = None

    def named(self, name: str) -> Person | None:
        """Return somebody by his name; None where nobody has it, or the file cannot be read any more."""
        try:
            status = self.path.stat()
            stamp = (status.st_mtime_ns, status.st_size)
            if stamp != self._stamp:
                self._known, self._stamp = read_users(self.path), stamp
        except (OSError, ServerError):
            # whoever was taken out of a file that is being written must not come in meanwhile
            self._known, self._stamp = {}, None
        return self._known.get(name)


def read_users(path: Path) -> dict[str, Person]:
    """Return the users of a file by their names.

    Raises ServerError if it cannot be read, or a field is not as expected.
    """
    try:
        content = path.read_bytes()[: _MOST_BYTES + 1]
    except OSError as refusal:
        raise ServerError(
            f"{path}: expected a file of users, but it cannot be read: {reason(refusal)}; make one with shaftprint "
            "serve --add-user NAME."
        ) from None
    try:
        table = tomllib.loads(content.decode())
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as fault:
        raise ServerError(f"{path}: expected a file of users in TOML, found something else: {fault}.") from None
    users = table.get("users")
    if len(table) != 1 or not isinstance(users, dict):
        raise ServerError(f"{path}: expected a table [users.NAME] for each user and nothing else, found {list(table)}.")
    return {name: _person(name, fields, path) for name, fields in users.items()}


def _person(name: str, fields: Any, path: Path) -> Person:
    where = f"{path}: [users.{name[:40]}]"
    if not _NAME.fullmatch(name):
        raise ServerError(f"{where}: expected a name of small letters, digits, dots and hyphens, found {name[:40]!r}.")
    if not isinstance(fields, dict):
        raise ServerError(f"{where}: expected a table, found {fields!r:.40}.")
    for one in fields:
        if one not in _FIELDS:
            raise ServerError(f"{where}: expected {', '.join(_FIELDS)}, found {one[:40]!r}.{meant(one, _FIELDS)}")
    password, role, ships = (fields.get(one) for one in _FIELDS)
    if not isinstance(password, str) or not is_hash(password):
        raise ServerError(
            f"{where}: password: expected a hash of argon2id, found none; let shaftprint serve --add-user write it."
        )
    if not isinstance(role, str) or role not in ROLES:
        raise ServerError(f"{where}: role: expected {', '.join(ROLES)}, found {role!r:.40}.")
    return Person(name=name, role=ROLES[role], ships=_ships(ships, where), password=password)


def _ships(ships: Any, where: str) -> tuple[str, ...]:
    if ships == ALL:
        return (ALL,)
    texts = [str(one) for one in ships if isinstance(one, str | int)] if isinstance(ships, list) else []
    if not isinstance(ships, list) or len(texts) != len(ships) or ALL in texts:
        raise ServerError(f'{where}: ships: expected a list of IMO numbers, such as [9074729], or "{ALL}".')
    return tuple(texts)


def with_user(path: Path, person: Person) -> None:
    """Write a file of users with one more, or with one changed; the others stay.

    Raises
    ------
    ServerError
        If the name is none, or the file there cannot be read or written.
    """
    if not _NAME.fullmatch(person.name):
        raise ServerError(
            f"expected a name of small letters, digits, dots and hyphens, at most 40, found {person.name[:60]!r}."
        )
    users = (read_users(path) if path.exists() else {}) | {person.name: person}
    text = "\n".join(_text(one) for one in users.values())
    # hashes of passwords are for the server alone
    write_bytes(path, text.encode(), noun="file of users", error=ServerError, is_private=True)


def _text(person: Person) -> str:
    ships = f'"{ALL}"' if person.sees_all else "[" + ", ".join(_quoted(one) for one in person.ships) + "]"
    return (
        f"[users.{_quoted(person.name)}]\npassword = {_quoted(person.password)}\n"
        f"role = {_quoted(person.role.name.lower())}\nships = {ships}\n"
    )


def _quoted(text: str) -> str:
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'
