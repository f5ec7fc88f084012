"""ASAM MDF 3 and 4 files: channel groups, each with a master channel of times."""

import contextlib
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import datetime
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray
from shaftprint.errors import RecordingError
from shaftprint.files import kept_open
from shaftprint.recording._channel import Channel
from shaftprint.recording._recording import Recording
from shaftprint.recording.readers._clock import SampleClock, clock_of_times, kept_clocks, on_clock, rows_between_cuts
from shaftprint.recording.readers._damage import expect_plausible, told_as_damage
from shaftprint.recording.readers._epoch import UNDATED_YEAR
from shaftprint.recording.readers._extra import library
from shaftprint.recording.readers._gather import Gathered, unique_names
from shaftprint.recording.readers._hints import rate_hint
from shaftprint.recording.readers._library_output import quiet, remarks
from shaftprint.recording.readers._mdf_frames import frames_of, holds_frames, holds_no_values, is_bus_logging
from shaftprint.recording.readers._mdf_records import MdfRecords, expect_in_record
from shaftprint.recording.readers._mdf_unfinished import FINISHED_HERE, bytes_to_read
from shaftprint.recording.readers._mdf_values import by_formula, is_worked_out_here, numbers_of, unit_of
from shaftprint.recording.readers._opened import Opened
from shaftprint.recording.readers.can._beside import Chosen, chosen_database
from shaftprint.recording.readers.can._channels import Decoded, decoded
from shaftprint.recording.readers.can._log import add_signals, expect_known
from shaftprint.units import plain_unit

NAME = "MDF"

_VERSION = re.compile(rb"[234]\.\d[\d \0]")
_SIGNATURES = (b"MDF     ", b"UnFinMF ")
# ASAM MDF 4.1, block CN: type of a channel and of what a master counts; block CC: type of a conversion.
_MASTERS = (2, 3)
_TIME = 1
_LINEAR = 1
_ALL_INVALID, _HAS_INVALIDATION_BITS = 1, 2
_UNDATED_TOO = datetime(1980, 1, 1)  # noqa: DTZ001 - the file has no zone
# MDF 3, block CC: tables of texts
_TEXTS_OF_MDF_3 = (11, 12)
_AT_CUTS = "A sample between two steps of the clock, as a program makes it at either end of a cut, was left out."


def is_mine(path: Path) -> bool:
    """Return whether the file begins as a measurement data file, finished or not."""
    with path.open("rb") as file:
        return file.read(8) in _SIGNATURES


def read(path: Path, **hints: object) -> Recording:
    """Open an MDF file; samples are read and converted as channels are asked for them.

    Samples that the file marks as invalid become values that are not numbers. Hints: ``sample_rate_hz`` for groups
    without times; ``dbc``, the DBC file that says what the raw messages of a CAN bus hold.

    Raises RecordingError if the file is damaged or no channel can be used.
    """
    rate = rate_hint(path, hints, {"dbc": (str, Path)})
    asammdf = library(path, "asammdf", NAME)
    _close_in_silence(asammdf)
    _expect_version(path)
    handle, is_finished_here = bytes_to_read(path)
    with kept_open(handle), told_as_damage(path, NAME) as said:
        file = asammdf.MDF(handle, process_bus_logging=False)
    closing = contextlib.ExitStack()
    closing.callback(handle.close)
    closing.callback(_close, file)
    with kept_open(Opened(path, closing.close)) as opened, told_as_damage(path, NAME):
        gathered, words = _gather(path, file, opened, rate, hints, closing)
        gathered.left_out.update(remarks(said, "asammdf"))
        gathered.remarks.extend([FINISHED_HERE] * is_finished_here)
        format = f"{NAME} {file.version}{words}"
        return gathered.recording_from_its_zero(format, opened.close, _date(file))


def _date(file: Any) -> datetime | None:
    """Return the date of second 0; None where the head has none.

    Before version 3.20 the head has a date and a time of the place alone; the library takes them for those of this
    computer. What stands there where a writer was given none is the first moment of 1970 or 1980.
    """
    date = file.start_time
    if not isinstance(date, datetime) or date.year <= UNDATED_YEAR or date.replace(tzinfo=None) == _UNDATED_TOO:
        return None
    if _is_v4(file) or int(getattr(file.header, "abs_time", None) or 0):
        return date
    return date.astimezone().replace(tzinfo=None)


