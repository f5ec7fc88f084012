"""Where a feature lives: files that ask for a table of the vessel file, a kind of channel or a role of a parameter."""

import ast
import sys
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

from room_diagram import SOURCE

from shaftprint.campaign import Campaign
from shaftprint.catalogue import ShipRole
from shaftprint.models._role import Role
from shaftprint.signals import KINDS
from shaftprint.vessel import Vessel

MOST_NAMED = 8
"""Where more files ask, the rooms are named."""
FILES_OF_USERS = {"vessel": Vessel, "campaign": Campaign}
"""Nouns that are settings, by what variables that hold one are called."""


@cache
def mentions() -> dict[str, frozenset[str]]:
    """Return what each file of the package asks for, ``ROLE`` and ``vessel.pitch``, and texts in it, by its path."""
    return {path.relative_to(SOURCE).as_posix(): frozenset(_of_file(path)) for path in sorted(SOURCE.rglob("*.py"))}


def _of_file(path: Path) -> Iterator[str]:
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Attribute):
            yield node.attr
            held_by = getattr(node.value, "id", getattr(node.value, "attr", ""))
            yield f"{held_by}.{node.attr}"
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield repr(node.value)


def _asking(word: str) -> list[str]:
    return [path for path, words in mentions().items() if word in words]


def _files(paths: list[str]) -> str:
    """Return paths or, where there are many, how many and in which rooms."""
    if len(paths) <= MOST_NAMED:
        return ", ".join(f"`{path}`" for path in paths)
    rooms = sorted({path.partition("/")[0].removesuffix(".py") for path in paths})
    return f"files in {', '.join(f'`{room}`' for room in rooms)}"


def _rows(words: str, home: str, paths: list[str]) -> list[str]:
    """Return the row of what others than its own file ask for."""
    others = [path for path in paths if path != home]
    return [f"| {words} | `{home}` | {_files(others)} |"] if others else []


def _home_of(value: object) -> str:
    return Path(str(sys.modules[type(value).__module__].__file__)).relative_to(SOURCE).as_posix()


def _fields() -> Iterator[str]:
    """Yield a row for each table or field that a vessel or a campaign may do without."""
    for noun, record in FILES_OF_USERS.items():
        for name, field in record.model_fields.items():
            if not field.is_required():
                yield from _rows(f"`{noun}.{name}`", f"{noun}/_{noun}.py", _asking(f"{noun}.{name}"))


def _kinds() -> Iterator[str]:
    for name, kind in KINDS.items():
        yield from _rows(f"`{name}`", _home_of(kind), _asking(repr(name)))


def _roles() -> Iterator[str]:
    for name in (name for name, role in vars(ShipRole).items() if isinstance(role, Role)):
        yield from _rows(f"`{name}`", "catalogue/_roles.py", _asking(name))


PARTS: dict[str, tuple[str, Callable[[], Iterator[str]]]] = {
    "A table of the vessel or campaign file": ("table or field", _fields),
    "A channel": ("symbol", _kinds),
    "A parameter": ("role", _roles),
}


def feature_map() -> str:
    """Return the tables of the map."""
    parts = []
    for title, (first, rows) in PARTS.items():
        parts.append(f"### {title}")
        parts.append("\n".join([f"| {first} | is defined in | is asked for in |", "|---|---|---|", *rows()]))
    return "\n\n".join(parts)
