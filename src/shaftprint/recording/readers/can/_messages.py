"""What a message of a CAN bus holds: signals, and where in its bytes they stand."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from shaftprint.recording.readers.can._frames import EXTENDED

MOST_BYTES = 223
"""Bytes of the longest message, a fast packet of NMEA 2000."""
_WORD = 64


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class BitField:
    """Bits of a message that are one count."""

    start: int
    """Its first bit: the lowest, or of a big-endian one the highest, counted within each byte from the lowest."""
    bits: int
    """How many it has."""
    is_big_endian: bool = False
    """Whether its first byte is the highest."""

    @property
    def first_bit(self) -> int:
        """Its first bit as it is counted: that of a big-endian one from the highest bit of the first byte on."""
        return self.start - self.start % 8 + 7 - self.start % 8 if self.is_big_endian else self.start

    @property
    def last_byte(self) -> int:
        """Number of the last byte that holds some of it."""
        return (self.first_bit + self.bits - 1) // 8

    @property
    def is_within_message(self) -> bool:
        """Whether a message can be so long."""
        return self.start >= 0 and self.last_byte < MOST_BYTES


@dataclass(frozen=True, kw_only=True, slots=True)
class Selection(BitField):
    """Which messages hold a signal: those where another signal, the multiplexer, has certain counts.

    It has no bits where nobody knows which signal that is.
    """

    ranges: tuple[tuple[int, int], ...] = ()
    """First and last count that select."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Signal(BitField):
    """One signal of a message."""

    name: str
    """Its name."""
    unit: str = ""
    """Unit of its values."""
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
    def can_be_read(self) -> bool:
        """Whether it is a number that is not longer than a word, in messages that can be told."""
        lengths = (32, 64) if self.is_float else range(1, _WORD + 1)
        is_told = all(0 < selection.bits <= _WORD and selection.is_within_message for selection in self.where)
        return self.bits in lengths and self.is_within_message and is_told


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

    @property
    def marked_identifier(self) -> int:
        """Its identifier, with the mark of 29 bits where it has them."""
        return self.identifier | (EXTENDED if self.is_extended else 0)

    @property
    def last_byte(self) -> int:
        """Number of the last byte that says something, of signals and multiplexers; 0 without any."""
        return max((bits.last_byte for signal in self.signals for bits in (signal, *signal.where)), default=0)


def counts_of(bit_field: BitField, content: NDArray[np.uint8]) -> NDArray[np.uint64]:
    """Return the bits of a signal or multiplexer as counts without sign, shape (messages,).

    ``bit_field``: where it stands. ``content``: bytes, shape (messages, bytes), at least up to its last byte.
    """
    first, bits = bit_field.first_bit, bit_field.bits
    whole = [content[:, byte].astype(np.uint64) for byte in range(first // 8, bit_field.last_byte + 1)]
    mask = np.uint64((1 << bits) - 1)
    value = np.zeros(len(content), dtype=np.uint64)
    if bit_field.is_big_endian:
        shift = 7 - (first + bits - 1) % 8
        for byte in whole[:8]:
            value = value << np.uint64(8) | byte
        if len(whole) > 8:
            return (value << np.uint64(8 - shift) | whole[8] >> np.uint64(shift)) & mask
        return value >> np.uint64(shift) & mask
    shift = first % 8
    for number, byte in enumerate(whole[:8]):
        value |= byte << np.uint64(8 * number)
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
    for selection in where:
        counts = counts_of(selection, content)
        chosen &= np.any([(counts >= max(low, 0)) & (counts <= max(high, 0)) for low, high in selection.ranges], axis=0)
    return chosen
