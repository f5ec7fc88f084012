"""Which DBC file beside a log says what its frames hold: the one of its name, else the only one that knows them."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from shaftprint.errors import RecordingError
from shaftprint.recording.readers.can._database import Database, known_messages, read_database
from shaftprint.recording.readers.can._frames import FrameLog

_ENDING = ".dbc"
# So many frames of the begin of a log tell which messages are in it, and so many files of a folder are looked at.
_FRAMES, _MOST_FILES = 200_000, 20


@dataclass(frozen=True, kw_only=True, slots=True)
class Chosen:
    """What the frames of a log hold, and where that is from."""

    database: Database
    """The messages."""
    words: str = ""
    """What the name of the format says of it."""
    remark: str = ""
    """What was taken of the folder, or could have been."""
    doubt: str = ""
    """Why none of several files was taken; empty elsewhere."""


def dbc_path(path: Path) -> Path:
    """Return the DBC file that is written and looked for beside a log."""
    return path.with_name(f"{path.name}{_ENDING}")


def chosen_database(path: Path, hints: Mapping[str, object], log: Callable[[], FrameLog]) -> Chosen:
    """Return what the hint ``dbc`` names, else what lies beside a log, else the messages that need no file.

    Beside lies a file of the log's name with ``.dbc`` behind, or the only one of the folder that knows its messages,
    as many of them as are known without a file.

    ``path``, ``hints``: the log. ``log``: opens its frames once more. Raises RecordingError if the file that is named,
    or that of the log's name, cannot be read.
    """
    if hints.get("dbc") is not None:
        return Chosen(database=read_database(Path(str(hints["dbc"]))))
    own = dbc_path(path)
    if _is_file(own):
        return Chosen(database=read_database(own), words=f" with {own.name} beside it")
    others = _others(path)
    if not others:
        return Chosen(database=known_messages())
    identifiers = _identifiers(log())
    if not identifiers:
        return Chosen(database=known_messages())
    by_itself = _known(known_messages(), identifiers)
    knowing: list[tuple[Path, Database, int]] = []
    unread: list[str] = []
    for other in others:
        try:
            database = read_database(other)
        except RecordingError as error:
            unread.append(str(error))
            continue
        count = _known(database, identifiers)
        if count:
            knowing.append((other, database, count))
    told = " and ".join(f"{other.name} {count}" for other, _, count in knowing)
    of_log = f"of the {len(identifiers)} messages in the log"
    if len(knowing) == 1 and knowing[0][2] >= by_itself:
        ((other, database, _),) = knowing
        return Chosen(
            database=database,
            words=f" with {other.name} beside it",
            remark=f"{other.name} of the same folder says what the frames hold: it knows {knowing[0][2]} {of_log}.",
        )
    if knowing:
        found = f"{told} {of_log}; name the right one, dbc= (--dbc), or lay it beside as {own.name}"
        return Chosen(
            database=known_messages(),
            remark=f"No DBC file of the folder was taken: {found}.",
            doubt="" if len(knowing) == 1 else f"several DBC files of the folder know them, {found}",
        )
    names = ", ".join(other.name for other in others)
    unreadable = f" ({unread[0]})" if unread else ""
    return Chosen(
        database=known_messages(), remark=f"{names} of the same folder: no message in the log is known{unreadable}."
    )


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except OSError:
        # with the ending the name is longer than a name may be
        return False


def _others(path: Path) -> list[Path]:
    """Return the DBC files of a folder that are not those of other logs."""
    try:
        files = sorted(one for one in path.parent.iterdir() if one.suffix.lower() == _ENDING and one.is_file())
    except OSError:
        return []
    return [one for one in files if not one.with_suffix("").is_file()][:_MOST_FILES]


def _identifiers(log: FrameLog) -> set[int]:
    """Return the identifiers in the begin of a log."""
    found: set[int] = set()
    count = 0
    for block in log.blocks:
        found.update(np.unique(block.identifier).tolist())
        count += len(block.identifier)
        if count >= _FRAMES:
            break
    return found


def _known(database: Database, identifiers: set[int]) -> int:
    return sum(database.message(one) is not None for one in identifiers)
