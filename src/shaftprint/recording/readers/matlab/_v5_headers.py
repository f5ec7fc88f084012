"""What a MATLAB file of version 5 to 7 holds, from the headers of its variables alone.

The layout is that of MathWorks' "MAT-File Format", chapter "Level 5 MAT-File Format": elements of a tag and data,
packed ones unpacked as far as the header goes. SciPy's own list of variables stops at objects, which have no size.
"""

import math
import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

_FIRST_VARIABLE = 128
_MATRIX, _PACKED = 14, 15
# Enough for the flags, sizes and names of any header.
_HEADER_BYTES = 4096
_OPAQUE = 17
_CLASSES = {
    1: "cell", 2: "struct", 3: "object", 4: "char", 5: "sparse", 6: "double", 7: "single", 8: "int8", 9: "uint8",
    10: "int16", 11: "uint16", 12: "int32", 13: "uint32", 14: "int64", 15: "uint64", 16: "function", 17: "object",
    18: "object",
}  # fmt: skip
_LOGICAL = 0x0200
# Types of elements besides variables.
_TYPES = frozenset({1, 2, 3, 4, 5, 6, 7, 9, 12, 13, 16, 17, 18})
_DEEPEST = 50


@dataclass(frozen=True, kw_only=True, slots=True)
class MatHeader:
    """The header of one variable."""

    name: str
    """Its name."""
    kind: str
    """Its class, such as ``double``, ``logical`` or, of an object, ``timetable``."""
    shape: tuple[int, ...]
    """Its size; empty of an object, whose size is not published."""
    is_object: bool
    """Whether only MATLAB can open it."""

    @property
    def size(self) -> int:
        """Number of its elements."""
        return math.prod(self.shape)


def headers_of(path: Path) -> Iterator[MatHeader]:
    """Return the header of every variable in the order of the file; those without a name are MATLAB's own.

    Raises ValueError if the file is damaged; zlib.error, struct.error if a packed variable or a tag is.
    """
    with path.open("rb") as file:
        order = "<" if file.read(_FIRST_VARIABLE).endswith(b"IM") else ">"
        while tag := file.read(8):
            kind, length = struct.unpack(f"{order}2I", tag)
            begin = file.tell()
            if kind not in (_MATRIX, _PACKED):
                raise ValueError(f"expected a variable at byte {begin - 8}, found an element of type {kind}")
            try:
                header = _header(_begin_of(file, kind == _PACKED, length), order)
            except struct.error:
                raise ValueError(f"the variable at byte {begin - 8} is cut off in its header") from None
            if kind == _MATRIX and not header.is_object:
                _expect_known_types(file, begin, begin + length, order)
            if header.name:
                yield header
            file.seek(begin + length)


def _expect_known_types(file: BinaryIO, begin: int, end: int, order: str, depth: int = 0) -> None:
    """Refuse a variable that is not packed where an element in it is of a type that there is not, or longer than it."""
    at = begin
    while at < end:
        file.seek(at)
        first, length = struct.unpack(f"{order}2I", file.read(8))
        is_short = bool(first >> 16)
        kind, length = (first & 0xFFFF, first >> 16) if is_short else (first, length)
        if (kind != _MATRIX and kind not in _TYPES) or (not is_short and at + 8 + length > end) or depth > _DEEPEST:
            raise ValueError(f"expected an element of a variable at byte {at}, found type {kind}, {length} bytes")
        if kind == _MATRIX:
            _expect_known_types(file, at + 8, at + 8 + length, order, depth + 1)
        at += 8 if is_short else 8 + (length + 7) // 8 * 8


def _begin_of(file: BinaryIO, is_packed: bool, length: int) -> bytes:
    """Return the begin of a variable's content, behind its tag."""
    packed = file.read(min(length, _HEADER_BYTES))
    # what is packed brings its own tag
    return zlib.decompressobj().decompress(packed, _HEADER_BYTES)[8:] if is_packed else packed


def _header(content: bytes, order: str) -> MatHeader:
    (flags, _), offset = struct.unpack_from(f"{order}2I", content, 8), 16
    number, is_logical = flags & 0xFF, bool(flags & _LOGICAL)
    kind = _CLASSES.get(number, "object")
    if number == _OPAQUE:
        (name, _, kind), _ = _texts(content, offset, order, 3)
        return MatHeader(name=name, kind=kind, shape=(), is_object=True)
    sizes, offset = _element(content, offset, order)
    shape = struct.unpack(f"{order}{len(sizes) // 4}i", sizes)
    if min(shape, default=0) < 0:
        raise ValueError(f"expected sizes that are not negative, found {shape[:3]}")
    (name,), offset = _texts(content, offset, order, 1)
    is_object = kind in ("object", "function")
    if number == 3:
        (kind,), _ = _texts(content, offset, order, 1)
    return MatHeader(name=name, kind="logical" if is_logical else kind, shape=shape, is_object=is_object)


def _texts(content: bytes, offset: int, order: str, count: int) -> tuple[list[str], int]:
    texts = []
    for _ in range(count):
        data, offset = _element(content, offset, order)
        texts.append(data.decode("utf-8", "replace"))
    return texts, offset


def _element(content: bytes, offset: int, order: str) -> tuple[bytes, int]:
    """Return the data of one element and where the next begins; up to four bytes stand within the tag."""
    (first,) = struct.unpack_from(f"{order}I", content, offset)
    if first >> 16:
        return content[offset + 4 : offset + 4 + min(first >> 16, 4)], offset + 8
    (length,) = struct.unpack_from(f"{order}I", content, offset + 4)
    if offset + 8 + length > len(content):
        raise ValueError(f"expected a header of at most {_HEADER_BYTES} bytes")
    return content[offset + 8 : offset + 8 + length], offset + 8 + (length + 7) // 8 * 8
