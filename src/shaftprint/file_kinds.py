"""What kind of settings file a TOML file is, by the tables and keys that only one kind has.

Its lines are looked at and no more, so that a page may ask it of a file that nobody has checked.
"""

import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Final

_KEYS: Final[Mapping[str, frozenset[str]]] = {
    "vessel": frozenset(("engine", "motor", "gearbox", "propeller", "working_point", "inertia", "sensors", "logger")),
    "campaign": frozenset(("offset_v", "duration_s", "sines", "multisines", "chirps", "staircases", "legs", "ramps")),
    "conditions": frozenset(("draught_m", "trim_m", "water_temperature_c", "depth_m", "wind_m_s")),
    "drive": frozenset(("inputs", "outputs", "structure", "known", "fit")),
}
# A table, or a key; of one with points the first part.
_TABLE: Final = re.compile(r"[ \t]*\[{1,2}[ \t]*[\"']?(\w+)")
_KEY: Final = re.compile(r"[ \t]*(\w+)[ \t]*[.=]")
_MOST: Final = 2**20


def kind_of(keys: Iterable[str]) -> str | None:
    """Return what kind of settings file has such keys: vessel, campaign, conditions or drive; None where none has."""
    counts = {kind: len(own.intersection(keys)) for kind, own in _KEYS.items()}
    kind = max(counts, key=lambda name: counts[name])
    return kind if counts[kind] > 0 else None


def kind_of_file(path: Path) -> str | None:
    """Return what kind of settings file a TOML file is; None where it is none, or cannot be read."""
    try:
        with path.open("rb") as file:
            lines = file.read(_MOST).decode("utf-8").splitlines()
    except (OSError, ValueError):
        return None
    keys: set[str] = set()
    within = False
    for line in lines:
        table = _TABLE.match(line)
        within = within or table is not None
        found = table if within else _KEY.match(line)
        keys |= set() if found is None else {found[1]}
    return kind_of(keys)
