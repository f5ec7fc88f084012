"""A form with files, read as it comes: fields first, then each file in pieces; nothing is put aside on the way.

Libraries put the file into a temporary folder first, and read it from there once more. The form of the upload page has
its files last, so that all fields are known when it begins (RFC 7578).
"""

import re
from collections.abc import AsyncIterator
from dataclasses import dataclass, field
from typing import Final

from starlette.exceptions import HTTPException

_BOUNDARY: Final = re.compile(
    r'^multipart/form-data\s*;.*?\bboundary=(?:"([^"]{1,70})"|([^\s;"]{1,70}))', re.IGNORECASE
)
_NAME: Final = re.compile(rb'[;\s]name="([^"]*)"', re.IGNORECASE)
_FILE_NAME: Final = re.compile(rb'[;\s]filename="([^"]*)"', re.IGNORECASE)
_LINE, _LAST = b"\r\n", b"--"
MOST_FILES: Final = 20
"""Files of one form."""
_MOST_HEAD, _MOST_FIELD, _MOST_FIELDS = 4096, 8192, 40


@dataclass(slots=True)
class FormWithFile:
    """A form that is being read."""

    pieces: AsyncIterator[bytes]
    """What comes in."""
    boundary: bytes
    """What stands between its parts."""
    fields: dict[str, str] = field(default_factory=dict)
    """Fields that came before the file."""
    file_name: str = ""
    """Name of the file."""
    _kept: bytes = b""

    async def read_fields(self) -> None:
        """Read all fields before the file.

        Raises HTTPException if it is no such form, or has no file.
        """
        # the first boundary has no line before it
        self._kept = b"\r\n"
        await self._until(self.boundary, most=_MOST_HEAD)
        for _ in range(_MOST_FIELDS):
            head = await self._until(b"\r\n\r\n", most=_MOST_HEAD)
            if head.startswith(b"--"):
                break
            name, file_name = _NAME.search(head), _FILE_NAME.search(head)
            if name is None:
                raise _no_form()
            if file_name is not None:
                self.file_name = file_name[1].decode("utf-8", "replace")
                return
            value = await self._until(self.boundary, most=_MOST_FIELD)
            self.fields[name[1].decode("utf-8", "replace")] = value.decode("utf-8", "replace")
        raise HTTPException(400, "Expected a form with a file as its last field, found none.")

    async def file(self) -> AsyncIterator[bytes]:
        """Give the file in pieces.

        Raises HTTPException if it is cut off.
        """
        while True:
            found = self._kept.find(self.boundary)
            if found >= 0 and len(self._kept) < found + len(self.boundary) + len(_LINE):
                # what follows says whether it is a boundary
                await self._more()
                continue
            if found >= 0 and self._kept[found + len(self.boundary) :][: len(_LINE)] not in (_LINE, _LAST):
                piece, self._kept = self._kept[: found + 1], self._kept[found + 1 :]
                yield piece
                continue
            if found >= 0:
                piece, self._kept = self._kept[:found], self._kept[found:]
                if piece:
                    yield piece
                return
            # the boundary may have begun at the end of what is there
            safe = len(self._kept) - len(self.boundary) + 1
            if safe > 0:
                piece, self._kept = self._kept[:safe], self._kept[safe:]
                yield piece
            await self._more()

    async def files(self) -> AsyncIterator[tuple[str, AsyncIterator[bytes]]]:
        """Give the name of each file and its pieces, which have to be read before the next one is asked for.

        Raises HTTPException if they are too many, or something else comes between them.
        """
        for _ in range(MOST_FILES):
            yield self.file_name, self.file()
            await self._until(self.boundary, most=0)
            head = await self._until(b"\r\n\r\n", most=_MOST_HEAD)
            if head.startswith(b"--"):
                return
            found = _FILE_NAME.search(head)
            if found is None:
                raise HTTPException(400, "Expected nothing but files behind the first file, found a field.")
            self.file_name = found[1].decode("utf-8", "replace")
        raise HTTPException(400, f"Expected at most {MOST_FILES} files, found more.")

    async def _until(self, mark: bytes, *, most: int) -> bytes:
        while (found := self._kept.find(mark)) < 0:
            if len(self._kept) > most + len(mark):
                raise _no_form()
            if mark == b"\r\n\r\n" and self._kept.startswith(b"--"):
                return b"--"
            await self._more()
        if found > most:
            raise _no_form()
        before, self._kept = self._kept[:found], self._kept[found + len(mark) :]
        return before

    async def _more(self) -> None:
        piece = await anext(self.pieces, None)
        if piece is None:
            raise HTTPException(400, "The form was cut off.")
        self._kept += piece


def form_with_file(content_type: str, pieces: AsyncIterator[bytes]) -> FormWithFile:
    """Return a form with a file, to be read.

    ``content_type``: head of the request that names the boundary. ``pieces``: what comes in. Raises HTTPException if it
    is no such form.
    """
    found = _BOUNDARY.match(content_type)
    if found is None:
        raise _no_form()
    boundary = (found[1] or found[2]).encode("latin-1", "replace")
    return FormWithFile(pieces=pieces, boundary=b"\r\n--" + boundary)


def _no_form() -> HTTPException:
    return HTTPException(400, "Expected a form with a file (multipart/form-data), found something else.")
