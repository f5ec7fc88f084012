"""Several recordings as one: of loggers that ran side by side, or of parts that follow one another."""

import hashlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from shaftprint.clocks._alignment import Alignment
from shaftprint.clocks._logger_clock import LoggerClock, clock_attributes, logger_clocks
from shaftprint.errors import ClockError
from shaftprint.escape import printable
from shaftprint.recording._channel import Channel
from shaftprint.recording._recording import CLOCK_MAPS, Recording

# A part may begin this share of a sample off the grid of the part before it.
OFF_GRID = 0.51
# Clocks of parts that one logger wrote are the same to this.
SAME_RATE = 1e-6
# The period of a sender is known from its messages only.
SAME_SENDER = 1e-2


def merged(reference: Recording, others: Sequence[tuple[Recording, Alignment]]) -> Recording:
    """Return one recording with the channels of several loggers, all on the clock of the first.

    Samples are neither moved nor copied: channels get another start and rate. A channel whose name is taken already
    gets the name of its file behind its own, as in ``U_setpoint (engine)``. The clock maps, with those of recordings
    that were merged before, go into the attributes (see ``logger_clocks``). Closing it closes them all.

    Parameters
    ----------
    reference
        The recording that has the clock.
    others
        Further recordings with their alignments; one that is known from elsewhere needs a map and a span alone.

    Raises
    ------
    ClockError
        If two channels would have the same name.
    RecordingError
        If the clock maps that a recording holds already cannot be understood.
    """
    channels = dict(reference.channels)
    clocks = list(logger_clocks(reference))
    for other, alignment in others:
        names: dict[str, str] = {}
        for channel in other.channels.values():
            name = channel.name if channel.name not in channels else f"{channel.name} ({printable(other.path.stem)})"
            if name in channels:
                raise ClockError(
                    f'{other.path}: expected a name that is free for channel {channel.name}, found "{name}" taken; '
                    "rename one of the files."
                )
            channels[name] = replace(alignment.map.applied(channel), name=name)
            names[channel.name] = name
        clocks += _clocks(reference, other, alignment, names)
    attributes = {**reference.attributes, **clock_attributes(clocks)}
    return _one([reference, *(other for other, _ in others)], channels, "merged", attributes)


def _clocks(
    reference: Recording, other: Recording, alignment: Alignment, names: Mapping[str, str]
) -> list[LoggerClock]:
    """Return the clock map of another recording, and those of loggers that were merged into it before."""
    earlier = [
        replace(
            clock,
            reference=reference.path.name,
            reference_sha256=reference.sha256,
            channels=tuple(names[name] for name in clock.channels),
            alignment=clock.alignment.then(alignment.map),
        )
        for clock in logger_clocks(other)
    ]
    theirs = {name for clock in earlier for name in clock.channels}
    new_clock = LoggerClock(
        logger=other.path.name,
        sha256=other.sha256,
        reference=reference.path.name,
        reference_sha256=reference.sha256,
        channels=tuple(name for name in names.values() if name not in theirs),
        alignment=alignment,
    )
    return [new_clock, *earlier]


def joined(parts: Sequence[Recording], *, follow_on: bool = False) -> Recording:
    """Return one recording from parts that one logger wrote one after the other.

    Attributes that all parts share are kept, and the clock maps of all of them. Closing it closes them all.

    Parameters
    ----------
    parts
        The parts in the order of their time, with the same channels.
    follow_on
        Whether each part begins with the sample after the last of the part before, whatever its clock says: for
        loggers that begin each file at zero.

    Raises
    ------
    ClockError
        If channels differ, or a part does not begin where the part before it ends.
    RecordingError
        If the clock maps of a part cannot be understood.
    """
    first = parts[0]
    for part in parts[1:]:
        if set(part.channels) != set(first.channels):
            other = sorted(set(part.channels) ^ set(first.channels))
            raise ClockError(
                f"{part.path}: expected the channels of {first.path}, found a difference in {', '.join(other)}; "
                "leave those channels out, or join other files."
            )
    channels = {name: _chain([(part, part.channels[name]) for part in parts], follow_on) for name in first.channels}
    shared = {
        name: value
        for name, value in first.attributes.items()
        if name != CLOCK_MAPS and all(part.attributes.get(name) == value for part in parts)
    }
    clocks = [clock for part in parts for clock in logger_clocks(part)]
    return _one(parts, channels, "joined", shared | clock_attributes(clocks))


