"""ASAM MDF 3 and 4 files: channel groups, each with a master channel of times."""

import contextlib
import re
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from functools import partial
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray
from shaftprint.errors import RecordingError
from shaftprint.recording._channel import Channel
from shaftprint.recording._recording import Recording
from shaftprint.recording.readers._bus_logging import (
    BusSignal,
    bus_signals,
    is_bus_logging,
    message_of,
    signal_of,
    taken_apart,
)
from shaftprint.recording.readers._clock import SampleClock, clock_of_times, on_clock
from shaftprint.recording.readers._damage import expect_plausible, told_as_damage
from shaftprint.recording.readers._extra import library
from shaftprint.recording.readers._gather import Gathered, unique_names
from shaftprint.recording.readers._hints import rate_hint
from shaftprint.recording.readers._mdf_records import MdfRecords, expect_in_record
from shaftprint.recording.readers._opened import Opened
from shaftprint.units import plain_unit

NAME = "MDF"

_VERSION = re.compile(rb"[234]\.\d[\d \0]")
_SIGNATURES = (b"MDF     ", b"UnFinMF ")
# ASAM MDF 4.1, block CN: type of a channel and of what a master counts; block CC: type of a conversion.
_MASTERS = (2, 3)
_TIME = 1
_LINEAR = 1
_FIRST_TEXT_CONVERSION = 7


def is_mine(path: Path) -> bool:
    """Return whether the file begins as a measurement data file, finished or not."""
    with path.open("rb") as file:
        return file.read(8) in _SIGNATURES


def read(path: Path, **hints: object) -> Recording:
    """Open an MDF file; samples are read and converted as channels are asked for them.

    Samples that the file marks as invalid become values that are not numbers. Hints: ``sample_rate_hz`` for groups
    without times; ``dbc``, the DBC file that says what the raw messages of a CAN bus hold.

    Raises
    ------
    RecordingError
        If the file is damaged or no channel can be used.
    """
    rate = rate_hint(path, hints, {"dbc": (str, Path)})
    dbc = None if hints.get("dbc") is None else Path(str(hints["dbc"]))
    signals, unread = ({}, {}) if dbc is None else bus_signals(dbc)
    asammdf = library(path, "asammdf", NAME)
    _close_in_silence(asammdf)
    _expect_version(path)
    handle = path.open("rb")
    try:
        with told_as_damage(path, NAME):
            file = asammdf.MDF(handle, process_bus_logging=dbc is not None)
    except BaseException:
        handle.close()
        raise
    files = [file]
    opened = Opened(path, partial(_close, files, handle))
    try:
        with told_as_damage(path, NAME):
            if dbc is not None:
                files.append(taken_apart(path, file, dbc))
            gathered = _gather(path, files, opened, rate, signals)
            gathered.left_out.update(unread)
            began = file.start_time
            is_dated = isinstance(began, datetime) and began.year > 1970
            return gathered.recording(f"{NAME} {file.version}", opened.close, began if is_dated else None)
    except BaseException:
        opened.close()
        raise


def _close(files: list[Any], handle: BinaryIO) -> None:
    for file in files:
        file.close()
    handle.close()


def _expect_version(path: Path) -> None:
    """Refuse a file whose version cannot be read, which the library would leave open."""
    with path.open("rb") as file:
        version = file.read(12)[8:]
    if not _VERSION.fullmatch(version):
        raise RecordingError(
            f"{path}: expected a version such as 4.10 in the MDF file, found {version!r}; it is damaged, copy it again "
            "from the logger."
        )


def _close_in_silence(asammdf: Any) -> None:
    """Let what the library leaves of a file that it failed to open be cleaned up without a word."""

    def close(file: Any) -> None:
        with contextlib.suppress(Exception):
            file.close()

    for kind in (asammdf.blocks.mdf_v4.MDF4, asammdf.blocks.mdf_v3.MDF3):
        kind.__del__ = close


@dataclass(frozen=True, kw_only=True, slots=True)
class _Place:
    """Where a channel stands: in the file itself, or in what was taken out of its raw messages."""

    file: Any
    records: MdfRecords
    group: int
    index: int

    @property
    def described(self) -> Any:
        return self.file.groups[self.group].channels[self.index]

    @property
    def label(self) -> str:
        """Name of the group."""
        return message_of(self.file.groups[self.group]) or f"group {self.group}"


def _gather(
    path: Path, files: list[Any], opened: Opened, rate_hz: float | None, signals: Mapping[str, BusSignal]
) -> Gathered:
    gathered = Gathered(path=path)
    raw = [group for group, described in enumerate(files[0].groups) if is_bus_logging(described)]
    if not signals:
        for group in raw:
            gathered.left_out[f"group {group}"] = (
                "raw messages of a bus; give the DBC file that says what they hold, dbc= (--dbc of shaftprint convert)."
            )
    places = [place for place in _places(files[0]) if place.group not in raw]
    places += [place for file in files[1:] for place in _places(file)]
    names = unique_names([(place.label, place.described.name) for place in places])
    clocks: dict[tuple[int, int], SampleClock | RecordingError] = {}
    for place, name in zip(places, names, strict=True):
        key = (id(place.file), place.group)
        if key not in clocks:
            try:
                clocks[key] = _clock(path, place.file, place.group, rate_hz)
            except RecordingError as error:
                clocks[key] = error

        def make(place: _Place = place, name: str = name, key: tuple[int, int] = key) -> Channel:
            clock = clocks[key]
            if isinstance(clock, RecordingError):
                raise clock
            return _channel(path, place, opened, name, clock, signal_of(place.described, signals))

        gathered.add(name, make)
    return gathered


