"""NI TDMS files of LabVIEW and DAQmx: each channel with its waveform properties or a channel of times."""

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray
from shaftprint.errors import RecordingError
from shaftprint.escape import printable
from shaftprint.files import kept_open
from shaftprint.recording._channel import Channel
from shaftprint.recording._recording import Recording
from shaftprint.recording.readers._clock import SampleClock, on_clock
from shaftprint.recording.readers._coarse_stamps import clock_of_stamps
from shaftprint.recording.readers._damage import expect_plausible, told_as_damage
from shaftprint.recording.readers._epoch import seconds_from
from shaftprint.recording.readers._extra import library
from shaftprint.recording.readers._gather import Gathered, unique_names
from shaftprint.recording.readers._hints import rate_hint
from shaftprint.recording.readers._library_output import remarks
from shaftprint.recording.readers._opened import Opened
from shaftprint.recording.readers._time_scale import expect_time_unit, other_times, time_of, time_scale, unit_in_name
from shaftprint.recording.readers.tdms._parts import (
    UNITS,
    Part,
    expect_known_scale,
    expect_one_scale,
    holes_between,
    increment_s,
    parts_of,
)
from shaftprint.units import plain_unit

NAME = "TDMS"

_SIGNATURE = b"TDSm"
# LabVIEW's step of a waveform where nothing is known of it [s]; rates of two clocks agree to this.
_DEFAULT_STEP_S, _RATE_AGREEMENT = 1.0, 1e-3


def is_mine(path: Path) -> bool:
    """Return whether the file begins as a TDMS file."""
    with path.open("rb") as file:
        return file.read(len(_SIGNATURE)) == _SIGNATURE


def read(path: Path, **hints: object) -> Recording:
    """Open a TDMS file; samples are read, and scaled as the file says, as channels are asked for them.

    Hints: ``sample_rate_hz`` for channels without a clock; ``time_unit`` of times without a unit; ``interleaved``, how
    many signals each channel holds sample by sample, as LabVIEW writes an array of two dimensions: they become channels
    of their own, on the clock of rows.

    Raises RecordingError if the file is damaged or no channel can be used.
    """
    rate = rate_hint(path, hints, {"interleaved": int, "time_unit": str})
    time_unit = expect_time_unit(path, hints.get("time_unit"))
    interleaved = cast(int, hints.get("interleaved", 1))
    if interleaved < 1:
        raise RecordingError(f"{path}: the hint interleaved cannot be {interleaved}; it is a number of signals.")
    nptdms = library(path, "nptdms", NAME)
    # the library leaves a file open that it fails to read
    raw = path.open("rb")
    with kept_open(Opened(path, raw.close)) as opened, told_as_damage(path, NAME) as said:
        file = nptdms.TdmsFile.open(raw)
        parts, doubts = parts_of(nptdms, raw)
        return _Source(
            path=path,
            file=file,
            opened=opened,
            parts=parts,
            gathered=Gathered(path=path, left_out=remarks(said, "npTDMS") | doubts),
            rate_hz=rate,
            time_unit=time_unit,
            interleaved=interleaved,
        ).recording()


@dataclass(frozen=True, kw_only=True, slots=True)
class _Group:
    """The channel of times of a group, if it has one, and its clock."""

    time: Any
    clock: SampleClock
    began: np.datetime64 | None
    """Date of its first time, where it has dates."""


