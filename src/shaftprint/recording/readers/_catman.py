"""Binary files of HBM catman (.bin): channels one behind the other, each with date and step in its extended header.

Source: catmanBinaryFormat.xls and catman_read.m of HBM. The package apread is not used: it takes days since 30 December
1899 for seconds since 1970, finds the times of a channel by their number alone, and asks on the terminal where two fit.
"""

import re
import struct
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from datetime import datetime, timedelta
from functools import partial
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import RecordingError
from shaftprint.files import kept_open
from shaftprint.recording._channel import Channel
from shaftprint.recording._recording import Recording
from shaftprint.recording.readers._clock import SampleClock, clock_of_times, kept_clocks, on_clock
from shaftprint.recording.readers._damage import told_as_damage
from shaftprint.recording.readers._gather import Gathered, unique_names
from shaftprint.recording.readers._hints import expect_hints
from shaftprint.recording.readers._opened import Opened
from shaftprint.recording.readers._units import seconds_in
from shaftprint.units import plain_unit

NAME = "catman"

_VERSIONS = (5010, 5011, 5012)
_RESERVED_FROM, _SENSORS_FROM, _RESERVED = 5011, 5012, 32
_BEGIN, _LONGEST_HEAD = 6, 2**26
# Places in the extended header: date of the start [days], step [ms]; how the samples are stored.
_OF_CLOCK, _FORM = 16, 140
_FORMS, _COUNTS, _FULL_SCALE = {0: "<f8", 1: "<f4", 2: "<u2"}, 2, 32_767.0
_NUMBERS = 0
# what catman stores for an amplifier that is overdriven or has no sensor
_OVERFLOW = -1e6
_ZERO = datetime(1899, 12, 30)  # noqa: DTZ001 - the file says no zone
_TIMES = re.compile(r"(?:time|zeit|temps|tempo|tiempo)\b", re.IGNORECASE)
_RATE_AGREEMENT, _ROUNDING = 1e-3, 0.5


def is_mine(path: Path) -> bool:
    """Return whether the file begins with a version and a place of the data that lies in it."""
    with path.open("rb") as file:
        begin = file.read(_BEGIN)
    if len(begin) < _BEGIN:
        return False
    version, place = struct.unpack("<hi", begin)
    return version in _VERSIONS and _BEGIN < place < path.stat().st_size


def read(path: Path, **hints: object) -> Recording:
    """Open a catman file; samples are read as channels are asked for them.

    Raises RecordingError if the file is damaged, or no channel can be used.
    """
    expect_hints(path, hints, {})
    file = path.open("rb")
    with kept_open(Opened(path, file.close)) as opened, told_as_damage(path, NAME):
        stored = _stored(file, path.stat().st_size)
        return _Source(path=path, file=file, opened=opened, stored=stored).recording()


@dataclass(frozen=True, kw_only=True, slots=True)
class _Stored:
    """One channel as the file describes it."""

    name: str
    unit: str
    comment: str
    count: int
    kind: int
    """0 for numbers, others for texts and objects."""
    form: int
    """How its numbers are stored."""
    began: datetime | None
    """Date of its start by the computer's clock."""
    step_s: float
    """From one sample to the next [s]; 0 where the file does not say."""
    begin: int
    """Where its samples begin in the file [bytes]."""

    @property
    def is_of_times(self) -> bool:
        """Whether it holds the times of others."""
        return self.kind == _NUMBERS and bool(_TIMES.match(self.name)) and seconds_in(self.unit) is not None


class _Head:
    """The head of a file, read from its beginning on."""

    def __init__(self, content: bytes) -> None:
        self.content, self.place = content, 0

    def number(self, kind: str) -> Any:
        """Return the next number of a type."""
        (number,) = struct.unpack_from(f"<{kind}", self.content, self.place)
        self.place += struct.calcsize(f"<{kind}")
        return number

    def piece(self, kind: str = "h") -> bytes:
        """Return the next piece, before which its length stands as a number of a type."""
        length = self.number(kind)
        if not 0 <= length <= len(self.content) - self.place:
            raise ValueError(f"a piece of {length} bytes ends beyond the head")
        self.place += length
        return self.content[self.place - length : self.place]

    def text(self) -> str:
        """Return the next text."""
        return self.piece().decode("cp1252", "replace").strip(" \0")


def _stored(file: BinaryIO, size: int) -> list[_Stored]:
    """Return the channels of a file; a ``ValueError`` where it contradicts itself."""
    _, data = struct.unpack("<hi", file.read(_BEGIN))
    file.seek(0)
    head = _Head(file.read(min(data, _LONGEST_HEAD)))
    version = head.number("h")
    head.number("i")
    head.piece()
    for _ in range(_RESERVED if version >= _RESERVED_FROM else 0):
        head.piece()
    count, longest = head.number("h"), head.number("i")
    places = [head.number("i") for _ in range(count)]
    if longest or head.number("i"):
        raise ValueError("it is in the form for appending or compressed, which is not read; export it again")
    channels, begin = [], data
    for place in places:
        # it stands behind the number of the channel
        if place - head.place not in (0, 2):
            raise ValueError(f"a channel begins at byte {head.place} and not at {place}, as the file says")
        channel, length = _channel(head, version, begin)
        channels.append(channel)
        begin += length
    if begin > size:
        raise ValueError(f"it has {size} of {begin} bytes")
    return channels


