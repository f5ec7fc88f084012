"""The samples of a component of an imc file: numbers side by side, or those of several channels in turn."""

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from shaftprint.errors import RecordingError
from shaftprint.recording.readers._damage import expect_no_blanks
from shaftprint.recording.readers.imc._layout import Component, Packing, Scale, Stored

_COUNTS, _DIGITAL = 4, 11
_TYPES = {
    1: "u1", 2: "i1", 3: "<u2", _COUNTS: "<i2", 5: "<u4", 6: "<i4", 7: "<f4", 8: "<f8",
    _DIGITAL: "<u2", 12: "<u8", 13: "6u1", 14: "<i8",
}  # fmt: skip
_FLOATS, _LOOKED_AT = (7, 8), 100_000
_OTHER_TYPES = {9: "a transitional recording", 10: "times as text"}


@dataclass(frozen=True, kw_only=True, slots=True)
class Samples:
    """Where samples lie, and what makes numbers of them."""

    count: int
    """How many there are."""
    file: BinaryIO
    begin: int
    """Place of the first in the file [bytes]."""
    packing: Packing
    bit: int
    """Number of the bit that is meant; 0 for the whole."""
    scale: Scale

    @property
    def is_counts(self) -> bool:
        """Whether they are counts of 16 bits, which are read without their scale."""
        return self.packing.kind == _COUNTS and not self.packing.mask

    def expect_no_blanks(self, path: Path) -> None:
        """Refuse numbers in which zeros have become blanks, by the first of them.

        Raises RecordingError if they have.
        """
        if self.packing.kind in _FLOATS and not self.packing.apart:
            self.file.seek(self.begin)
            content = self.file.read(min(self.count, _LOOKED_AT) * self.packing.size)
            expect_no_blanks(path, content, self.packing.size)

    def read(self, start: int, stop: int) -> NDArray[Any]:
        """Return the samples [start, stop): counts of 16 bits as they are, others in their unit.

        Raises RecordingError if the file has become shorter.
        """
        dtype = np.dtype(_TYPES[self.packing.kind])
        step = self.packing.size + self.packing.apart
        length = max((stop - start) * step - self.packing.apart, 0)
        self.file.seek(self.begin + start * step)
        content = self.file.read(length)
        if len(content) != length:
            raise RecordingError(f"samples [{start}, {stop}) are missing; is the file cut?")
        parts = (1,) * len(dtype.shape)
        numbers = np.ndarray(
            (stop - start, *dtype.shape), dtype.base, content, strides=(step, *parts) if parts else step
        )
        if parts:
            numbers = numbers.astype(np.int64) @ (1 << 8 * np.arange(dtype.itemsize))
        if self.is_counts:
            return numbers.copy()
        if self.packing.mask:
            numbers = numbers & ~np.array(self.packing.mask).astype(numbers.dtype)
        if self.bit:
            numbers = (numbers >> (self.bit - 1)) & 1
        return numbers.astype(np.float64) * self.scale.factor + self.scale.offset


def samples_of(component: Component, blocks: Mapping[int, Stored], file: BinaryIO, bit: int) -> Samples:
    """Return the samples of a component.

    ``blocks``: blocks of samples by their numbers. ``file``: the open file. ``bit``: number of a bit of digital words.
    Raises RecordingError if they are of a kind that is not read or beyond the end of the file; a ``ValueError`` where
    the file contradicts itself.
    """
    packing, scale = component.packing, component.scale
    if packing is None or not component.buffers:
        raise RecordingError("expected a place of its samples, found none")
    _expect_known(component, packing)
    buffer = component.buffers[0]
    stored = blocks.get(buffer.block)
    if stored is None or stored.is_packed:
        raise RecordingError(f"expected samples, found {'none' if stored is None else 'compressed ones'}")
    if buffer.offset + buffer.filled > stored.length:
        raise ValueError(f"buffer {buffer.number} ends beyond its samples")
    step = packing.size + packing.apart
    count = max(buffer.filled - packing.offset + packing.apart, 0) // step
    begin = stored.begin + buffer.offset + packing.offset
    end, size = begin + count * step - packing.apart, os.fstat(file.fileno()).st_size
    if count == 0 or end > size:
        found = "none" if count == 0 else f"the file cut off at byte {size} of {end}; copy it again from the logger"
        raise RecordingError(f"expected samples, found {found}")
    return Samples(
        count=count,
        file=file,
        begin=begin,
        packing=packing,
        bit=bit if packing.kind == _DIGITAL else 0,
        scale=scale,
    )


def _expect_known(component: Component, packing: Packing) -> None:
    """Refuse samples whose form is not read.

    Raises RecordingError if it is so; a ``ValueError`` where the file contradicts itself.
    """
    of_axis = component.axis is not None and component.axis.has_events
    if len(component.buffers) > 1 or component.has_events or of_axis:
        raise RecordingError(
            "expected one stretch of samples, found that the trigger came several times; save each event in a file of "
            "its own"
        )
    if packing.kind not in _TYPES:
        found = _OTHER_TYPES.get(packing.kind, f"the type {packing.kind}")
        raise RecordingError(f"expected numbers, found {found}; export it as numbers")
    if component.buffers[0].first or packing.together != 1:
        raise RecordingError("expected samples in a row, found a ring or groups of them; save it again in FAMOS")
    if component.scale.factor == 0.0:
        raise RecordingError("expected a scale other than 0, found 0")
    dtype = np.dtype(_TYPES[packing.kind])
    if packing.size != dtype.itemsize:
        raise ValueError(f"numbers of type {packing.kind} are said to have {packing.size} bytes")
    if packing.mask and dtype.base.kind == "f":
        raise ValueError("bits are masked in numbers that are no whole ones")
