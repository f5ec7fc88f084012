"""NI TDMS files of LabVIEW and DAQmx: each channel with its waveform properties or a channel of times."""

from collections.abc import Mapping
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray
from shaftprint.errors import RecordingError
from shaftprint.recording._channel import Channel
from shaftprint.recording._recording import Recording
from shaftprint.recording.readers._clock import SampleClock, clock_of_times, on_clock
from shaftprint.recording.readers._damage import expect_plausible, told_as_damage
from shaftprint.recording.readers._extra import library
from shaftprint.recording.readers._gather import Gathered, unique_names
from shaftprint.recording.readers._hints import rate_hint
from shaftprint.recording.readers._opened import Opened
from shaftprint.units import plain_unit

NAME = "TDMS"

_SIGNATURE = b"TDSm"
_NO_DATE = np.datetime64("1905-01-01")
_TIME_NAMES = ("time", "t", "timestamp", "zeit")
_UNITS = ("unit_string", "NI_UnitDescription", "unit", "units", "Unit")


def is_mine(path: Path) -> bool:
    """Return whether the file begins as a TDMS file."""
    with path.open("rb") as file:
        return file.read(len(_SIGNATURE)) == _SIGNATURE


def read(path: Path, **hints: object) -> Recording:
    """Open a TDMS file; samples are read, and scaled as the file says, as channels are asked for them.

    Hints: ``sample_rate_hz`` for channels without a clock; ``interleaved``, how many signals each channel holds sample
    by sample, as LabVIEW writes an array of two dimensions: they become channels of their own, on the clock of rows.

    Raises
    ------
    RecordingError
        If the file is damaged or no channel can be used.
    """
    rate = rate_hint(path, hints, {"interleaved": int})
    parts = cast(int, hints.get("interleaved", 1))
    if parts < 1:
        raise RecordingError(f"{path}: the hint interleaved cannot be {parts}; it is a number of signals.")
    nptdms = library(path, "nptdms", NAME)
    # the library leaves a file open that it fails to read
    raw = path.open("rb")
    opened = Opened(path, raw.close)
    try:
        with told_as_damage(path, NAME):
            file = nptdms.TdmsFile.open(raw)
            gathered = _gather(path, file, opened, rate, parts)
            return gathered.recording(NAME, opened.close, _began(file))
    except BaseException:
        opened.close()
        raise


def _gather(path: Path, file: Any, opened: Opened, rate_hz: float | None, parts: int) -> Gathered:
    gathered = Gathered(path=path)
    channels = [channel for group in file.groups() for channel in group.channels()]
    names = unique_names([(channel.group_name, channel.name) for channel in channels])
    began = _earliest(channels)
    clocks = {group.name: _time_channel(group) for group in file.groups()}
    for channel, name in zip(channels, names, strict=True):
        if channel is clocks[channel.group_name]:
            continue

        for part in range(parts):
            own_name = name if parts == 1 else f"{name} {part + 1}"

            def make(channel: Any = channel, own_name: str = own_name, part: int = part) -> Channel:
                clock = _clock(path, channel, clocks[channel.group_name], rate_hz, began, parts)
                return _channel(path, own_name, channel, clock, opened, part, parts)

            gathered.add(own_name, make)
    return gathered


def _channel(path: Path, name: str, channel: Any, clock: SampleClock, opened: Opened, part: int, parts: int) -> Channel:
    """Return a channel, or one part of the signals that it holds one after the other."""
    kind = np.dtype(channel.dtype)
    _expect_samples(path, name, channel)
    if len(channel) % parts:
        raise RecordingError(
            f"{path}, channel {name}: expected rows of {parts} samples, found {len(channel)} samples, no whole number "
            "of rows; give the number of signals in one row."
        )
    is_counts = kind == np.dtype(np.int16)

    def source(start: int, stop: int) -> NDArray[Any]:
        with opened.reading(name), told_as_damage(path, NAME):
            values = channel.read_data(start * parts, (stop - start) * parts)[part::parts]
            if len(values) != stop - start:
                raise RecordingError(f"{path}, channel {name}: samples [{start}, {stop}) are missing; is the file cut?")
            return np.ascontiguousarray(values, dtype=np.int16 if is_counts else np.float64)

    unclocked = Channel(
        name=name,
        unit=plain_unit(_unit(channel.properties)),
        rate_hz=clock.rate_hz,
        start_s=clock.start_s,
        count=len(channel) // parts,
        source=source,
        long_name=str(channel.properties.get("description", "")),
    )
    return on_clock(unclocked, clock)


