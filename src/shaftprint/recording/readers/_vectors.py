"""Files that are named vectors in groups: which are channels, which are clocks, which units they have."""

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import RecordingError
from shaftprint.recording._channel import Channel, Source
from shaftprint.recording.readers._clock import SampleClock, on_clock
from shaftprint.recording.readers._gather import Gathered, unique_names
from shaftprint.recording.readers._hints import OF_HINT, expect_one_rate
from shaftprint.recording.readers._time_scale import TimeScale, is_capital, other_times, time_scale, unit_in_name
from shaftprint.recording.readers._units import seconds_in
from shaftprint.units import plain_unit

_RATES = ("sample_rate_hz", "fs", "sample_rate", "sampling_rate", "sampling_frequency", "samplerate", "rate_hz")
# tinterval and tstart are PicoScope's, xinc and xorg Keysight's
_STEPS = ("dt", "ts", "wf_increment", "sampling_interval", "sample_time", "tinterval", "xinc")
_STARTS = ("start_s", "t0", "wf_start_offset", "tstart", "xorg")
LOCAL = "shaftprint_local_time"
"""Attribute of times that are dates by the clock of the place, without a zone."""
_UNITS = ("units", "unit", "unit_string")
_RATE_AGREEMENT = 1e-6


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Vector:
    """One vector of numbers."""

    name: str
    """Its name in its group."""
    group: str = ""
    """Its group, structure or folder; empty at the top."""
    count: int
    """Number of elements."""
    source: Source
    """Gives the elements [start, stop)."""
    axis: str = ""
    """Name of the vector along which it lies, where the file says so."""
    attributes: Mapping[str, object] = field(default_factory=dict)
    """What the file says of it."""
    scale: float = 1.0
    """Value of one count."""
    offset: float = 0.0
    """Value at count zero."""


Scalars = Mapping[str, float]


def gather_vectors(
    path: Path,
    vectors: Sequence[Vector],
    scalars: Mapping[str, Scalars],
    *,
    rate_hz: float | None,
    time_unit: str = "",
    left_out: Mapping[str, str] | None = None,
) -> Gathered:
    """Make a channel of every vector that is no time, each on its own clock, that of its group or the whole file.

    ``path``: the file, for messages. ``vectors``: what it holds. ``scalars``: numbers by group and name. ``rate_hz``:
    sample rate that the caller knows [Hz]. ``time_unit``: unit of the times that the caller knows. ``left_out``: why
    other variables cannot be used. Raises RecordingError if a group has two times or two rates that disagree.
    """
    gathered = Gathered(path=path, left_out=dict(left_out or {}))
    axes = {vector.axis for vector in vectors if vector.axis}
    times = _times_among(vectors)
    signals = [vector for vector in vectors if vector not in times and vector.name not in axes]
    names = unique_names([(vector.group, vector.name) for vector in signals])
    clocks: dict[tuple[str, str, int], SampleClock] = {}

    def clock_of(time: Vector) -> SampleClock:
        key = (time.group, time.name, time.count)
        if key not in clocks:
            clocks[key] = _clock_of_times(path, time, gathered.scales, time_unit, rate_hz)
        return clocks[key]

    def make(vector: Vector, name: str) -> Channel:
        time = _time_of(path, vector, vectors, times)
        clock = _clock(path, vector, time, scalars, rate_hz, clock_of)
        if time is not None:
            gathered.remarks.extend(
                other_times(vector.name, vector.count, vector.source, clock.rate_hz, f"variable {time.name}")
            )
        channel = Channel(
            name=name,
            unit=plain_unit(_text(vector.attributes, _UNITS)),
            rate_hz=clock.rate_hz,
            start_s=clock.start_s,
            count=vector.count,
            source=vector.source,
            scale=vector.scale,
            offset=vector.offset,
            long_name=_text(vector.attributes, ("long_name", "description")),
        )
        return on_clock(channel, clock)

    for vector, name in zip(signals, names, strict=True):
        gathered.add(name, partial(make, vector, name))
    return gathered


def _times_among(vectors: Sequence[Vector]) -> list[Vector]:
    """Return the vectors that are times by their names; a capital T is one only where its group has no other."""
    named = [
        vector for vector in vectors if unit_in_name(vector.name) is not None or vector.name.lower().endswith("_time")
    ]
    plain = [vector for vector in named if not is_capital(vector.name)]
    return [vector for vector in named if not is_capital(vector.name) or not any(_holds(one, vector) for one in plain)]


def _holds(time: Vector, vector: Vector) -> bool:
    """Return whether a time stands in the group of a vector or above it."""
    return time.group in ("", vector.group) or vector.group.startswith(f"{time.group}/")


