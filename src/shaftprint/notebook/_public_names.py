"""Names that the rooms give, found without loading a room, to answer for one that is not there."""

import ast
import difflib
from collections.abc import Iterator
from pathlib import Path

MOST_ANSWERS = 2
LEAST_LIKENESS = 0.7
OF_THE_PROGRAM = "cli"


def closest_names(name: str) -> tuple[str, ...]:
    """Return where the public names are that are most like another, such as ``sp.fingerprint.read_fingerprint``.

    All rooms together take seconds to load, so their files are read instead. ``name``: what somebody looked for.
    """
    rooms: dict[str, str] = {"open_survey": "sp", "read": "sp"}
    for room, public in _public_names():
        rooms.setdefault(public, f"sp.{room}")
    close = difflib.get_close_matches(name, rooms, n=MOST_ANSWERS, cutoff=LEAST_LIKENESS)
    begun = [public for public in rooms if public.startswith(f"{name}_")]
    candidates = [name] if name in rooms else list(dict.fromkeys([*begun, *close]))[:MOST_ANSWERS]
    return tuple(f"{rooms[public]}.{public}" for public in candidates)


def _public_names() -> Iterator[tuple[str, str]]:
    """Yield room and name of everything that stands at a room's door."""
    for door in sorted(Path(__file__).parents[1].glob("*/__init__.pyi")):
        if door.parent.name == OF_THE_PROGRAM:
            continue
        for node in ast.parse(door.read_text(encoding="utf-8")).body:
            if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__":
                yield from ((door.parent.name, public) for public in ast.literal_eval(node.value))
