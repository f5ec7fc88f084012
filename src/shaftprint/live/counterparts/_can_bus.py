"""A counterpart on a CAN bus: listened to through a DBC file, and commanded only where the owner's file says so.

What a bus loses silently: frames of a queue that is full, for they have no numbers; everything while the controller is
off the bus; and which of two senders a message came from, where nobody looks. So every channel has its cycle, and one
that stays away is named; a bus on which none of them comes is silent, whatever else is on it.
"""

from __future__ import annotations

import asyncio
import contextlib
import math
import secrets
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import numpy as np

from shaftprint.errors import LiveError, SettingsError, SilentLinkError
from shaftprint.escape import printable
from shaftprint.live._block import Block, DeviceMode, DeviceStatus, LiveChannel
from shaftprint.live._counterpart import ANSWER_S, SILENT_S
from shaftprint.live.counterparts._access import Access
from shaftprint.live.counterparts._can_map import CanMap
from shaftprint.live.counterparts._dialect import MODES, latest_like
from shaftprint.live.counterparts._extra import library
from shaftprint.live.counterparts._words import WORDS, CommandedByWords
from shaftprint.recording.readers.can._database import Database, read_database
from shaftprint.recording.readers.can._frames import EXTENDED, pgn_of, sender_of
from shaftprint.recording.readers.can._messages import Message, Signal, counts_of, numbers_of_counts, selected
from shaftprint.recording.readers.can._validity import Validity
from shaftprint.settings import read_settings

# a channel is missed after so many of its cycles, at least half a second
_CYCLES: Final = 5.0
_MISSED_S: Final = 0.5
_MOST_FRAMES: Final = 100_000
_NUMBERS: Final = 200


@dataclass(kw_only=True, slots=True, eq=False)
class _Heard:
    """A signal that is listened to."""

    name: str
    message: Message
    signal: Signal
    sender: int | None
    cycle_s: float
    values: list[float] = field(default_factory=list)
    last_s: float
    invalid: int = 0


