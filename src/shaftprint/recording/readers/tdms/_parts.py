"""What each segment of a TDMS file says of its channels.

LabVIEW appends to a file at each start, with a start time, an increment and a scale of its own. The library keeps the
last of them for the whole channel.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from shaftprint.errors import RecordingError
from shaftprint.escape import printable
from shaftprint.recording.readers._clock import Hole
from shaftprint.recording.readers._epoch import seconds_from

# LabVIEW counts from 1904 and writes that where it knows no date.
_NO_DATE = np.datetime64("1905-01-01")
_CLOCK = ("wf_start_time", "wf_start_offset", "wf_increment")
UNITS = ("unit_string", "NI_UnitDescription", "unit", "units", "Unit")
_SCALE = "NI_"
# Starts that are off by less than this part of a sample follow on each other; a hole is whole samples to that part.
_FOLLOWING, _WHOLE = 0.5, 0.02
# Software that stamps its segments is late now and then; starts that stray less than this are those of one clock [s].
_STRAYING_S, _FEW = 0.25, 3


@dataclass(frozen=True, kw_only=True, slots=True)
class Part:
    """A stretch of a channel that its file says something new of."""

    first: int
    """Its first sample."""
    properties: dict[str, Any]
    """What the file says of its clock, unit and scale."""

    @property
    def start_time(self) -> np.datetime64 | None:
        """Its date, where there is one."""
        start = self.properties.get("wf_start_time")
        is_date = isinstance(start, np.datetime64) and not np.isnat(start) and start > _NO_DATE
        return start if is_date else None

    @property
    def offset_s(self) -> float:
        """How much later than its date it begins [s]."""
        offset = self.properties.get("wf_start_offset", 0.0)
        return float(offset) if isinstance(offset, int | float) and np.isfinite(offset) else 0.0

    @property
    def increment_s(self) -> float | None:
        """Time from one sample to the next [s]; None where none is given."""
        increment = self.properties.get("wf_increment")
        if not isinstance(increment, int | float) or not (np.isfinite(increment) and increment > 0.0):
            return None
        return float(increment)

    def start_s(self, began: np.datetime64 | None) -> float:
        """Return when it begins, in seconds from a date on, or from nothing known."""
        start = self.start_time
        if start is None or began is None:
            return self.offset_s
        return self.offset_s + float(seconds_from(began, start))


@dataclass(kw_only=True, slots=True)
class _ChannelParts:
    """What has been read so far of one channel."""

    parts: list[Part] = field(default_factory=list)
    count: int = 0
    properties: dict[str, Any] = field(default_factory=dict)

    def learn(self, properties: Mapping[str, Any], samples: int) -> None:
        """Take in one segment."""
        self.properties |= properties
        if samples:
            is_new = not self.parts or any(
                self.parts[-1].properties.get(key) != value for key, value in properties.items()
            )
            if is_new:
                self.parts.append(Part(first=self.count, properties=dict(self.properties)))
            self.count += samples
        elif len(self.parts) == 1:
            # properties that are written behind the samples are those of the channel
            self.parts[0].properties.update(properties)
        else:
            for part in self.parts:
                for key, value in properties.items():
                    part.properties.setdefault(key, value)


def parts_of(nptdms: Any, raw: Any) -> tuple[dict[str, list[Part]], dict[str, str]]:
    """Return the parts of every channel, by its path in the file, and what is doubtful in segments.

    A segment holds as many rounds of samples as its length allows. Where it states none of one channel and several
    rounds of the others, the others may have been given what was of the one.

    ``nptdms``: the library. ``raw``: the open file; it is read from its beginning.
    """
    raw.seek(0)
    reader = nptdms.reader.TdmsReader(raw)
    of_segments: list[Mapping[str, list[tuple[str, Any]]]] = []
    update = reader._update_object_properties

    def listen(properties: Any) -> None:
        of_segments.append(properties or {})
        update(properties)

    reader._update_object_properties = listen
    reader.read_metadata()
    channels: dict[str, _ChannelParts] = {}
    doubts: dict[str, str] = {}
    for number, (segment, properties) in enumerate(zip(reader._segments, of_segments, strict=True), start=1):
        empty = [one.path for one in segment.ordered_objects if one.has_data and not one.number_values]
        if empty and segment.num_chunks > 1:
            doubts[f"segment {number}, {', '.join(map(printable, empty[:3]))}"] = (
                f"0 samples beside {segment.num_chunks} rounds of the other channels: if their number was damaged, "
                "these hold them among their own; copy the file again from the logger, or compare the lengths."
            )
        samples = {one.path: nptdms.reader._number_of_segment_values(one, segment) for one in segment.ordered_objects}
        for path in dict.fromkeys((*properties, *samples)):
            channel = channels.setdefault(path, _ChannelParts())
            channel.learn(
                {key: _plain(value) for key, value in properties.get(path, ()) if _is_of_interest(key)},
                samples.get(path, 0),
            )
    return {path: channel.parts for path, channel in channels.items()}, doubts


def _plain(value: Any) -> Any:
    """Return a property as the library's channels give it: dates to the microsecond."""
    return value.as_datetime64("us") if hasattr(value, "as_datetime64") else value