def _places(file: Any) -> list[_Place]:
    records = MdfRecords(file)
    return [
        _Place(file=file, records=records, group=group, index=index)
        for group, channel_group in enumerate(file.groups)
        for index, channel in enumerate(channel_group.channels)
        if file.masters_db.get(group) != index and int(channel.channel_type) not in _MASTERS
    ]


def _count(path: Path, file: Any, group: int) -> int:
    described = file.groups[group].channel_group
    count, width = int(described.cycles_nr), int(getattr(described, "samples_byte_nr", 1))
    size = path.stat().st_size
    expect_plausible(path, f"group {group}", samples=count, sample_bytes=max(width, 1), stored_bytes=size)
    return count


def _clock(path: Path, file: Any, group: int, rate_hz: float | None) -> SampleClock:
    """Take the clock of the group's master, which must count seconds, else the hint."""
    count = _count(path, file, group)
    master = file.masters_db.get(group)
    if master is None:
        if rate_hz is None:
            raise RecordingError(f"{path}: expected a master channel of times, found none; give the sample rate.")
        return SampleClock(rate_hz=rate_hz, start_s=0.0)
    channel = file.groups[group].channels[master]
    expect_in_record(path, f"master {channel.name}", file.groups[group].channel_group, channel)
    if int(getattr(channel, "sync_type", _TIME)) != _TIME:
        raise RecordingError(f"{path}: expected a master channel of times, found one of angles, distances or numbers.")

    def read(start: int, stop: int) -> FloatArray:
        times = file.get_master(group, record_offset=start, record_count=stop - start)
        return np.asarray(times, dtype=np.float64)

    with told_as_damage(path, NAME):
        return clock_of_times(path, f"master {channel.name}", count, read)


def _channel(
    path: Path, place: _Place, opened: Opened, name: str, clock: SampleClock, signal: BusSignal | None
) -> Channel:
    file, records, group, index = place.file, place.records, place.group, place.index
    described = place.described
    count = _count(path, file, group)
    expect_in_record(path, name, file.groups[group].channel_group, described)
    conversion = described.conversion
    kind = -1 if conversion is None else int(conversion.conversion_type)
    scale, offset = 1.0, 0.0
    first, invalid = records.samples(group, index, 0, min(count, 2), raw=True)
    if first.ndim != 1 or first.dtype.kind not in "fiu":
        raise RecordingError(f"{path}, channel {name}: expected one real number a sample, found {_shape(first)}.")
    is_counts = (
        first.dtype == np.int16 and invalid is None and signal is None and (conversion is None or kind == _LINEAR)
    )
    if is_counts and conversion is not None and _is_v4(file):
        scale, offset = float(conversion.a), float(conversion.b)
        is_counts = scale != 0.0 and bool(np.isfinite([scale, offset]).all())
        scale, offset = (scale, offset) if is_counts else (1.0, 0.0)
    elif conversion is not None:
        is_counts = False
    raw = is_counts or (_is_v4(file) and kind >= _FIRST_TEXT_CONVERSION)

    def source(start: int, stop: int) -> NDArray[Any]:
        with opened.reading(name), told_as_damage(path, NAME):
            values, invalid = records.samples(group, index, start, stop, raw=raw)
            if len(values) != stop - start:
                raise RecordingError(f"{path}, channel {name}: samples [{start}, {stop}) are missing; is the file cut?")
            if is_counts:
                return np.ascontiguousarray(values, dtype=np.int16)
            # a copy into a new array: the library's type of numbers carries the conversion, and would apply it again
            numbers = np.empty(len(values))
            numbers[:] = values
            if invalid is not None:
                numbers[np.asarray(invalid, dtype=bool)] = np.nan
            if signal is not None:
                numbers[(numbers < signal.lowest) | (numbers > signal.highest)] = np.nan
            return numbers

    source(0, min(count, 2))
    channel = Channel(
        name=name,
        unit=plain_unit(_unit(described)),
        rate_hz=clock.rate_hz,
        start_s=clock.start_s,
        count=count,
        source=source,
        scale=scale,
        offset=offset,
        long_name=_long_name(described, signal),
    )
    return on_clock(channel, clock)


def _long_name(described: Any, signal: BusSignal | None) -> str:
    if signal is None or signal.spn is None:
        return str(getattr(described, "comment", "") or "")[:200]
    return f"SPN {signal.spn}{': ' if signal.comment else ''}{signal.comment}"[:200]


def _is_v4(file: Any) -> bool:
    return str(file.version) >= "4"


def _unit(described: Any) -> str:
    unit = getattr(described, "unit", "") or getattr(described.conversion, "unit", "") or ""
    return unit.decode("latin-1").strip(" \0") if isinstance(unit, bytes) else str(unit).strip()


def _shape(values: NDArray[Any]) -> str:
    return f"{values.dtype.kind if values.dtype.names is None else 'a structure'} of shape {values.shape[1:]} a sample"
