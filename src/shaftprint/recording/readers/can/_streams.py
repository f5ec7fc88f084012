"""The frames of a log, each laid to those of its message, sender and instance, in a temporary file."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray
from shaftprint.recording._channel import Source
from shaftprint.recording._spool import Spool
from shaftprint.recording.readers.can._database import Database
from shaftprint.recording.readers.can._fast_packets import FastPackets
from shaftprint.recording.readers.can._frames import EXTENDED, FILL, FrameLog, Frames, pgn_of, sender_of
from shaftprint.recording.readers.can._messages import (
    Message,
    Selection,
    Signal,
    counts_of,
    numbers_of_counts,
    selected,
)
from shaftprint.recording.readers.can._validity import Tally, Validity

_WORD_BYTES = 8
# So many engines or gearboxes a ship has; more numbers are no instances.
_MOST_INSTANCES = 32
# A parameter group below this goes to one address.
_TO_ALL = 0xF000
_Content: TypeAlias = NDArray[np.uint8]


@dataclass(frozen=True, kw_only=True, slots=True)
class Origin:
    """Where messages come from."""

    bus: int
    """Number of the bus."""
    name: str
    """Name of the message."""
    sender: int | None
    """Source address of a message that any may send; None of others."""
    receiver: int | None
    """Address to which it goes, where it goes to one."""

    @property
    def label(self) -> str:
        """Message, sender and receiver in words."""
        of = "" if self.sender is None else f" of 0x{self.sender:x}"
        return f"{self.name}{of}{'' if self.receiver is None else f' to 0x{self.receiver:x}'}"


@dataclass(kw_only=True, slots=True, eq=False)
class Stream:
    """Messages of one origin and instance that hold the same signals, in order of their coming."""

    origin: Origin
    """Where they come from."""
    instance: int | None
    """Of which engine, gearbox or rudder; None where the message does not say it."""
    tallies: dict[Signal, Tally]
    """What is seen of each signal, and which of its counts are values."""
    columns: tuple[int, ...]
    """Columns of the temporary file: times, lengths, words of eight bytes."""
    count: int = 0
    """Number of messages."""


@dataclass(kw_only=True, slots=True, eq=False)
class Streams:
    """A log taken apart."""

    path: Path
    """The file, for messages."""
    log: FrameLog
    """Its frames."""
    database: Database
    """What they hold."""
    spool: Spool
    """The temporary file."""
    streams: dict[Any, Stream] = field(default_factory=dict)
    """What is known."""
    unknown: dict[tuple[int, int], int] = field(default_factory=dict)
    """Number of the other frames, by bus and identifier."""
    packets: FastPackets = field(default_factory=FastPackets)
    """Packets of several frames that are coming in."""

    def fill(self) -> None:
        """Go through the log."""
        for block in self.log.blocks:
            self._sort(block)
        self.packets.finish()
        self.spool.finish()

    def _sort(self, block: Frames) -> None:
        """Lay the frames of a block to those of the same bus and identifier."""
        key = block.bus.astype(np.uint64) << np.uint64(32) | block.identifier.astype(np.uint64)
        order = np.argsort(key, kind="stable")
        key = key[order]
        ends = [*(np.flatnonzero(np.diff(key)) + 1).tolist(), len(key)]
        start = 0
        for stop in ends if len(key) else ():
            bus, identifier = divmod(int(key[start]), 1 << 32)
            message = self.database.message(identifier)
            if message is None:
                self.unknown[bus, identifier] = self.unknown.get((bus, identifier), 0) + stop - start
            else:
                rows = order[start:stop]
                self._add(bus, identifier, message, block.time_s[rows], block.length[rows], block.content[rows])
            start = stop

    def _add(
        self,
        bus: int,
        identifier: int,
        message: Message,
        time_s: FloatArray,
        length: NDArray[Any],
        content: _Content,
    ) -> None:
        number = identifier & ~EXTENDED
        origin = _origin(bus, number, message)
        if message.is_fast:
            time_s, length, content = self.packets.add(origin, time_s, content)
        width = _WORD_BYTES * (message.last_byte // _WORD_BYTES + 1)
        if content.shape[1] < width:
            missing = np.full((len(content), width - content.shape[1]), FILL, dtype=np.uint8)
            content = np.concatenate([content, missing], axis=1)
        for instance, rows in _instances(message, content):
            for where in dict.fromkeys(signal.where for signal in message.signals if signal is not message.instance):
                chosen = rows & selected(where, content) if where else rows
                if chosen.any():
                    stream = self._stream(origin, number, message, instance, where, width)
                    self._append(stream, time_s[chosen], length[chosen], content[chosen])

    def _stream(
        self,
        origin: Origin,
        identifier: int,
        message: Message,
        instance: int | None,
        where: tuple[Selection, ...],
        width: int,
    ) -> Stream:
        key = (origin, instance, where)
        if key not in self.streams:
            signals = [one for one in message.signals if one.where == where and one is not message.instance]
            self.streams[key] = Stream(
                origin=origin,
                instance=instance,
                tallies={one: Tally(Validity(message=message, signal=one, identifier=identifier)) for one in signals},
                columns=tuple(self.spool.add_column(origin.label) for _ in range(2 + width // _WORD_BYTES)),
            )
        return self.streams[key]

    def _append(self, stream: Stream, time_s: FloatArray, length: NDArray[Any], content: _Content) -> None:
        times, lengths, *words = stream.columns
        stream.count += len(time_s)
        self.spool.append_column(times, time_s)
        self.spool.append_column(lengths, length.astype(np.float64))
        for number, column in enumerate(words):
            word = np.ascontiguousarray(content[:, _WORD_BYTES * number : _WORD_BYTES * (number + 1)])
            # the bytes as they are: the file holds eight of them for each value
            self.spool.append_column(column, word.view(np.float64)[:, 0])
        for signal, tally in stream.tallies.items():
            tally.add(numbers_of_counts(signal, counts_of(signal, content)), length <= signal.last_byte)

    def times(self, stream: Stream) -> Source:
        """Return what gives the times of messages [s]."""
        return self.spool.source(stream.columns[0])

    def values(self, stream: Stream, signal: Signal) -> Source:
        """Return what gives the values of a signal: not a number where there is none."""
        rule = stream.tallies[signal].rule
        _, lengths, *words = (self.spool.source(column) for column in stream.columns)

        def read(start: int, stop: int) -> FloatArray:
            content = np.stack([word(start, stop) for word in words], axis=1).view(np.uint8)
            numbers = numbers_of_counts(signal, counts_of(signal, content))
            values = rule.values(numbers)
            values[lengths(start, stop) <= signal.last_byte] = np.nan
            for _, which in rule.reasons(numbers):
                values[which] = np.nan
            return values

        return read


def _origin(bus: int, identifier: int, message: Message) -> Origin:
    is_open = message.is_of_any_sender
    to_one = is_open and pgn_of(identifier) & 0xFFFF < _TO_ALL
    return Origin(
        bus=bus,
        name=message.name,
        sender=sender_of(identifier) if is_open else None,
        receiver=identifier >> 8 & 0xFF if to_one else None,
    )


def _instances(message: Message, content: _Content) -> list[tuple[int | None, NDArray[np.bool_]]]:
    """Return each instance that messages are of, and which they are."""
    everything = np.ones(len(content), dtype=bool)
    if message.instance is None:
        return [(None, everything)]
    numbers = counts_of(message.instance, content)
    instances = np.unique(numbers)
    if instances.size > _MOST_INSTANCES:
        return [(None, everything)]
    return [(int(one), numbers == one) for one in instances]
