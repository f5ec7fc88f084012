"""Messages as the log of a CAN bus, by python-can, with the DBC file that says what they hold."""

import heapq
import io
import math
from collections.abc import Iterator, Sequence
from datetime import UTC, datetime
from decimal import Decimal
from pathlib import Path
from typing import Any

from shaftprint.escape import dbc_text
from shaftprint.files import written_whole
from shaftprint.recording.readers._extra import library
from shaftprint.recording.readers.can._beside import dbc_path
from shaftprint.recording.writers._bus_messages import Frame, Sent, first_time_s
from shaftprint.recording.writers._refused import told_as_refused

_KIND = "CAN log"
_NO_DATE = datetime(1970, 1, 1)  # noqa: DTZ001 - logs state no zone
# Times are cut off, not rounded, at the nanosecond.
_HALF_NANOSECOND = 5e-10


def write_bus_log(path: Path, sent: Sequence[Sent], *, began: datetime | None, overwrite: bool) -> tuple[str, ...]:
    """Write messages in the order of their times as BLF, ASC or candump, by the ending, and the DBC file beside it.

    Returns what the log does not hold, a sentence each. Raises RecordingError if python-can or canmatrix is not
    installed, or a file cannot be written.
    """
    can, canmatrix = library(path, "can", _KIND), library(path, "canmatrix", "DBC")
    first_s = first_time_s(sent)
    # a bus logger knows no time before its start
    later_s = float(max(math.ceil(-first_s), 0))
    remarks = []
    if later_s:
        remarks.append(f"Times begin {later_s:g} s later, since a log of a bus has none before second 0.")
    if path.suffix.lower() == ".log" and began is not None and first_s + later_s > 0.0:
        remarks.append(f"Second 0 is the first frame, {first_s + later_s:.6g} s later, as candump has dates alone.")
    merged = heapq.merge(*(one.frames() for one in sent))
    frames = ((time_s + later_s, identifier, data) for time_s, identifier, data in merged)
    with (
        told_as_refused(path),
        written_whole(dbc_path(path), overwrite=overwrite) as dbc,
        written_whole(path, overwrite=overwrite) as part,
    ):
        dbc.write_bytes(_dbc(canmatrix, sent))
        _WRITERS[path.suffix.lower()](can, part, frames, began)
    remarks.append(f"{dbc_path(path).name} beside it says what the frames hold; it is read with the log.")
    return tuple(remarks)


def _message(can: Any, time_s: float, identifier: int, data: bytes) -> Any:
    return can.Message(timestamp=time_s, arbitration_id=identifier, is_extended_id=True, data=data)


def _write_blf(can: Any, path: Path, frames: Iterator[Frame], began: datetime | None) -> None:
    with path.open("wb") as file, can.BLFWriter(file) as writer:
        # times of seconds since 1970 would lose what is below 240 ns: the date is stated at the end
        writer.start_timestamp = 0.0
        for time_s, identifier, data in frames:
            writer.on_message_received(_message(can, time_s + _HALF_NANOSECOND, identifier, data))
        if began is not None:
            # the library takes the date as one of UTC
            writer.start_timestamp = began.replace(tzinfo=UTC).timestamp()
            writer.stop_timestamp = writer.start_timestamp + (writer.stop_timestamp or 0.0)


def _write_asc(can: Any, path: Path, frames: Iterator[Frame], began: datetime | None) -> None:
    start = began or _NO_DATE
    text = start.ctime()
    date = f"{text[:19]}.{start.microsecond // 1000:03d}{text[19:]}"
    with path.open("w", encoding="ascii", newline="\n") as file, can.ASCWriter(file) as writer:
        # the library's own head states when the file was written, and its second 0 is the first frame
        file.seek(0)
        file.truncate()
        file.write(f"date {date}\nbase hex  timestamps absolute\ninternal events logged\nBegin Triggerblock {date}\n")
        writer.header_written = True
        writer.log_event("Start of measurement", 0.0)
        for time_s, identifier, data in frames:
            writer.on_message_received(_message(can, time_s, identifier, data))


def _write_candump(can: Any, path: Path, frames: Iterator[Frame], began: datetime | None) -> None:
    zero_s = 0.0 if began is None else began.replace(tzinfo=UTC).timestamp()
    with path.open("w", encoding="ascii", newline="\n") as file, can.CanutilsLogWriter(file, channel="can0") as writer:
        for time_s, identifier, data in frames:
            writer.on_message_received(_message(can, zero_s + time_s, identifier, data))


_WRITERS = {".blf": _write_blf, ".asc": _write_asc, ".log": _write_candump}


def _dbc(canmatrix: Any, sent: Sequence[Sent]) -> bytes:
    """Return a DBC file of messages."""
    matrix = canmatrix.CanMatrix()
    for one in sent:
        message, width = one.message, one.length
        identifier = canmatrix.ArbitrationId(message.identifier, extended=True)
        frame = canmatrix.Frame(message.name, arbitration_id=identifier, size=width)
        signals = (*message.signals, *(() if message.instance is None else (message.instance,)))
        for signal in signals:
            ends = (signal.lowest, signal.highest) if math.isfinite(signal.highest - signal.lowest) else (0.0, 0.0)
            written = canmatrix.Signal(
                signal.name,
                start_bit=signal.start,
                size=signal.bits,
                is_little_endian=True,
                is_signed=signal.is_signed,
                factor=Decimal(repr(signal.factor)),
                offset=Decimal(repr(signal.offset)),
                min=Decimal(repr(ends[0])),
                max=Decimal(repr(ends[1])),
                unit=dbc_text(signal.unit),
                comment=dbc_text(signal.comment),
            )
            for code, text in signal.texts.items():
                written.add_values(code, text)
            frame.add_signal(written)
        matrix.add_frame(frame)
    file = io.BytesIO()
    library(Path(), "canmatrix.formats", "DBC").dump(matrix, file, "dbc")
    return file.getvalue()