@dataclass(frozen=True, kw_only=True, slots=True)
class _Source:
    """A file while its channels are gathered."""

    path: Path
    file: Any
    opened: Opened
    parts: Mapping[str, list[Part]]
    gathered: Gathered
    rate_hz: float | None
    time_unit: str
    interleaved: int

    def recording(self) -> Recording:
        """Return the recording of all channels."""
        groups = {group.name: self._group(group) for group in self.file.groups()}
        channels = [channel for group in self.file.groups() for channel in group.channels()]
        names = unique_names([(channel.group_name, channel.name) for channel in channels])
        began = self._began(channels, groups)
        known = {channel.path for channel in channels}
        for place in (place for place, parts in self.parts.items() if parts and place not in known):
            self.gathered.left_out[printable(place)] = (
                "its samples stand under a name that is no channel's: the name is damaged, copy the file again from "
                "the logger."
            )
        for channel, name in zip(channels, names, strict=True):
            group = groups[channel.group_name]
            if isinstance(group, _Group) and channel is group.time:
                continue
            for part in range(self.interleaved):
                signal_name = name if self.interleaved == 1 else f"{name} {part + 1}"
                self.gathered.add(signal_name, partial(self._channel, channel, signal_name, group, began, part))
        has_zone = all(scale.has_zone for scale in self.gathered.scales)
        date = None if began is None else began.astype("datetime64[us]").item()
        if isinstance(date, datetime):
            return self.gathered.recording(NAME, self.opened.close, date.replace(tzinfo=UTC if has_zone else None))
        return self.gathered.recording(NAME, self.opened.close)

    def _group(self, group: Any) -> "_Group | RecordingError | None":
        time = _time_channel(group)
        if time is None:
            return None
        name = f"channel {time.name}"
        try:
            if np.dtype(time.dtype).kind == "M":
                first = np.asarray(time.read_data(0, 1))[0]

                def seconds(start: int, stop: int) -> FloatArray:
                    return seconds_from(first, np.asarray(time.read_data(start, stop - start)))

                clock, _ = clock_of_stamps(self.path, name, len(time), seconds, rate_hz=self.rate_hz)
                return _Group(time=time, clock=clock, began=first)

            def numbers(start: int, stop: int) -> FloatArray:
                return np.asarray(time.read_data(start, stop - start), dtype=np.float64)

            unit = _unit(time.properties) or unit_in_name(time.name) or ""
            scale = time_scale(self.path, name, len(time), numbers, unit=unit, asked=self.time_unit)
            clock, _ = clock_of_stamps(self.path, name, len(time), scale.reading(numbers), rate_hz=self.rate_hz)
        except RecordingError as error:
            return error
        self.gathered.scales.append(scale)
        since_1970 = np.timedelta64(round(1e6 * scale.since_1970_s), "us")
        return _Group(time=time, clock=clock, began=np.datetime64(0, "us") + since_1970 if scale.since_1970_s else None)

    def _began(self, channels: list[Any], groups: "Mapping[str, _Group | RecordingError | None]") -> Any:
        """Return the earliest date, in which second 0 lies; None where the file has none."""
        of_parts = [part.start_time for channel in channels for part in self.parts.get(channel.path, ())]
        of_times = [group.began for group in groups.values() if isinstance(group, _Group)]
        return min((date for date in (*of_parts, *of_times) if date is not None), default=None)

    def _clock(
        self, channel: Any, name: str, group: "_Group | RecordingError | None", began: np.datetime64 | None
    ) -> SampleClock:
        """Take the clock of the waveform, else that of the group's channel of times, else the hint."""
        parts = self.parts.get(channel.path, [])
        step_s = increment_s(self.path, name, parts)
        rows = len(channel) // self.interleaved
        of_times = group if isinstance(group, _Group) and len(group.time) == rows else None
        if step_s == _DEFAULT_STEP_S and of_times is None:
            step_s = 1.0 / self.rate_hz if self.rate_hz is not None else step_s
            taken = "was taken" if self.rate_hz is None else f"does not count beside the {self.rate_hz:g} Hz given"
            self.gathered.remarks.append(
                f"wf_increment is 1 s, which LabVIEW also writes where nobody sets it; it {taken}. State the rate "
                "(--sample-rate) where it is not one sample a second."
            )
        if step_s is not None:
            by_waveform = float(f"{1.0 / step_s:.12g}")
            if of_times is None or abs(by_waveform / of_times.clock.rate_hz - 1.0) <= _RATE_AGREEMENT:
                holes, remark = holes_between(parts, step_s, rows, self.interleaved)
                self.gathered.remarks.extend([f"channel {name}: {remark}."] if remark else [])
                return SampleClock(rate_hz=by_waveform, start_s=parts[0].start_s(began), holes=holes)
            if step_s != _DEFAULT_STEP_S:
                raise RecordingError(
                    f"{self.path}, channel {name}: expected one rate, found {by_waveform:g} Hz of wf_increment and "
                    f"{of_times.clock.rate_hz:g} Hz of the channel {of_times.time.name}; save it without one of them."
                )
            self.gathered.remarks.append(
                f"channel {of_times.time.name}: its times were taken, of {of_times.clock.rate_hz:g} Hz; wf_increment "
                "is 1 s, which LabVIEW writes where nothing is known."
            )
        if of_times is not None:
            if began is None or of_times.began is None:
                return of_times.clock
            return of_times.clock.later_by(float(seconds_from(began, of_times.began)))
        if self.rate_hz is not None:
            return SampleClock(rate_hz=self.rate_hz, start_s=0.0)
        if isinstance(group, RecordingError):
            raise group
        raise RecordingError(
            f"{self.path}: expected wf_increment in the properties or a channel of times in the group, found neither; "
            "give the sample rate (--sample-rate), and how many signals a channel holds where they stand sample by "
            "sample (--interleaved)."
        )

    def _channel(
        self,
        channel: Any,
        name: str,
        group: "_Group | RecordingError | None",
        began: np.datetime64 | None,
        part: int,
    ) -> Channel:
        of_group = self.file[channel.group_name].properties
        expect_known_scale(self.path, name, channel, channel.properties, of_group, self.file.properties)
        expect_one_scale(self.path, name, self.parts.get(channel.path, []))
        clock = self._clock(channel, name, group, began)
        if isinstance(group, _Group) and np.dtype(channel.dtype).kind in "fiu" and self.interleaved == 1:
            self.gathered.remarks.extend(
                other_times(
                    channel.name,
                    len(channel),
                    lambda start, stop: channel.read_data(start, stop - start),
                    clock.rate_hz,
                    f"channel {group.time.name}",
                )
            )
        return _channel(self.path, name, channel, clock, self.opened, part, self.interleaved)


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


def _time_channel(group: Any) -> Any:
    """Return the channel of times of a group: dates, or numbers under the name of a time; one alone holds signals."""
    channels = group.channels()
    dated = next((channel for channel in channels if np.dtype(channel.dtype).kind == "M"), None)
    if dated is not None:
        return dated
    numeric = [channel for channel in channels if np.dtype(channel.dtype).kind in "fiu" and len(channel)]
    place = time_of([channel.name for channel in numeric])
    return None if place is None or len(channels) == 1 else numeric[place]


def _unit(properties: Mapping[str, Any]) -> str:
    return next((str(properties[key]) for key in UNITS if properties.get(key)), "")