def _close(file: Any) -> None:
    with quiet():
        file.close()


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
    """Where a channel stands."""

    file: Any
    records: MdfRecords
    group: int
    index: int

    @property
    def described(self) -> Any:
        return self.file.groups[self.group].channels[self.index]


def _gather(
    path: Path,
    file: Any,
    opened: Opened,
    rate_hz: float | None,
    hints: Mapping[str, object],
    closing: contextlib.ExitStack,
) -> tuple[Gathered, str]:
    """Return the channels, and what the name of the format says of the messages of a bus."""
    records = MdfRecords(file)
    chosen = chosen_database(path, hints, lambda: frames_of(file, records))
    gathered = Gathered(path=path, remarks=[chosen.remark] if chosen.remark else [])
    taken = _frames(path, file, records, chosen)
    if taken is not None:
        closing.callback(taken.close)
    gathered.left_out.update(_other_buses(file, is_taken=taken is not None and bool(taken.named)))
    places = _places(file, records)
    named = [(f"group {place.group}", place.described.name) for place in places]
    names = unique_names(named + list(() if taken is None else taken.named))

    rows_of = cache(partial(_rows, path, file))

    def clock(group: int) -> SampleClock:
        return _clock(path, file, group, rate_hz, rows_of)

    clock_of = kept_clocks(clock)
    for place, name in zip(places, names[: len(places)], strict=True):

        def make(place: _Place = place, name: str = name) -> Channel:
            clock, rows = clock_of(place.group), rows_of(place.group)
            gathered.remarks.extend([_AT_CUTS] * (rows != (0, _count(path, file, place.group))))
            return _channel(path, place, opened, name, clock, *rows)

        gathered.add(name, make)
    if taken is not None:
        add_signals(gathered, taken, names[len(places) :])
    return gathered, chosen.words


def _frames(path: Path, file: Any, records: MdfRecords, chosen: Chosen) -> Decoded | None:
    """Return what the frames of a CAN bus hold; None where there are none.

    Raises RecordingError if there is a DBC file and it knows none of them, or there are none.
    """
    has_frames = any(holds_frames(group) and int(group.channel_group.cycles_nr) for group in file.groups)
    if not has_frames and not chosen.database.name:
        return None
    if not has_frames:
        raise RecordingError(
            f"{path}: expected raw messages of a bus for {chosen.database.name}, found none; leave the DBC file out."
        )
    taken = decoded(path, frames_of(file, records), chosen.database)
    if chosen.database.name:
        try:
            expect_known(path, taken, chosen)
        except RecordingError:
            taken.close()
            raise
    return taken


def _other_buses(file: Any, *, is_taken: bool) -> dict[str, str]:
    """Return why raw messages are left out: frames that nothing says of, and those of buses other than CAN."""
    left_out: dict[str, str] = {}
    for number, group in enumerate(file.groups):
        count = int(group.channel_group.cycles_nr)
        if not count or not is_bus_logging(group) or holds_no_values(group):
            continue
        if not holds_frames(group):
            left_out[f"group {number}"] = "raw messages of a bus other than CAN, which cannot be read."
        elif not is_taken:
            left_out[f"group {number}"] = (
                "raw messages of a bus; give the DBC file that says what they hold, dbc= (--dbc of shaftprint convert)."
            )
    return left_out


def _places(file: Any, records: MdfRecords) -> list[_Place]:
    return [
        _Place(file=file, records=records, group=group, index=index)
        for group, channel_group in enumerate(file.groups)
        if not is_bus_logging(channel_group)
        for index, channel in enumerate(channel_group.channels)
        if file.masters_db.get(group) != index and int(channel.channel_type) not in _MASTERS
    ]


def _count(path: Path, file: Any, group: int) -> int:
    described = file.groups[group].channel_group
    count, width = int(described.cycles_nr), int(getattr(described, "samples_byte_nr", 1))
    size = path.stat().st_size
    expect_plausible(path, f"group {group}", samples=count, sample_bytes=max(width, 1), stored_bytes=size)
    return count