def _is_of_interest(key: str) -> bool:
    return key in _CLOCK or key in UNITS or key.startswith(_SCALE)


def expect_one_scale(path: Path, name: str, parts: list[Part]) -> None:
    """Refuse a channel whose unit or scale changes within the file.

    Raises RecordingError if it does; the message says where.
    """
    for before, part in pairwise(parts):
        keys = [key for key in {**before.properties, **part.properties} if key not in _CLOCK]
        changed = next((key for key in keys if before.properties.get(key) != part.properties.get(key)), None)
        if changed is not None:
            old, new = (str(one.properties.get(changed))[:30] for one in (before, part))
            raise RecordingError(
                f"{path}, channel {name}: expected one unit and scale, found {changed} changed from {old} to {new} at "
                f"sample {part.first}, where the logger was started anew; save each start as a file of its own."
            )


def increment_s(path: Path, name: str, parts: list[Part]) -> float | None:
    """Return the time from one sample to the next [s]; None where the file gives none.

    Raises RecordingError if it changes within the file; the message says where.
    """
    first = parts[0].increment_s if parts else None
    other = next((part for part in parts if part.increment_s != first), None)
    if other is not None:
        raise RecordingError(
            f"{path}, channel {name}: expected one rate, found wf_increment changed from {first or 0.0:g} to "
            f"{other.increment_s or 0.0:g} s at sample {other.first}, where the logger was started anew; save each "
            "start as a file of its own."
        )
    return first


def holes_between(parts: list[Part], step_s: float, count: int, interleaved: int = 1) -> tuple[tuple[Hole, ...], str]:
    """Return where samples are missing between parts, or their clock jumps, and a remark, empty where there is none.

    ``parts``: the parts of a channel. ``step_s``: time from one sample to the next [s]. ``count``: how many samples it
    has; more than so many are not filled in. ``interleaved``: how many signals it holds sample by sample; steps and
    holes are those of rows.
    """
    jumps = []
    for before, part in pairwise(parts):
        is_said = (before.start_time, before.offset_s) != (part.start_time, part.offset_s)
        is_said &= (before.start_time is None) == (part.start_time is None)
        apart_s = part.start_s(before.start_time) - before.offset_s
        jumps.append(apart_s - (part.first - before.first) // interleaved * step_s if is_said else 0.0)
    straying = np.cumsum(jumps)
    off = np.abs(jumps) > _FOLLOWING * step_s
    if np.count_nonzero(off) > _FEW and np.max(np.abs(straying)) <= _STRAYING_S:
        worst = float(np.max(np.abs(straying)))
        return (
            (),
            f"the start times of its {len(parts)} parts stray by up to {worst:.2g} s and were taken for one clock",
        )
    holes, missing = [], 0
    for part, jump in zip(parts[1:], jumps, strict=True):
        if abs(jump) <= _FOLLOWING * step_s:
            continue
        places = max(round(jump / step_s), 0)
        places = places if missing + places <= count else 0
        missing += places
        rest = jump - places * step_s
        is_whole = abs(rest) <= _WHOLE * step_s
        holes.append(Hole(row=part.first // interleaved, missing=places, jump_s=0.0 if is_whole else rest))
    return tuple(holes), ""


def expect_known_scale(path: Path, name: str, channel: Any, *properties: Mapping[str, Any]) -> None:
    """Refuse a channel whose scale the library does not know, and would leave out.

    ``path``, ``name``: for messages. ``properties``: properties of the channel, its group and the file: the first that
    state a scale hold. Raises RecordingError if it is so, or if the channel holds raw counts of DAQmx without a scale.
    """
    stated = next((one for one in properties if one.get("NI_Number_Of_Scales")), {})
    kinds = [str(value) for key, value in stated.items() if key.endswith("_Scale_Type")]
    if kinds and stated.get("NI_Scaling_Status", "unscaled") != "scaled" and channel._scaling is None:
        raise RecordingError(
            f"{path}, channel {name}: expected a scale that is known, found {', '.join(kinds)[:80]}; its raw counts "
            "are no values, save it scaled."
        )
    if np.dtype(channel.dtype).kind == "V":
        raise RecordingError(
            f"{path}, channel {name}: expected values, found raw counts of DAQmx without a scale; save it scaled."
        )