class CanCounterpart(CommandedByWords):
    """A bus that is listened to."""

    kind = "a CAN bus"

    def __init__(self, url: str, messages: str | Path, access: Access | None = None) -> None:
        """Take an address, ``can://INTERFACE/CHANNEL`` such as ``can://socketcan/can0``, and the map of messages in.

        Raises LiveError if the address is none, SettingsError if the map or its DBC file cannot be used.
        """
        scheme, _, rest = url.partition("://")
        interface, _, channel = rest.partition("/")
        if scheme != "can" or not interface or not channel:
            raise LiveError(f"expected an address such as can://socketcan/can0, found {printable(url)}.")
        path = Path(messages)
        self._map = read_settings(path, CanMap)
        database = read_database(path.parent / self._map.database)
        self._path, self._interface, self._at = path, interface, channel
        self._access = access or Access()
        self.name = f"can://{printable(interface)}/{printable(channel)}"
        self._heard = [
            self._listened(database, one.name, one.message, one.signal, one.cycle_s, one.sender)
            for one in self._map.channel
        ]
        self._status = self._table(database, self._map.status)
        self._sent = self._table(database, self._map.sending)
        self._beat_bits = min([one["heartbeat"].signal.bits for one in (self._sent, self._status) if one], default=64)
        self._by_identifier: dict[int, list[_Heard]] = {}
        self._bus: Any = None
        self._notifier: Any = None
        self._frames: list[Any] = []
        self._dropped = self._errors = 0
        self._counter = self._beat = 0
        self._number = secrets.randbelow(_NUMBERS)
        self._begin_s = self._last_s = 0.0

    @property
    def is_commanded(self) -> bool:
        """Whether the owner lets the program send."""
        return self._map.sending is not None

    @property
    def channels(self) -> tuple[LiveChannel, ...]:
        """Its channels."""
        return tuple(
            LiveChannel(
                name=one.name, unit=one.signal.unit, rate_hz=1.0 / one.cycle_s, long_name=printable(one.signal.comment)
            )
            for one in self._heard
        )

    async def connect(self) -> None:
        """Get on the bus; an adapter that can is told to acknowledge nothing where nothing is sent."""
        can = library("can", "a CAN bus")
        options = {} if self._map.bitrate is None else {"bitrate": self._map.bitrate}
        try:
            self._bus = can.Bus(interface=self._interface, channel=self._at, **options)
        except (can.CanError, OSError, ValueError, NotImplementedError) as error:
            raise LiveError(f"{self.name}: expected a CAN bus, found none ({printable(str(error))[:200]}).") from None
        self._begin_s = self._last_s = self.clock()
        for one in (*self._heard, *self._status.values()):
            one.last_s = self._begin_s
        self._notifier = can.Notifier(self._bus, [self._put], timeout=0.2, loop=asyncio.get_running_loop())

    async def read(self, timeout_s: float) -> Block:
        """Return the next block, with all frames that have come by its end."""
        end_s = self._begin_s + self._map.block_s
        wait_s = end_s - self.clock()
        await asyncio.sleep(max(0.0, min(wait_s, timeout_s)))
        if wait_s > timeout_s:
            raise SilentLinkError(f"{self.name}: expected a block within {timeout_s:g} s, found {wait_s:g} s to go.")
        findings = self._sort(end_s)
        begin_s, self._begin_s = self._begin_s, end_s
        if end_s - self._last_s > SILENT_S:
            raise SilentLinkError(
                f"{self.name}: expected messages with {', '.join(one.name for one in self._heard)}, found none of them "
                f"for {SILENT_S:g} s."
            )
        self._counter += 1
        samples = {one.name: np.array(one.values) for one in self._heard}
        for one in self._heard:
            one.values.clear()
        return Block(
            counter=self._counter,
            source_s=begin_s,
            span_s=self._map.block_s,
            samples=samples,
            device=self._device(),
            received_s=self.clock(),
            findings=findings,
        )

    async def beat(self, count: int) -> None:
        """Send the heartbeat."""
        self._beat = count
        self._send("", 0.0, 0.0)

    async def write(self, volts: float) -> None:
        """Write a set point [V of the campaign]."""
        await self._command("write", volts=volts)

    async def close(self) -> None:
        """Get off the bus."""
        with contextlib.suppress(Exception):
            if self._notifier is not None:
                self._notifier.stop(timeout=0.5)
        with contextlib.suppress(Exception):
            if self._bus is not None:
                self._bus.shutdown()
        self._bus = self._notifier = None

    # ---- what comes ----

    def _put(self, frame: Any) -> None:
        if frame.is_error_frame:
            self._errors += 1
        elif len(self._frames) < _MOST_FRAMES:
            self._frames.append(frame)
        else:
            self._dropped += 1

    def _sort(self, end_s: float) -> tuple[str, ...]:
        """Lay the frames that have come to their signals; return what there is to say."""
        self._answers()
        findings = []
        for one in self._heard:
            away_s = end_s - one.last_s
            if away_s > max(_MISSED_S, _CYCLES * one.cycle_s):
                findings.append(f"{one.name}: no message for {away_s:.1f} s.")
            if one.invalid:
                findings.append(f"{one.name}: {one.invalid} messages without a value.")
                one.invalid = 0
        if self._errors or self._dropped:
            findings.append(f"{self._errors} error frames on the bus, {self._dropped} frames dropped.")
            self._errors = self._dropped = 0
        return tuple(findings)

    def _answers(self) -> None:
        frames, self._frames = self._frames, []
        for frame in frames:
            marked = frame.arbitration_id | (EXTENDED if frame.is_extended_id else 0)
            if marked not in self._by_identifier:
                if len(self._by_identifier) > _MOST_FRAMES:
                    self._by_identifier.clear()
                self._by_identifier[marked] = [
                    one for one in (*self._heard, *self._status.values()) if _is_of(one, marked)
                ]
            for one in self._by_identifier[marked]:
                self._take_in(one, marked, frame)

    def _take_in(self, one: _Heard, marked: int, frame: Any) -> None:
        content = np.full((1, max(8, one.message.last_byte + 1)), 0xFF, dtype=np.uint8)
        data = bytes(frame.data)[: content.shape[1]]
        content[0, : len(data)] = np.frombuffer(data, np.uint8)
        if one.signal.where and not selected(one.signal.where, content)[0]:
            return
        one.last_s = self.clock()
        if one.name:
            self._last_s = one.last_s
        rule = Validity(message=one.message, signal=one.signal, identifier=marked & ~EXTENDED)
        numbers = numbers_of_counts(one.signal, counts_of(one.signal, content))
        if len(data) <= one.signal.last_byte or any(which[0] for _, which in rule.reasons(numbers)):
            one.invalid += 1
            one.values.append(float("nan"))
            return
        one.values.append(float(rule.values(numbers)[0]))

    def _device(self) -> DeviceStatus:
        if not self._status:
            return DeviceStatus(mode=DeviceMode.LEVER, heartbeat=0, set_point_v=float("nan"), is_enabled=False)
        last = {name: one.values[-1] if one.values else float("nan") for name, one in self._status.items()}
        for one in self._status.values():
            del one.values[:-1]
        mode = last["mode"]
        return DeviceStatus(
            mode=MODES[int(mode)] if 0 <= mode < len(MODES) else DeviceMode.LEVER,
            heartbeat=latest_like(self._beat, int(np.nan_to_num(last["heartbeat"])), self._beat_bits),
            set_point_v=last["set_point"],
            is_enabled=last["enabled"] == 1.0,
        )

    # ---- what goes out ----

    async def _command(self, word: str, *, ramp_s: float = 0.0, volts: float = 0.0) -> None:
        # behind the last that was answered, perhaps to somebody else
        self._answers()
        answered = self._last("answer") if self._sent else math.nan
        self._number = (self._number if math.isnan(answered) else int(answered)) % _NUMBERS + 1
        self._send(word, volts, ramp_s)
        until_s = self.clock() + ANSWER_S
        while self._last("answer") != self._number:
            if self.clock() > until_s:
                raise SilentLinkError(f'{self.name}: expected an answer to "{word}" within {ANSWER_S:g} s.')
            await asyncio.sleep(0.005)
            self._answers()
        self._expect_obeyed(word, self._last("refused"))

    def _last(self, name: str) -> float:
        values = self._status[name].values
        return values[-1] if values else float("nan")

    def _send(self, word: str, volts: float, ramp_s: float) -> None:
        """Send the message of commands; without the owner's word nothing goes out."""
        if self._map.sending is None or not self._sent:
            raise LiveError(
                f"{self.name}: expected [sending] of the owner in {self._path}, found none; the bus is listened to."
            )
        self._access.expect_writer(self.name, is_encrypted=False)
        message = next(iter(self._sent.values())).message
        values: dict[str, float] = {
            "heartbeat": self._beat % (1 << self._sent["heartbeat"].signal.bits),
            "number": self._number,
        }
        values |= {"word": WORDS.get(word, 0), "set_point": volts, "ramp": ramp_s}
        data = 0
        for name, value in values.items():
            data |= _counted(self._sent[name].signal, value)
        can = library("can", "a CAN bus")
        frame = can.Message(
            arbitration_id=message.identifier, is_extended_id=message.is_extended, data=data.to_bytes(8, "little")
        )
        try:
            self._bus.send(frame, timeout=0.2)
        except (can.CanError, AttributeError) as error:
            raise SilentLinkError(f"{self.name}: expected to send, found {printable(str(error))[:200]}.") from None

    # ---- the file ----

    def _table(self, database: Database, table: Any) -> dict[str, _Heard]:
        if table is None:
            return {}
        names = [name for name in type(table).model_fields if name not in ("message", "is_allowed")]
        return {name: self._listened(database, "", table.message, getattr(table, name), 1.0, None) for name in names}

    def _listened(
        self, database: Database, name: str, message_name: str, signal_name: str, cycle_s: float, sender: int | None
    ) -> _Heard:
        for message in database.messages:
            for signal in message.signals:
                if (message.name, signal.name) == (message_name, signal_name):
                    return _Heard(name=name, message=message, signal=signal, sender=sender, cycle_s=cycle_s, last_s=0.0)
        raise SettingsError(
            f"{self._path}: expected {message_name}.{signal_name} in {database.name}, found none of this name."
        )


def _is_of(one: _Heard, marked: int) -> bool:
    """Return whether frames of an identifier hold a signal."""
    message = one.message
    if message.is_of_any_sender:
        is_it = bool(marked & EXTENDED) and pgn_of(marked & ~EXTENDED) == pgn_of(message.identifier)
    else:
        is_it = marked == message.marked_identifier
    return is_it and (one.sender is None or sender_of(marked & ~EXTENDED) == one.sender)


def _counted(signal: Signal, value: float) -> int:
    """Return the bits of a value at their place; raise LiveError where it does not fit."""
    count = round((value - signal.offset) / signal.factor)
    lowest = -(1 << signal.bits - 1) if signal.is_signed else 0
    if signal.is_big_endian or signal.is_float or signal.last_byte > 7:
        raise LiveError(f"{signal.name}: expected a whole number of Intel order in 8 bytes to send, found another.")
    if not lowest <= count < lowest + (1 << signal.bits):
        raise LiveError(f"{signal.name}: expected a value of {signal.bits} bits, found {value:g}.")
    return (count & (1 << signal.bits) - 1) << signal.first_bit