def _channel(head: _Head, version: int, begin: int) -> tuple[_Stored, int]:
    """Return the next channel, whose samples begin at a place, and their length [bytes]."""
    head.number("h")
    count, name, unit, comment = head.number("i"), head.text(), head.text(), head.text()
    kind, width = head.number("h"), head.number("h")
    head.number("d")
    more = head.piece("i")
    days, step_ms = struct.unpack_from("<dd", more) if len(more) >= _OF_CLOCK else (0.0, 0.0)
    form = more[_FORM] if len(more) > _FORM else 0
    head.place += 2
    points = head.number("B")
    head.place += 8 * points + 2
    head.piece()
    if version >= _SENSORS_FROM:
        head.piece("i")
    if count < 0 or (kind == _NUMBERS and form not in _FORMS):
        raise ValueError(f"channel {name} is said to have {count} samples of form {form}")
    width = np.dtype(_FORMS[form]).itemsize if kind == _NUMBERS else width
    before = 16 if kind == _NUMBERS and form == _COUNTS else 0
    stored = _Stored(
        name=name,
        unit=unit,
        comment=comment,
        count=count,
        kind=kind,
        form=form,
        began=_ZERO + timedelta(days=days) if days > 1.0 else None,
        step_s=1e-3 * step_ms if np.isfinite(step_ms) else 0.0,
        begin=begin + before,
    )
    return stored, before + count * width


@dataclass(frozen=True, kw_only=True, slots=True)
class _Source:
    """A file while its channels are gathered."""

    path: Path
    file: BinaryIO
    opened: Opened
    stored: Sequence[_Stored]

    def recording(self) -> Recording:
        """Return the recording of all channels."""
        signals = [one for one in self.stored if not one.is_of_times]
        names = unique_names([("catman", one.name) for one in signals])
        began = min((one.began for one in signals if one.began is not None), default=None)
        clock_of = kept_clocks(self._clock_of_times)
        gathered = Gathered(path=self.path)
        for one, name in zip(signals, names, strict=True):
            gathered.add(name, partial(self._channel, one, name, began, clock_of))
        return gathered.recording(NAME, self.opened.close, began)

    def _channel(
        self, one: _Stored, name: str, began: datetime | None, clock_of: Callable[[_Stored], SampleClock]
    ) -> Channel:
        if one.kind != _NUMBERS or one.count == 0:
            raise RecordingError(f"expected numbers, found {'none' if one.kind == _NUMBERS else 'texts or objects'}")
        later_s = 0.0 if began is None or one.began is None else (one.began - began).total_seconds()
        clock = self._clock(one, clock_of).later_by(later_s)
        channel = Channel(
            name=name,
            unit=plain_unit(one.unit),
            rate_hz=clock.rate_hz,
            start_s=clock.start_s,
            count=one.count,
            source=self._reader(one),
            long_name=one.comment,
        )
        return on_clock(channel, clock)

    def _clock(self, one: _Stored, clock_of: Callable[[_Stored], SampleClock]) -> SampleClock:
        """Take the channel of times that has the step of the channel, else the step."""
        rate_hz = float(f"{1.0 / one.step_s:.9g}") if one.step_s > 0.0 else None
        for times in (times for times in self.stored if times.is_of_times and times.count == one.count):
            clock = clock_of(times)
            if rate_hz is None:
                return clock
            if abs(clock.rate_hz / rate_hz - 1.0) <= _RATE_AGREEMENT:
                is_rounded = abs(clock.rate_hz / rate_hz - 1.0) * one.count < _ROUNDING and not clock.is_uneven
                return replace(clock, rate_hz=rate_hz) if is_rounded else clock
        if rate_hz is None:
            raise RecordingError("expected a step or a channel of times of its length, found neither")
        return SampleClock(rate_hz=rate_hz, start_s=0.0)

    def _clock_of_times(self, times: _Stored) -> SampleClock:
        read, second = self._reader(times), seconds_in(times.unit) or 1.0
        return clock_of_times(
            self.path, f"channel {times.name}", times.count, lambda start, stop: second * read(start, stop)
        )

    def _reader(self, one: _Stored) -> Callable[[int, int], FloatArray]:
        """Return what reads the samples of a channel; whole numbers go from its lowest value to its highest."""
        dtype, low, step = np.dtype(_FORMS[one.form]), 0.0, 1.0
        if one.form == _COUNTS:
            self.file.seek(one.begin - 16)
            low, high = struct.unpack("<dd", self.file.read(16))
            step = (high - low) / _FULL_SCALE

        def read(start: int, stop: int) -> FloatArray:
            length = (stop - start) * dtype.itemsize
            with self.opened.reading(one.name):
                self.file.seek(one.begin + start * dtype.itemsize)
                content = self.file.read(length)
            if len(content) != length:
                raise RecordingError(f"{self.path}, channel {one.name}: samples are missing; is the file cut?")
            values = low + step * np.frombuffer(content, dtype=dtype).astype(np.float64)
            return np.where(values == _OVERFLOW, np.nan, values)

        return read
