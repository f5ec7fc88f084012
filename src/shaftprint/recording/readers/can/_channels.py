"""Channels of the signals in a log of a CAN bus, each at the times of its own messages."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from shaftprint.errors import RecordingError
from shaftprint.files import kept_open
from shaftprint.recording._channel import Channel
from shaftprint.recording._spool import Spool
from shaftprint.recording.readers._clock import SampleClock, clock_of_times, kept_clocks, on_clock
from shaftprint.recording.readers._gather import names_in_words
from shaftprint.recording.readers.can._database import Database
from shaftprint.recording.readers.can._frames import EXTENDED, FrameLog, pgn_of, sender_of
from shaftprint.recording.readers.can._messages import Signal
from shaftprint.recording.readers.can._streams import Stream, Streams
from shaftprint.units import plain_unit

# More identifiers than this are counted together.
_MOST_LISTED = 20


@dataclass(frozen=True, kw_only=True, slots=True)
class Decoded:
    """What a log of a bus holds."""

    named: tuple[tuple[str, str], ...]
    """Message, with what tells it from others, and name of each signal."""
    make: tuple[Callable[[str], Channel], ...]
    """Gives the channel of each signal under the name that it is to have."""
    left_out: Callable[[tuple[str, ...]], Mapping[str, str]]
    """Gives what is left out, and why, once the signals have their names."""
    close: Callable[[], None]
    """Gives the temporary file back."""


def decoded(path: Path, log: FrameLog, database: Database) -> Decoded:
    """Take a log apart, which is gone through once.

    ``path``: the file. ``log``: its frames. ``database``: what they hold. Raises RecordingError if the log is longer
    unpacked than such a file can be.
    """
    with kept_open(Spool(path, [])) as spool:
        streams = Streams(path=path, log=log, database=database, spool=spool)
        streams.fill()
    signals = [(stream, signal) for stream in streams.streams.values() for signal in stream.tallies]
    clock_of = kept_clocks(partial(_clock, streams))
    return Decoded(
        named=tuple(_named(streams, signals)),
        make=tuple(partial(_channel, streams, clock_of, stream, signal) for stream, signal in signals),
        left_out=partial(_left_out, streams, signals),
        close=spool.close,
    )


def _named(streams: Streams, signals: list[tuple[Stream, Signal]]) -> Iterator[tuple[str, str]]:
    """Yield group and name of each signal, with the bus and the instance where there are several."""
    is_one_bus = len({stream.origin.bus for stream, _ in signals}) <= 1
    instances: dict[str, set[int | None]] = {}
    for stream, _ in signals:
        instances.setdefault(stream.origin.name, set()).add(stream.instance)
    for stream, signal in signals:
        bus = "" if is_one_bus else f"{streams.log.name_of(stream.origin.bus)} "
        is_one = len(instances[stream.origin.name]) <= 1
        yield f"{bus}{stream.origin.label}", f"{signal.name}{'' if is_one else f', instance {stream.instance}'}"


def _channel(
    streams: Streams,
    clock_of: Callable[[Stream], SampleClock],
    stream: Stream,
    signal: Signal,
    name: str,
) -> Channel:
    tally = stream.tallies[signal]
    if tally.is_all_outside:
        raise RecordingError(
            f"all {tally.outside} values lie outside the range [{signal.lowest:g}, {signal.highest:g}] of "
            f"{streams.database.name}; correct it there, or write [0|0] for none."
        )
    clock = clock_of(stream)
    channel = Channel(
        name=name,
        unit=plain_unit(signal.unit),
        rate_hz=clock.rate_hz,
        start_s=clock.start_s,
        count=stream.count,
        source=streams.values(stream, signal),
        long_name=_long_name(signal),
    )
    return on_clock(channel, clock)


def _clock(streams: Streams, stream: Stream) -> SampleClock:
    return clock_of_times(streams.path, f"times of {stream.origin.label}", stream.count, streams.times(stream))


def _long_name(signal: Signal) -> str:
    if signal.spn is None:
        return signal.comment[:200]
    return f"SPN {signal.spn}{': ' if signal.comment else ''}{signal.comment}"[:200]


def _left_out(streams: Streams, signals: list[tuple[Stream, Signal]], names: tuple[str, ...]) -> dict[str, str]:
    left_out = dict(streams.database.left_out)
    empty = []
    for (stream, signal), name in zip(signals, names, strict=True):
        tally = stream.tallies[signal]
        if tally.is_empty:
            empty.append(name)
        elif counted := tally.counted():
            left_out[f"values of {name}"] = counted
    if empty:
        left_out[f"values of {len(empty)} channels"] = (
            f"in no message there is one: {names_in_words(empty, most=_MOST_LISTED)}."
        )
    for origin, number in streams.packets.lost.items():
        left_out[f"packets of {getattr(origin, 'label', '')}"] = f"{number} are not whole."
    listed = sorted(streams.unknown.items(), key=lambda item: -item[1])
    for (bus, identifier), number in listed[:_MOST_LISTED]:
        left_out[f"{streams.log.name_of(bus)} {_in_words(identifier)}"] = (
            f"{number} frames, which {_knower(streams.database)}."
        )
    further = listed[_MOST_LISTED:]
    if further:
        left_out[f"{len(further)} further identifiers"] = (
            f"{sum(number for _, number in further)} frames, which {_knower(streams.database)}."
        )
    left_out |= {kind: f"{number}, which hold no values." for kind, number in streams.log.others.items()}
    return left_out


def _knower(database: Database) -> str:
    return f"{database.name} does not know" if database.name else "nothing says of"


def _in_words(identifier: int) -> str:
    if not identifier & EXTENDED:
        return f"identifier {identifier:03X}"
    number = identifier & ~EXTENDED
    return f"identifier {number:08X} (group {pgn_of(number)}, sender 0x{sender_of(number):x})"