def _expect_samples(path: Path, name: str, channel: Any) -> None:
    kind = np.dtype(channel.dtype)
    if kind.kind not in "fiu":
        raise RecordingError(f"{path}, channel {name}: expected real numbers, found {kind}.")
    if len(channel) == 0:
        raise RecordingError(f"{path}, channel {name}: expected samples, found none.")
    size = path.stat().st_size
    expect_plausible(path, name, samples=len(channel), sample_bytes=1, stored_bytes=size, is_packed=False)


def _clock(
    path: Path, channel: Any, time: Any, rate_hz: float | None, began: np.datetime64 | None, parts: int
) -> SampleClock:
    """Take the clock of the waveform, else that of the group's channel of times, else the hint."""
    increment = channel.properties.get("wf_increment")
    if isinstance(increment, int | float) and np.isfinite(increment) and increment > 0.0:
        start = float(channel.properties.get("wf_start_offset", 0.0))
        start_time = channel.properties.get("wf_start_time")
        if isinstance(start_time, np.datetime64) and began is not None and start_time > _NO_DATE:
            start += float((start_time - began) / np.timedelta64(1, "us")) * 1e-6
        return SampleClock(rate_hz=float(f"{1.0 / increment:.12g}"), start_s=start)
    if time is not None and len(time) * parts == len(channel):
        clock = clock_of_times(path, f"channel {time.name}", len(time), lambda start, stop: _times(time, start, stop))
        is_date = np.dtype(time.dtype).kind == "M"
        return replace(clock, start_s=0.0) if is_date else clock
    if rate_hz is not None:
        return SampleClock(rate_hz=rate_hz, start_s=0.0)
    raise RecordingError(
        f"{path}: expected wf_increment in the properties or a channel of times in the group, found neither; "
        "give the sample rate."
    )


def _times(time: Any, start: int, stop: int) -> FloatArray:
    values = np.asarray(time.read_data(start, stop - start))
    if values.dtype.kind == "M":
        first = np.asarray(time.read_data(0, 1))[0]
        seconds: FloatArray = (values - first) / np.timedelta64(1, "us") * 1e-6
        return seconds
    return values.astype(np.float64)


def _time_channel(group: Any) -> Any:
    """Return the channel of times of a group: dates, or numbers in seconds under the name of a time."""
    for channel in group.channels():
        kind = np.dtype(channel.dtype).kind
        if kind == "M":
            return channel
        named = channel.name.strip().lower() in _TIME_NAMES
        if kind == "f" and named and "wf_increment" not in channel.properties:
            return channel
    return None


def _unit(properties: Mapping[str, Any]) -> str:
    return next((str(properties[key]) for key in _UNITS if properties.get(key)), "")


def _earliest(channels: list[Any]) -> np.datetime64 | None:
    starts = [channel.properties.get("wf_start_time") for channel in channels]
    dates = [start for start in starts if isinstance(start, np.datetime64) and not np.isnat(start)]
    # LabVIEW counts from 1904 and writes that where it knows no date
    return min((date for date in dates if date > _NO_DATE), default=None)


def _began(file: Any) -> datetime | None:
    start = _earliest([channel for group in file.groups() for channel in group.channels()])
    if start is None:
        return None
    date = start.astype("datetime64[us]").item()
    return date.replace(tzinfo=UTC) if isinstance(date, datetime) else None
