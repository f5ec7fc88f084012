"""The blocks of an imc file and their parameters.

``|CN,1,19,0,0,0,8,ACC_long,0,;`` is a key, its version, a length, and so many bytes of parameters; a text stands behind
its length, so that it may hold commas. Source: Manual for imc Shared Components, imc Test & Measurement, imc data
format.
"""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

from shaftprint.errors import RecordingError
from shaftprint.escape import printable

BEGIN = b"|CF,"
SAMPLES = "CS"
"""Key of the block that holds samples."""
_HEAD, _LONGEST_HEAD = re.compile(rb"\|([A-Z][A-Za-z]), *(\d{1,4}), *(\d{1,18}),"), 64
_BETWEEN, _LONGEST_SPACE, _END = b"\r\n\t \0", 4096, b";"
# What is before the samples in their own block; other blocks hold texts and a few numbers.
_BEFORE_SAMPLES, _LONGEST = 80, 2**24


@dataclass(frozen=True, kw_only=True, slots=True)
class Block:
    """One block of a file."""

    key: str
    """Two letters."""
    version: int
    """Version of its parameters."""
    begin: int
    """Place of its parameters in the file [bytes]."""
    length: int
    """Length of its parameters as it states it [bytes]."""
    content: bytes
    """Its parameters; of samples only the first of them."""


def blocks_of(path: Path, file: BinaryIO) -> Iterator[Block]:
    """Yield the blocks of a file; samples may end beyond a file that is cut off.

    Raises RecordingError if a block does not begin or end where the one before it says.
    """
    size, place = path.stat().st_size, 0
    while (place := _next_place(file, place)) < size:
        file.seek(place)
        head = _HEAD.match(file.read(_LONGEST_HEAD))
        if head is None:
            file.seek(place)
            found = printable(file.read(12).decode("latin-1"))
            raise RecordingError(
                f'{path}: expected a block of the format 2 at byte {place}, found "{found}"; the file is damaged, '
                "copy it again from the logger."
            )
        key, version, length = head[1].decode(), int(head[2]), int(head[3])
        begin = place + head.end()
        end = begin + length
        file.seek(begin)
        content = file.read(min(length, _BEFORE_SAMPLES if key == SAMPLES else _LONGEST))
        file.seek(end)
        is_cut = end >= size
        if (is_cut and key != SAMPLES) or (not is_cut and file.read(1) != _END):
            raise RecordingError(
                f"{path}: expected the end of the block {key} at byte {end}, found none; the file is damaged or cut "
                "off, copy it again from the logger."
            )
        yield Block(key=key, version=version, begin=begin, length=length, content=content)
        place = end + 1


def _next_place(file: BinaryIO, place: int) -> int:
    """Return where the next block begins; what fills the space between blocks is passed over."""
    file.seek(place)
    while between := file.read(_LONGEST_SPACE):
        rest = between.lstrip(_BETWEEN)
        place += len(between) - len(rest)
        if rest:
            break
    return place


class Parameters:
    """The parameters of a block, one after the other; a ``ValueError`` where one is not what it has to be."""

    def __init__(self, content: bytes) -> None:
        """Begin with the first of them."""
        self._content = content
        self.place = 0

    def word(self) -> str:
        """Return the next parameter as it stands."""
        if self.place > len(self._content):
            raise ValueError("a block has too few parameters")
        end = self._content.find(b",", self.place)
        end = len(self._content) if end < 0 else end
        word = self._content[self.place : end].decode("ascii").strip()
        self.place = end + 1
        return word

    def whole(self) -> int:
        """Return the next parameter, a whole number."""
        return int(self.word())

    def number(self) -> float:
        """Return the next parameter, a finite number."""
        number = float(self.word())
        if not math.isfinite(number):
            raise ValueError(f"a parameter is {number}")
        return number

    def text(self, encoding: str) -> str:
        """Return the next text, which stands behind its length."""
        length = self.whole()
        end = self.place + length
        if length < 0 or self._content[end : end + 1] not in (b",", b"") or end > len(self._content):
            raise ValueError(f"a text is not of {length} bytes, as it says")
        text = self._content[self.place : end].decode(encoding, "replace")
        self.place = end + 1
        return text.strip()

    def skip_words(self, count: int) -> None:
        """Pass over some parameters."""
        for _ in range(count):
            self.word()

    def skip(self, count: int) -> None:
        """Pass over some bytes and the comma behind them."""
        self.place += count + 1
