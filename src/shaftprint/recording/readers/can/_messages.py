"""What a message of a CAN bus holds: signals, and where in its bytes they stand."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

MOST_BYTES = 223
"""Bytes of the longest message, a fast packet of NMEA 2000."""
_WORD = 64


@dataclass(frozen=True, kw_only=True, slots=True)
class Selection:
    """Which messages hold a signal: those where another signal, the multiplexer, has certain counts."""

    start: int
    """First bit of the multiplexer."""
    bits: int
    """Its length; 0 where nobody knows which signal it is."""
    is_big_endian: bool = False
    """Whether its first byte is the highest."""
    ranges: tuple[tuple[int, int], ...] = ()
    """First and last count that select."""

    @property
    def last_byte(self) -> int:
        """Number of the last byte that holds some of the multiplexer."""
        return _last_byte(self.start, self.bits, is_big_endian=self.is_big_endian)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Signal:
    """One signal of a message."""

    name: str
    """Its name."""
    start: int
    """Its first bit: the lowest, or of a big-endian one the highest, counted within each byte from the lowest."""
    bits: int
    """How many it has."""
    unit: str = ""
    """Unit of its values."""
    is_big_endian: bool = False
    """Whether its first byte is the highest."""
    is_signed: bool = False
    """Whether its counts have a sign."""
    is_float: bool = False
    """Whether its bits are a number with a point."""
    factor: float = 1.0
    """Value of one count [unit]."""
    offset: float = 0.0
    """Value at count zero [unit]."""
    lowest: float = -np.inf
    """Smallest value [unit]."""
    highest: float = np.inf
    """Largest value [unit]."""
    spn: int | None = None
    """Its number in SAE J1939-71, such as 190 for the engine speed; None where the file has none."""
    comment: str = ""
    """What it is, in words."""
    texts: Mapping[int, str] = field(default_factory=dict)
    """What some of its counts are called."""
    where: tuple[Selection, ...] = ()
    """Which messages hold it; all of them where there is none."""

    @property
    def last_byte(self) -> int:
        """Number of the last byte that holds some of it."""
        return _last_byte(self.start, self.bits, is_big_endian=self.is_big_endian)

    @property
    def can_be_read(self) -> bool:
        """Whether it is a number that is not longer than a word, in messages that can be told."""
        floats = (32, 64) if self.is_float else range(1, _WORD + 1)
        if self.start < 0 or self.bits not in floats or self.last_byte >= MOST_BYTES:
            return False
        return all(0 < one.bits <= _WORD and one.start >= 0 and one.last_byte < MOST_BYTES for one in self.where)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Message:
    """One message."""

    name: str
    """Its name."""
    signals: tuple[Signal, ...]
    """What it holds."""
    identifier: int
    """Its identifier, without the mark of 29 bits."""
    is_extended: bool = True
    """Whether that has 29 bits."""
    is_j1939: bool = False
    """Whether the file says that it is one of SAE J1939."""
    is_of_any_sender: bool = False
    """Whether it is known by its parameter group, whoever sends it."""
    is_fast: bool = False
    """Whether it comes in several frames, a fast packet of NMEA 2000."""
    instance: Signal | None = None
    """Which signal says of which engine, gearbox or rudder the others are."""


def counts_of(signal: Signal, content: NDArray[np.uint8]) -> NDArray[Any]:
    """Return the bits of a signal as counts without sign, shape (messages,).

    Parameters
    ----------
    signal
        Where it stands.
    content
        Bytes, shape (messages, bytes), at least up to the signal's last byte.
    """
    return bits_of(content, signal.start, signal.bits, is_big_endian=signal.is_big_endian)


def bits_of(content: NDArray[np.uint8], start: int, bits: int, *, is_big_endian: bool) -> NDArray[np.uint64]:
    """Return bits of messages as numbers without sign; see `counts_of`."""
    first = _first_of_big_endian(start) if is_big_endian else start
    first_byte, last_byte = first // 8, (first + bits - 1) // 8
    whole = [content[:, byte].astype(np.uint64) for byte in range(first_byte, last_byte + 1)]
    mask = np.uint64((1 << bits) - 1)
    value = np.zeros(len(content), dtype=np.uint64)
    if is_big_endian:
        shift = 7 - (first + bits - 1) % 8
        for byte in whole[:8]:
            value = value << np.uint64(8) | byte
        if len(whole) > 8:
            return (value << np.uint64(8 - shift) | whole[8] >> np.uint64(shift)) & mask
        return value >> np.uint64(shift) & mask
    shift = first % 8
    for place, byte in enumerate(whole[:8]):
        value |= byte << np.uint64(8 * place)
    value >>= np.uint64(shift)
    if len(whole) > 8:
        value |= whole[8] << np.uint64(_WORD - shift)
    return value & mask


def numbers_of_counts(signal: Signal, counts: NDArray[np.uint64]) -> NDArray[Any]:
    """Return counts with their sign, or the numbers whose bits they are; not scaled."""
    if signal.is_float:
        word = counts.astype(np.uint32).view(np.float32) if signal.bits == 32 else counts.view(np.float64)
        return word.astype(np.float64)
    if not signal.is_signed:
        return counts
    unused = np.uint64(_WORD - signal.bits)
    return (counts << unused).view(np.int64) >> np.int64(unused)


def selected(where: tuple[Selection, ...], content: NDArray[np.uint8]) -> NDArray[np.bool_]:
    """Return which messages hold a signal."""
    chosen = np.ones(len(content), dtype=bool)
    for one in where:
        counts = bits_of(content, one.start, one.bits, is_big_endian=one.is_big_endian)
        chosen &= np.any([(counts >= max(low, 0)) & (counts <= max(high, 0)) for low, high in one.ranges], axis=0)
    return chosen


def _last_byte(start: int, bits: int, *, is_big_endian: bool) -> int:
    return ((_first_of_big_endian(start) if is_big_endian else start) + bits - 1) // 8


def _first_of_big_endian(start: int) -> int:
    """Return the place of a highest bit, where bits are counted from the highest of the first byte on."""
    return start - start % 8 + 7 - start % 8
