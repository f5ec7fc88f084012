"""Logs of a CAN bus that hold frames only: BLF, ASC, TRC and candump."""

import contextlib
import io
from pathlib import Path

from shaftprint.errors import RecordingError
from shaftprint.files import kept_open
from shaftprint.recording._recording import Recording
from shaftprint.recording.readers._damage import told_as_damage
from shaftprint.recording.readers._extra import library
from shaftprint.recording.readers._gather import Gathered, reasons_in_words, unique_names
from shaftprint.recording.readers._hints import expect_hints
from shaftprint.recording.readers._opened import Opened
from shaftprint.recording.readers._packed import FIRST_BYTES, first_bytes, open_unpacked
from shaftprint.recording.readers.can._beside import Chosen, chosen_database, dbc_path
from shaftprint.recording.readers.can._blf import SIGNATURE, open_blf
from shaftprint.recording.readers.can._channels import Decoded, decoded
from shaftprint.recording.readers.can._frames import FrameLog
from shaftprint.recording.readers.can._text_logs import kind_of, open_text_log

NAME = "CAN log"


def is_mine(path: Path) -> bool:
    """Return whether the file begins as one of these logs."""
    begin = first_bytes(path)
    return begin is not None and begins_as_log(path, begin)


def begins_as_log(path: Path, begin: bytes) -> bool:
    """Return the same of a file whose first bytes have been read."""
    return begin.startswith(SIGNATURE) or bool(kind_of(path, _text(begin)))


def read(path: Path, **hints: object) -> Recording:
    """Open a log of frames; its signals are laid into a temporary file, which is deleted when it is closed.

    Hints: ``dbc``, the DBC or ARXML file that says what the frames hold. Without it one beside the log is taken, of its
    name with ``.dbc`` behind, or the only one of the folder that knows its messages; without one the messages of
    engines, gearboxes and rudders by SAE J1939 and NMEA 2000.

    Raises RecordingError if the file is damaged or holds no message that is known.
    """
    expect_hints(path, hints, {"dbc": (str, Path)})
    with contextlib.ExitStack() as stack, told_as_damage(path, NAME):
        chosen = chosen_database(path, hints, lambda: _open(path, stack))
        log = _open(path, stack)
        taken = decoded(path, log, chosen.database)
    with kept_open(Opened(path, taken.close)) as opened:
        expect_known(path, taken, chosen)
        gathered = Gathered(path=path, remarks=[chosen.remark] if chosen.remark else [])
        add_signals(gathered, taken, unique_names(list(taken.named)))
        return gathered.recording(f"{NAME} ({log.kind}){chosen.words}", opened.close, log.began)


def expect_known(path: Path, taken: Decoded, chosen: Chosen) -> None:
    """Refuse a log of which no message is known.

    Raises RecordingError if there is none.
    """
    if taken.named:
        return
    unknown = reasons_in_words(taken.left_out(()), most=3)
    in_brackets = f" ({unknown})" if unknown else ""
    if chosen.doubt:
        raise RecordingError(f"{path}: expected one file that says what its frames hold, found that {chosen.doubt}.")
    if chosen.database.name:
        raise RecordingError(
            f"{path}: expected messages that {chosen.database.name} knows, found none of them in the log{in_brackets}; "
            "take the DBC file of this ship."
        )
    raise RecordingError(
        f"{path}: expected the DBC file that says what the frames hold, as none is of engine, gearbox or rudder "
        f"by SAE J1939 or NMEA 2000; lay it beside as {dbc_path(path).name}, or name it, dbc= (--dbc). The log "
        f"has {unknown or 'no frame'}."
    )


def add_signals(gathered: Gathered, taken: Decoded, names: list[str]) -> None:
    """Add the channels of a log under their names, and what is left out."""
    for name, make in zip(names, taken.make, strict=True):
        gathered.add(name, lambda make=make, name=name: make(name))  # type: ignore[misc]
    gathered.left_out.update(taken.left_out(tuple(names)))


def _open(path: Path, stack: contextlib.ExitStack) -> FrameLog:
    binary = stack.enter_context(open_unpacked(path))
    begin = binary.read(FIRST_BYTES)
    binary.seek(0)
    if begin.startswith(SIGNATURE):
        return open_blf(path, binary)
    package = library(path, "can", NAME)
    text = stack.enter_context(io.TextIOWrapper(binary, encoding="utf-8-sig", errors="replace"))
    return open_text_log(path, kind_of(path, _text(begin)), text, package)


def _text(begin: bytes) -> str:
    return begin.decode("utf-8-sig", "replace")
