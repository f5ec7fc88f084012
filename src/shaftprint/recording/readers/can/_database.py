"""What a DBC or ARXML file says of the messages of a CAN bus."""

import io
import re
from collections.abc import Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from shaftprint.errors import RecordingError
from shaftprint.escape import printable
from shaftprint.recording.readers._damage import short_reason
from shaftprint.recording.readers._extra import library
from shaftprint.recording.readers._gather import reasons_in_words
from shaftprint.recording.readers._library_output import quiet
from shaftprint.recording.readers.can._frames import EXTENDED, is_j1939, is_nmea_2000, pgn_of, sender_of
from shaftprint.recording.readers.can._known import KNOWN
from shaftprint.recording.readers.can._messages import MOST_BYTES, Message, Selection, Signal
from shaftprint.spelling import meant_beside

# what the library prints where it leaves a line out
_LINE = re.compile(r"error with line no: (\d+)")
_INSTANCE = re.compile(r"instance(?:[ _]?(?:no|nr|number|id))?$", re.IGNORECASE)
# the address of nobody, under which DBC files state a message of any sender
_NO_SENDER = 0xFE
_FRAME_BYTES = 8
# Programs write [0|1] where nobody stated a range.
_WIDEST_OF_A_SWITCH = 7


@dataclass(frozen=True, kw_only=True, slots=True)
class Database:
    """Messages, to be looked up by identifiers."""

    name: str
    """File, for messages; empty of those that need none."""
    messages: tuple[Message, ...]
    """All of them."""
    left_out: Mapping[str, str] = field(default_factory=dict)
    """What of the file cannot be read, and why."""
    _by_identifier: dict[int, Message] = field(default_factory=dict)
    _by_group: dict[int, Message] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Sort the messages."""
        for message in self.messages:
            if message.is_of_any_sender:
                self._by_group.setdefault(pgn_of(message.identifier), message)
            if not message.is_of_any_sender or sender_of(message.identifier) != _NO_SENDER:
                self._by_identifier.setdefault(message.marked_identifier, message)

    def message(self, identifier: int) -> Message | None:
        """Return the message of an identifier, which has the mark of 29 bits; None of one that is not known."""
        message = self._by_identifier.get(identifier)
        if message is None and identifier & EXTENDED:
            return self._by_group.get(pgn_of(identifier & ~EXTENDED))
        return message


def known_messages() -> Database:
    """Return the messages that need no file."""
    return Database(name="", messages=KNOWN)


def read_database(path: Path) -> Database:
    """Read a DBC or ARXML file.

    Raises RecordingError if it is missing, no such file, or empty.
    """
    kind = "ARXML" if path.suffix.lower() == ".arxml" else "DBC"
    kind_in_words = "an ARXML" if kind == "ARXML" else "a DBC"
    if not path.is_file():
        raise RecordingError(f"{path}: expected {kind_in_words} file, found none there.{meant_beside(path)}")
    canmatrix = library(path, "canmatrix", kind)
    library(path, "canmatrix.formats", kind)
    try:
        with quiet() as said:
            content = path.read_bytes()
            without_id: dict[str, str] = {}
            if kind == "DBC":
                content, without_id = whole_messages(path.name, content)
            matrices = canmatrix.formats.load(io.BytesIO(content), kind.lower())
            buses = [matrix for matrix in matrices.values() if matrix is not None]
            messages = tuple(message for matrix in buses for message in _messages(matrix, is_dbc=kind == "DBC"))
    except Exception as error:
        raise RecordingError(
            f"{path}: expected {kind_in_words} file, found one that cannot be read ({printable(short_reason(error))})"
            f"{'; export it as DBC' if kind == 'ARXML' else ''}."
        ) from None
    signals_of = {(message.marked_identifier, signal.name) for message in messages for signal in message.signals}
    numbers = [int(number) for number in _LINE.findall(said.getvalue())]
    usable, unusable = [], without_id | lost_lines(path.name, content, numbers, signals_of)
    for message in messages:
        for signal in message.signals:
            if not signal.can_be_read:
                unusable[f"{message.name}.{signal.name}"] = (
                    "expected a multiplexer that says which messages hold it, found none that can be read."
                    if any(not selection.bits for selection in signal.where)
                    else f"expected a number of at most 64 bits within {MOST_BYTES} bytes, found other bits."
                )
        usable.append(replace(message, signals=tuple(signal for signal in message.signals if signal.can_be_read)))
    if not any(message.signals for message in usable):
        lost = reasons_in_words(unusable, most=3)
        raise RecordingError(
            f"{path}: expected {kind_in_words} file with messages and signals, found none in it"
            f"{f' ({lost})' if lost else ''}."
        )
    return Database(name=path.name, messages=tuple(usable), left_out=unusable)


def _messages(matrix: Any, *, is_dbc: bool) -> Iterator[Message]:
    is_all_j1939 = str(matrix.attributes.get("ProtocolType", "")).strip('"').lower() == "j1939"
    for frame in matrix.frames:
        identifier, is_extended = int(frame.arbitration_id.id), bool(frame.arbitration_id.extended)
        marked = is_extended and (
            frame.is_j1939
            or is_all_j1939
            or "J1939PG" in str(frame.attribute("VFrameFormat", db=matrix, default="") or "")
        )
        is_of_nobody = is_extended and is_j1939(identifier) and sender_of(identifier) == _NO_SENDER
        signals = tuple(_signal(frame, signal) for signal in frame.signals)
        yield Message(
            name=str(frame.name),
            signals=signals,
            identifier=identifier,
            is_extended=is_extended,
            is_j1939=marked,
            is_of_any_sender=marked or is_of_nobody,
            is_fast=is_extended and is_nmea_2000(identifier) and int(frame.size) > _FRAME_BYTES,
            instance=next(
                (one for one in signals if one.can_be_read and _INSTANCE.search(one.name) and not one.where), None
            ),
        )


def _signal(frame: Any, signal: Any) -> Signal:
    spn = str(signal.attributes.get("SPN", ""))
    lowest, highest = (float("nan") if end is None else float(end) for end in (signal.min, signal.max))
    bits = int(signal.size)
    is_range = lowest < highest and not ((lowest, highest) == (0.0, 1.0) and bits > _WIDEST_OF_A_SWITCH)
    return Signal(
        name=str(signal.name),
        start=int(signal.get_startbit(bit_numbering=1)),
        bits=bits,
        unit=str(signal.unit or ""),
        is_big_endian=not signal.is_little_endian,
        is_signed=bool(signal.is_signed),
        is_float=bool(signal.is_float),
        factor=float(signal.factor),
        offset=float(signal.offset),
        lowest=lowest if is_range else -float("inf"),
        highest=highest if is_range else float("inf"),
        spn=int(spn) if spn.isdecimal() and int(spn) else None,
        comment=str(signal.comment or "").strip(),
        texts={int(code): str(text) for code, text in signal.values.items()},
        where=tuple(_selections(frame, signal)),
    )


def _selections(frame: Any, signal: Any) -> Iterator[Selection]:
    """Yield the counts of multiplexers, one within the other, that select the messages of a signal."""
    seen: set[str] = set()
    while True:
        muxer, ranges = _multiplexer(frame, signal)
        if not ranges:
            return
        if muxer is None or muxer.name in seen:
            # a multiplexer that the file does not have: in which messages the signal is cannot be told
            yield Selection(start=0, bits=0)
            return
        seen.add(muxer.name)
        yield Selection(
            start=int(muxer.get_startbit(bit_numbering=1)),
            bits=int(muxer.size),
            is_big_endian=not muxer.is_little_endian,
            ranges=ranges,
        )
        signal = muxer


def _multiplexer(frame: Any, signal: Any) -> tuple[Any, tuple[tuple[int, int], ...]]:
    groups: Sequence[Sequence[int]] = signal.mux_val_grp or []
    if signal.muxer_for_signal and groups:
        return frame.signal_by_name(signal.muxer_for_signal), tuple((int(low), int(high)) for low, high in groups)
    value = signal.mux_val if getattr(signal, "mux_val", None) is not None else signal.multiplex
    if not isinstance(value, int) or isinstance(value, bool):
        return None, ()
    others = (one for one in frame.signals if one is not signal and one.multiplex == "Multiplexor")
    outer = [one for one in others if not one.muxer_for_signal]
    return (outer[0] if outer else None), ((value, value),)


_MESSAGE = re.compile(rb"\s*BO_ +(\d+) +(\S+?) *: *(\d+) +\S+")
_SIGNAL = re.compile(rb"\s*SG_\s+([^:]+?)\s*:")
_OF_SIGNAL = re.compile(rb"\s*(?:BA_|CM_|VAL_|SIG_VALTYPE_|SG_MUL_VAL_)\D*?\b(\d+)\s+(\w+)")
_OF_OTHERS = re.compile(rb"\s*(?:BA_|CM_|VAL_|SIG_VALTYPE_|SG_MUL_VAL_|BO_TX_BU_|SIG_GROUP_|EV_)")
# where CANdb++ keeps signals of no message
_NO_MESSAGE = b"VECTOR__INDEPENDENT_SIG_MSG"
_SHORT_BITS = 11


def whole_messages(name: str, content: bytes) -> tuple[bytes, dict[str, str]]:
    """Return a DBC file without the messages whose own line is wrong, and why each is missing.

    The library would give their signals to the message before them. Lines keep their numbers.

    ``name``: name of the file. ``content``: what it holds.
    """
    left_out: dict[str, str] = {}
    lines = content.splitlines()
    is_lost = False
    for row, line in enumerate(lines):
        begins = line.lstrip()
        if begins.startswith(b"BO_ "):
            message = _MESSAGE.match(line)
            is_lost = (
                message is None or 1 << _SHORT_BITS <= int(message[1]) < EXTENDED or int(message[1]) >= 2 * EXTENDED
            )
            if message is None:
                left_out[f"line {row + 1} of {name}"] = "the message cannot be read."
            elif message[2] == _NO_MESSAGE:
                is_lost = True
            elif is_lost:
                number = int(message[1])
                left_out[printable(message[2].decode("latin-1"))] = (
                    f"identifier {number} has more than {_SHORT_BITS} bits and lacks bit 31; write {number | EXTENDED} "
                    f"in line {row + 1} of {name}."
                )
        elif not begins.startswith(b"SG_ "):
            # signals follow their message without other lines between, but for empty ones
            is_lost = is_lost and not begins
        if is_lost:
            lines[row] = b""
    return b"\n".join(lines), left_out


def lost_lines(
    name: str, content: bytes, numbers: Sequence[int], signals: AbstractSet[tuple[int, str]]
) -> dict[str, str]:
    """Return why each line is left out that the library could not read.

    What is said of a message or signal that is missing is no loss of its own.

    ``name``, ``content``: the file. ``numbers``: which lines, counted from 1. ``signals``: identifier, as the file has
    it, and name of the signals that were read.
    """
    lines = content.splitlines()
    lost: dict[str, str] = {}
    for number in dict.fromkeys(numbers):
        line = lines[number - 1] if 0 < number <= len(lines) else b""
        signal, of_signal = _SIGNAL.match(line), _OF_SIGNAL.match(line)
        if signal is not None:
            lost[f"line {number} of {name}"] = f"{printable(signal[1].decode('latin-1'))} cannot be read."
        elif of_signal is not None and (int(of_signal[1]), of_signal[2].decode("latin-1")) in signals:
            lost[f"line {number} of {name}"] = f"what it says of {of_signal[2].decode('latin-1')} cannot be read."
        elif _OF_OTHERS.match(line) is None:
            lost[f"line {number} of {name}"] = "it cannot be read."
    return lost