def _clock(
    path: Path, file: Any, group: int, rate_hz: float | None, rows_of: Callable[[int], tuple[int, int]]
) -> SampleClock:
    """Take the clock of the group's master, which must count seconds, else the hint."""
    master = file.masters_db.get(group)
    if master is None:
        _count(path, file, group)
        if rate_hz is None:
            raise RecordingError(f"{path}: expected a master channel of times, found none; give the sample rate.")
        return SampleClock(rate_hz=rate_hz, start_s=0.0)
    channel = file.groups[group].channels[master]
    expect_in_record(path, f"master {channel.name}", file.groups[group].channel_group, channel)
    if int(getattr(channel, "sync_type", _TIME)) != _TIME:
        raise RecordingError(f"{path}: expected a master channel of times, found one of angles, distances or numbers.")

    first, last = rows_of(group)
    with told_as_damage(path, NAME):
        return clock_of_times(
            path,
            f"master {channel.name}",
            last - first,
            lambda start, stop: _times(file, group, first + start, first + stop),
        )


def _times(file: Any, group: int, start: int, stop: int) -> FloatArray:
    return np.asarray(file.get_master(group, record_offset=start, record_count=stop - start), dtype=np.float64)


def _rows(path: Path, file: Any, group: int) -> tuple[int, int]:
    """Return the first row of a group and the one behind its last, without what was made where the file was cut."""
    count = _count(path, file, group)
    if file.masters_db.get(group) is None:
        return 0, count
    with told_as_damage(path, NAME):
        return rows_between_cuts(count, partial(_times, file, group))


def _channel(
    path: Path, place: _Place, opened: Opened, name: str, clock: SampleClock, first_row: int, last_row: int
) -> Channel:
    file, records, group, index = place.file, place.records, place.group, place.index
    described = place.described
    count = last_row - first_row
    expect_in_record(path, name, file.groups[group].channel_group, described)
    conversion = described.conversion
    kind = -1 if conversion is None else int(conversion.conversion_type)
    scale, offset = 1.0, 0.0
    is_ours = is_worked_out_here(conversion, is_v4=_is_v4(file))
    values_of = numbers_of if _is_v4(file) else by_formula
    flags = int(getattr(described, "flags", 0))
    has_bits = bool(flags & (_ALL_INVALID | _HAS_INVALIDATION_BITS)) and _is_v4(file)
    is_all_invalid = has_bits and not flags & _HAS_INVALIDATION_BITS
    first, _ = records.samples(group, index, first_row, first_row + min(count, 2), raw=True)
    if first.ndim != 1 or first.dtype.kind not in "fiu":
        raise RecordingError(f"{path}, channel {name}: expected one real number a sample, found {_shape(first)}.")
    is_counts = first.dtype == np.int16 and not has_bits and (conversion is None or kind == _LINEAR)
    if is_counts and conversion is not None and _is_v4(file):
        scale, offset = float(conversion.a), float(conversion.b)
        is_counts = scale != 0.0 and bool(np.isfinite([scale, offset]).all())
        scale, offset = (scale, offset) if is_counts else (1.0, 0.0)
    elif conversion is not None:
        is_counts = False
    raw = is_counts or is_ours or (not _is_v4(file) and kind in _TEXTS_OF_MDF_3)

    def source(start: int, stop: int) -> NDArray[Any]:
        with opened.reading(name), told_as_damage(path, NAME):
            values, invalid = records.samples(group, index, first_row + start, first_row + stop, raw=raw)
            if len(values) != stop - start:
                raise RecordingError(f"{path}, channel {name}: samples [{start}, {stop}) are missing; is the file cut?")
            if is_counts:
                return np.ascontiguousarray(values, dtype=np.int16)
            if is_ours:
                numbers = values_of(conversion, values)
            else:
                # a copy: the library's type of numbers carries the conversion, and would apply it again
                numbers = np.empty(len(values))
                numbers[:] = values
            if is_all_invalid:
                numbers[:] = np.nan
            elif invalid is not None:
                numbers[np.asarray(invalid, dtype=bool)] = np.nan
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
        long_name=str(getattr(described, "comment", "") or "")[:200],
    )
    return on_clock(channel, clock)


def _is_v4(file: Any) -> bool:
    return str(file.version) >= "4"


def _unit(described: Any) -> str:
    unit = getattr(described, "unit", "") or unit_of(described.conversion)
    return unit.decode("latin-1").strip(" \0") if isinstance(unit, bytes) else str(unit).strip()


def _shape(values: NDArray[Any]) -> str:
    return f"{values.dtype.kind if values.dtype.names is None else 'a structure'} of shape {values.shape[1:]} a sample"
