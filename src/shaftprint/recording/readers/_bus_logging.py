"""Raw messages of a CAN bus in an MDF file, taken apart as a DBC file says what they hold."""

import contextlib
import io
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from shaftprint.errors import RecordingError
from shaftprint.recording.readers._extra import library

# ASAM MDF 4.1, block CG: the records are events of a bus.
_BUS_EVENT = 2
# what the library prints where it leaves a line out
_LINE = re.compile(r"error with line no: (\d+)")
_MESSAGE = re.compile(r"(?P<bus>CAN\d*) ID=\S+ (?P<message>\S+)(?: PGN=\S+ SA=(?P<sender>\S+))?")


@dataclass(frozen=True, kw_only=True, slots=True)
class BusSignal:
    """What a DBC file says of one signal."""

    spn: int | None
    """Its number in SAE J1939-71, such as 190 for the engine speed; None where the file has none."""
    lowest: float
    """Smallest value [unit]: what is below says that there is none."""
    highest: float
    """Largest value [unit]: what is above says that there is none, or an error."""
    comment: str
    """What it is, in words."""


def is_bus_logging(group: Any) -> bool:
    """Return whether a group of an open MDF file holds raw messages."""
    return bool(int(getattr(group.channel_group, "flags", 0)) & _BUS_EVENT)


def message_of(group: Any) -> str:
    """Return the name of the message from which a group was taken apart, with its sender where several may send it."""
    found = _MESSAGE.search(str(getattr(group.channel_group, "comment", "") or ""))
    if found is None:
        return ""
    sender = found["sender"]
    return found["message"] if sender is None else f"{found['message']} of {sender}"


def bus_signals(dbc: Path) -> tuple[Mapping[str, BusSignal], dict[str, str]]:
    """Return what a DBC file says of its signals, by message and name: ``"EEC1.EngineSpeed"``; and what is left out.

    Raises
    ------
    RecordingError
        If it is missing or no DBC file.
    """
    if not dbc.is_file():
        raise RecordingError(f"{dbc}: expected a DBC file, found none there.")
    canmatrix = library(dbc, "canmatrix", "DBC")
    library(dbc, "canmatrix.formats", "DBC")
    try:
        with in_silence() as said:
            matrices = canmatrix.formats.loadp(str(dbc), import_type="dbc")
        signals = {
            f"{frame.name}.{signal.name}": _signal(signal)
            for matrix in matrices.values()
            for frame in matrix.frames
            for signal in frame.signals
        }
    except Exception as error:
        reason = " ".join(str(error).split())[:200] or type(error).__name__
        raise RecordingError(f"{dbc}: expected a DBC file, found one that cannot be read ({reason}).") from None
    if not signals:
        raise RecordingError(f"{dbc}: expected a DBC file with messages and signals, found none in it.")
    lines = _LINE.findall(said.getvalue())
    return signals, {f"{dbc.name}, line {number}": "the line cannot be read" for number in lines}


@contextlib.contextmanager
def in_silence() -> Iterator[io.StringIO]:
    """Give what a library prints, which would stand in the answer of a command: letters of a file as they are."""
    with contextlib.redirect_stdout(io.StringIO()) as said, contextlib.redirect_stderr(said):
        yield said


def taken_apart(path: Path, file: Any, dbc: Path) -> Any:
    """Return an open MDF file with a group for each message that a DBC file knows.

    Parameters
    ----------
    path, file
        The log, and what the library has opened of it.
    dbc
        The DBC file.

    Raises
    ------
    RecordingError
        If there are no raw messages, or none that the DBC file knows.
    """
    if not any(is_bus_logging(group) for group in file.groups):
        raise RecordingError(
            f"{path}: expected raw messages of a bus for {dbc.name}, found none; leave the DBC file out."
        )
    with in_silence():
        apart = file.extract_bus_logging(database_files={"CAN": [(str(dbc), 0)]}, ignore_value2text_conversion=True)
    if not apart.groups:
        apart.close()
        raise RecordingError(
            f"{path}: expected messages that {dbc.name} knows, found none of them in the log; take the DBC file of "
            "this ship."
        )
    return apart


def signal_of(described: Any, signals: Mapping[str, BusSignal]) -> BusSignal | None:
    """Return what a DBC file says of a channel that was taken out of a message."""
    names = getattr(described, "display_names", None) or {}
    return next((signals[name] for name in names if name in signals), None)


def _signal(signal: Any) -> BusSignal:
    spn = str(signal.attributes.get("SPN", ""))
    lowest, highest = (float("nan") if end is None else float(end) for end in (signal.min, signal.max))
    is_range = lowest < highest
    return BusSignal(
        spn=int(spn) if spn.isdecimal() and int(spn) else None,
        lowest=lowest if is_range else -float("inf"),
        highest=highest if is_range else float("inf"),
        comment=str(signal.comment or "").strip(),
    )