def _clock(
    path: Path,
    vector: Vector,
    time: Vector | None,
    scalars: Mapping[str, Scalars],
    hint_hz: float | None,
    clock_of: Callable[[Vector], SampleClock],
) -> SampleClock:
    """Take the clock from the nearest place that says one, and refuse places that disagree."""
    of_times = None if time is None else clock_of(time)
    if of_times is not None and of_times.is_uneven:
        return of_times
    attributes = {key.lower(): value for key, value in vector.attributes.items() if isinstance(value, int | float)}
    of_file = scalars.get("", {})
    stated: dict[str, float] = {}
    starts = [] if of_times is None else [of_times.start_s]
    for source in (attributes, scalars.get(vector.group, {}), of_file):
        rates_here = _stated_rates(path, source)
        if rates_here and not stated:
            stated = rates_here
            starts += [float(source[key]) for key in _STARTS if key in source]
    rates = {**({} if time is None or of_times is None else {time.name: of_times.rate_hz}), **stated}
    if hint_hz is not None:
        rates[OF_HINT] = hint_hz
    if not rates:
        raise RecordingError(
            f"{path}: expected a clock, that is a vector time or t of {vector.count} seconds or a scalar "
            "sample_rate_hz or fs, found none; pass sample_rate_hz= (--sample-rate of shaftprint convert)."
        )
    rate = next(iter(rates.values()))
    expect_one_rate(path, rates, _RATE_AGREEMENT)
    starts += [float(of_file[key]) for key in _STARTS if key in of_file]
    start_s = starts[0] if starts else 0.0
    if of_times is None:
        return SampleClock(rate_hz=rate, start_s=start_s)
    return replace(of_times, rate_hz=rate, start_s=start_s)


def _stated_rates(path: Path, source: Mapping[str, object]) -> dict[str, float]:
    """Return what a group of numbers says of the rate, by the name under which it says it."""
    rates = {key: float(value) for key, value in source.items() if key in _RATES and isinstance(value, int | float)}
    if len(rates) > 1:
        raise RecordingError(f"{path}: expected one of {' or '.join(rates)}, found both.")
    if not rates:
        steps = {key: value for key, value in source.items() if key in _STEPS and isinstance(value, int | float)}
        rates = {key: float(f"{1.0 / value:.12g}") for key, value in steps.items() if value > 0.0}
    return rates


def _time_of(path: Path, vector: Vector, vectors: Sequence[Vector], times: Sequence[Vector]) -> Vector | None:
    """Return the times of a vector: its axis, else ``<name>_time``, else the time of its group, else of the file."""
    if vector.axis:
        for other in _nearest(vector, vectors, (vector.axis.lower(),)):
            if other.count == vector.count and (other in times or _counts_time(other)):
                return other
        return None
    its_time = f"{vector.name}_time".lower()
    any_time = {other.name.lower() for other in times if unit_in_name(other.name) is not None}
    for names in ((its_time,), any_time):
        candidates = [other for other in _nearest(vector, times, names) if other.count == vector.count]
        if len(candidates) > 1:
            raise RecordingError(
                f"{path}: expected one of {' or '.join(other.name for other in candidates)}, found both."
            )
        if candidates:
            return candidates[0]
    return None


def _nearest(vector: Vector, vectors: Iterable[Vector], names: Collection[str]) -> list[Vector]:
    """Return the vectors of some names in the same group, else in those that hold it."""
    named = [other for other in vectors if other.name.lower() in names]
    parts = vector.group.split("/")
    for length in range(len(parts), -1, -1):
        nearest = [other for other in named if other.group == "/".join(parts[:length])]
        if nearest:
            return nearest
    return []


def _clock_of_times(
    path: Path, time: Vector, scales: list[TimeScale], time_unit: str, rate_hz: float | None
) -> SampleClock:
    unit = _text(time.attributes, _UNITS) or unit_in_name(time.name) or ""

    def read(start: int, stop: int) -> FloatArray:
        return time.source(start, stop).astype(np.float64) * time.scale + time.offset

    scale = time_scale(path, f"variable {time.name}", time.count, read, unit=unit, asked=time_unit)
    scale = replace(scale, has_zone=scale.has_zone and LOCAL not in time.attributes)
    others = {one.reference_s for one in scales if one.reference_s is not None}
    if scale.reference_s is not None and others - {scale.reference_s}:
        raise RecordingError(
            f'{path}, variable {time.name}: expected times since the date of the others, found "{unit}"; write all '
            "since one date."
        )
    clock = scale.clock(path, f"variable {time.name}", time.count, read, rate_hz)
    scales.append(scale)
    return clock


def _counts_time(axis: Vector) -> bool:
    """Return whether the unit of an axis is one of time, or none is given."""
    unit = _text(axis.attributes, _UNITS)
    return unit == "" or seconds_in(unit.partition(" since ")[0]) is not None


def _text(attributes: Mapping[str, object], keys: Sequence[str]) -> str:
    return next((str(attributes[key]) for key in keys if attributes.get(key)), "")
