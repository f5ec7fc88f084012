"""The journal of a live test, whole or broken off: lost blocks are samples that are not numbers."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from shaftprint.errors import RecordingError
from shaftprint.escape import printable
from shaftprint.recording._channel import Channel, ClockJump, Source
from shaftprint.recording._journal import MARK, Journal, JournalBlock, read_journal
from shaftprint.recording._recording import Recording, sha256_of
from shaftprint.recording.readers._hints import expect_hints

NAME = "shaftprint journal of a live test"

# Blocks of one clock follow each other within this share of a block.
_SAME_CLOCK = 0.5
# A clock that is far off is off by a per cent; this is another rate.
_SAME_RATE = 0.1
# More lost time than this is a counter that began again [s].
_MOST_LOST_S = 3600.0


def is_mine(path: Path) -> bool:
    """Return whether the file begins as a journal does."""
    with path.open("rb") as file:
        return file.read(len(MARK)) == MARK


def read(path: Path, **hints: object) -> Recording:
    """Open a journal; samples are read as channels are asked for them.

    A channel whose rate is not that of its samples is left out. Raises RecordingError if the journal is damaged before
    its last block, has no block, or no channel is left.
    """
    expect_hints(path, hints, {})
    journal = read_journal(path)
    if not journal.blocks:
        raise RecordingError(f"{path}: expected blocks in the journal, found none.")
    channels: dict[str, Channel] = {}
    left_out: dict[str, str] = {}
    for number, stated in enumerate(journal.head["channels"]):
        if reason := _other_rate(journal.blocks, number, stated):
            left_out[stated["name"]] = reason
        else:
            channels[stated["name"]] = _channel(path, journal, number, stated)
    if not channels:
        raise RecordingError(f"{path}: {next(iter(left_out.values()))}")
    torn = journal.torn_bytes
    return Recording(
        path=path,
        sha256=sha256_of(path),
        format=NAME,
        channels=channels,
        left_out=left_out,
        attributes={name: value for name, value in journal.head.items() if isinstance(value, str | float)},
        remarks=(f"{path}: the last block was being written when the program ended, {torn} bytes are left out.",)
        if torn
        else (),
    )


def _channel(path: Path, journal: Journal, number: int, stated: Mapping[str, Any]) -> Channel:
    """Return one channel; where blocks were lost its samples are not numbers, and it is no longer counts."""
    rate_hz = float(stated["rate_hz"])
    pieces, jumps = _pieces(journal.blocks, number, rate_hz)
    dtype = np.dtype(stated["dtype"])
    lossless = all(place >= 0 for place, _ in pieces)
    counts = lossless or dtype != np.int16
    scale, offset = float(stated["scale"]), float(stated["offset"])
    source = _source(path, pieces, dtype)
    return Channel(
        name=str(stated["name"]),
        unit=str(stated["unit"]),
        rate_hz=rate_hz,
        start_s=0.0,
        count=sum(count for _, count in pieces),
        scale=scale if counts else 1.0,
        offset=offset if counts else 0.0,
        long_name=str(stated.get("long_name", "")),
        source=source if counts else _scaled(source, scale, offset),
        clock_jumps=tuple(jumps),
    )


def _other_rate(blocks: Sequence[JournalBlock], number: int, stated: Mapping[str, Any]) -> str:
    """Return why a rate is not that of the samples: times, and samples that were lost, would be made up by it."""
    rate_hz = float(stated["rate_hz"])
    span_s, count = sum(one.span_s for one in blocks), sum(one.places[number][1] for one in blocks)
    expected = rate_hz * span_s
    # a slow channel may begin late, and has a sample now and then
    if rate_hz > 0.0 and (not count or abs(count - expected) <= max(2.0, _SAME_RATE * expected)):
        return ""
    return (
        f"expected about {expected:.6g} samples of channel {printable(stated['name'])} in {span_s:.6g} s by its rate "
        f"of {rate_hz:g} Hz, found {count}; is that its rate, and did it come all the time?"
    )


def _pieces(
    blocks: Sequence[JournalBlock], number: int, rate_hz: float
) -> tuple[list[tuple[int, int]], list[ClockJump]]:
    """Return place and number of the samples of a channel, piece by piece, -1 for lost ones; and jumps of the clock."""
    pieces: list[tuple[int, int]] = []
    jumps: list[ClockJump] = []
    done, before = 0, None
    for block in blocks:
        if before is not None:
            lost = block.counter - before.counter - 1
            if lost < 0:
                continue
            if 0 < lost * before.span_s <= _MOST_LOST_S:
                missing = round(lost * before.span_s * rate_hz)
                pieces.append((-1, missing))
                done += missing
            jump_s = block.source_s - (before.source_s + before.span_s * (1 + max(lost, 0)))
            if abs(jump_s) > _SAME_CLOCK * block.span_s:
                jumps.append(ClockJump(sample=done, jump_s=jump_s))
        pieces.append(block.places[number])
        done += block.places[number][1]
        before = block
    return [piece for piece in pieces if piece[1]], jumps


def _source(path: Path, pieces: Sequence[tuple[int, int]], dtype: np.dtype[Any]) -> Source:
    ends = np.cumsum([count for _, count in pieces])
    of_samples = np.dtype(np.float64) if any(place < 0 for place, _ in pieces) else dtype

    def read_samples(start: int, stop: int) -> NDArray[Any]:
        first = int(np.searchsorted(ends, start, side="right"))
        taken = np.empty(stop - start, dtype=of_samples)
        with path.open("rb") as file:
            done = start
            while done < stop:
                place, count = pieces[first]
                begin = done - (int(ends[first]) - count)
                part = min(count - begin, stop - done)
                if place < 0:
                    taken[done - start : done - start + part] = np.nan
                else:
                    file.seek(place + begin * dtype.itemsize)
                    taken[done - start : done - start + part] = np.frombuffer(file.read(part * dtype.itemsize), dtype)
                done += part
                first += 1
        return taken

    return read_samples


def _scaled(source: Source, scale: float, offset: float) -> Source:
    return lambda start, stop: source(start, stop) * scale + offset
