"""What lies in a folder: vessel, campaign and drive files, recordings, plans and results, each the newest last."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from shaftprint.cli.output._fingerprint_file import FINGERPRINT
from shaftprint.errors import ShaftprintError
from shaftprint.late import late

with late():
    from shaftprint.design.files import _plan_folder, _plan_json
    from shaftprint.file_kinds import kind_of_file
    from shaftprint.recording.readers import _all

_MOST_FILES = 500
# Bytes of a text in which somebody notes something; a test is longer in any format.
_NOTES = 10_000
_SETTINGS, _TRUTH, _DATABASE = ".toml", ".truth.json", ".dbc"
_KINDS = ("vessels", "campaigns", "drives", "recordings", "databases", "results", "others")
# read as text or by chance, but no recording of a ship
_NO_RECORDING = frozenset((_SETTINGS, ".json", ".html", ".md", ".py", ".pdf", ".svg", ".png", ".db", ".zip"))


@dataclass(frozen=True, kw_only=True, slots=True)
class LyingFiles:
    """Files and folders by what they are, the newest last."""

    vessels: tuple[Path, ...] = ()
    campaigns: tuple[Path, ...] = ()
    drives: tuple[Path, ...] = ()
    recordings: tuple[Path, ...] = ()
    databases: tuple[Path, ...] = ()
    """What says what frames of a CAN bus hold."""
    results: tuple[Path, ...] = ()
    others: tuple[Path, ...] = ()
    """Files that are none of these."""


def lying_files(folder: Path) -> LyingFiles:
    """Return what lies in a folder; of its folders, plans and results are looked for."""
    found: dict[str, list[Path]] = {name: [] for name in _KINDS}
    paths = sorted(folder.iterdir(), key=lambda path: (path.stat().st_mtime if path.exists() else 0.0, path.name))
    for path in paths[-_MOST_FILES:]:
        if path.name.startswith("."):
            continue
        for kind, place in _of(path):
            found[kind].append(place)
    return LyingFiles(**{kind: tuple(places) for kind, places in found.items()})


def _of(path: Path) -> Iterator[tuple[str, Path]]:
    if path.is_dir():
        if (path / FINGERPRINT).is_file():
            yield "results", path
        campaign = path / _plan_folder.CAMPAIGN
        if (path / _plan_json.PLAN).is_file() and campaign.is_file():
            yield "campaigns", campaign
        return
    ending = path.suffix.lower()
    if ending == _SETTINGS:
        kind = kind_of_file(path)
        yield f"{kind}s" if kind in ("vessel", "campaign", "drive") else "others", path
    elif ending == _DATABASE:
        yield "databases", path
    elif ending not in _NO_RECORDING and _is_recording(path):
        yield "recordings", path
    elif not path.name.lower().endswith(_TRUTH):
        yield "others", path


def _is_recording(path: Path) -> bool:
    """Return whether a file begins as one of a logger does; it is not read."""
    try:
        return path.stat().st_size > _NOTES and any(reader.is_mine(path) for reader in _all.READERS)
    except (ShaftprintError, OSError):
        return False