def _chain(parts: Sequence[tuple[Recording, Channel]], follow_on: bool) -> Channel:
    """Return one channel from its parts."""
    first = parts[0][1]
    if any(channel.is_uneven for _, channel in parts):
        return _chain_of_messages(parts, follow_on)
    counts = [first.count]
    for recording, channel in parts[1:]:
        _expect_same(recording, channel, first)
        ends_s = first.start_s + sum(counts) / first.rate_hz
        if not follow_on and abs(channel.start_s - ends_s) * first.rate_hz > OFF_GRID:
            raise ClockError(
                f"{recording.path}, channel {channel.name}: expected it to begin at {ends_s:.4f} s, where the part "
                f"before it ends, found {channel.start_s:.4f} s; analyse parts with a gap one by one, or say that they "
                "follow on where each file begins at zero."
            )
        counts.append(channel.count)
    channels = [channel for _, channel in parts]
    begins = np.cumsum([0, *counts[:-1]]).tolist()
    jumps = tuple(
        replace(jump, sample=begin + jump.sample)
        for begin, channel in zip(begins, channels, strict=True)
        for jump in channel.clock_jumps
    )
    return replace(first, count=sum(counts), source=partial(_pieces, channels, Channel.read), clock_jumps=jumps)


def _chain_of_messages(parts: Sequence[tuple[Recording, Channel]], follow_on: bool) -> Channel:
    """Return one channel of messages from its parts; what is missing between two parts is a hole."""
    first = parts[0][1]
    moved = [first]
    for recording, channel in parts[1:]:
        _expect_same(recording, channel, first, same_rate=SAME_SENDER)
        ends_s = moved[-1].start_s + moved[-1].duration_s
        start_s = ends_s if follow_on else channel.start_s
        if start_s < ends_s - 1.0 / first.rate_hz:
            raise ClockError(
                f"{recording.path}, channel {channel.name}: expected it to begin after {ends_s:.4f} s, where the part "
                f"before it ends, found {start_s:.4f} s; say that the parts follow on where each file begins at zero."
            )
        moved.append(channel.on_other_clock(start_s=start_s, rate_hz=channel.rate_hz))
    return replace(
        first,
        count=sum(channel.count for channel in moved),
        source=partial(_pieces, moved, Channel.read),
        stamps=partial(_pieces, moved, Channel.stamps_s),
        is_uneven=True,
    )


def _pieces(
    channels: Sequence[Channel], read: Callable[[Channel, int, int], NDArray[Any]], start: int, stop: int
) -> NDArray[Any]:
    """Return what is read of samples [start, stop) of channels that follow one another."""
    begins = np.cumsum([0, *(channel.count for channel in channels)])
    chosen = [
        read(channel, max(start - begin, 0), min(stop - begin, channel.count))
        for begin, channel in zip(begins, channels, strict=False)
        if begin < stop and begin + channel.count > start
    ]
    return np.concatenate(chosen) if chosen else read(channels[0], 0, 0)


def _expect_same(recording: Recording, channel: Channel, first: Channel, same_rate: float = SAME_RATE) -> None:
    channel_format = (channel.unit, channel.scale, channel.offset, channel.read(0, 0).dtype)
    first_format = (first.unit, first.scale, first.offset, first.read(0, 0).dtype)
    if channel_format != first_format or abs(channel.rate_hz / first.rate_hz - 1.0) > same_rate:
        raise ClockError(
            f"{recording.path}, channel {channel.name}: expected {first.rate_hz:g} Hz, unit, scale and offset "
            f"{first_format[:3]} as in the part before it, found {channel.rate_hz:g} Hz and {channel_format[:3]}; "
            "these parts were not logged alike."
        )


def _one(
    parts: Sequence[Recording], channels: Mapping[str, Channel], kind: str, attributes: Mapping[str, str | float]
) -> Recording:
    digest = hashlib.sha256("".join(part.sha256 for part in parts).encode()).hexdigest()

    def release() -> None:
        for part in parts:
            part.close()

    return Recording(
        path=parts[0].path,
        sha256=digest,
        format=kind,
        channels=channels,
        remarks=tuple(dict.fromkeys(remark for part in parts for remark in part.remarks)),
        began=parts[0].began,
        attributes=attributes,
        release=release,
    )
