"""A file that comes in: written as it comes, counted and hashed on the way, and named when all of it is there."""

import asyncio
import hashlib
import os
import re
import secrets
import shutil
from collections.abc import AsyncIterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException

from shaftprint.escape import plain_name

SETTINGS: Final = ".toml"
MOST_SETTINGS: Final = 2**20
"""Bytes of the largest vessel or campaign file."""
_LONGEST_NAME: Final = 100
_LONGEST_STILL_S: Final = 60.0
_LEFT_FREE: Final = 2**30
_PROGRAMS: Final = frozenset({".py", ".pyc", ".pyw", ".pickle", ".pkl", ".zip", ".exe", ".dll", ".so", ".sh", ".bat"})
_NUMBER: Final = re.compile(r"[0-9a-f]{16}")


@dataclass(frozen=True, kw_only=True, slots=True)
class Taken:
    """A file that was taken."""

    id: str
    """What it is called in an address."""
    size: int
    """Its bytes."""
    sha256: str
    """Its SHA-256."""


def checked_name(name: str) -> str:
    """Return the name of a file as it is kept.

    Raises HTTPException if it is no name of a recording or a settings file.
    """
    plain = plain_name(name.replace("\\", "/").rpartition("/")[2]).lstrip(".-")
    if not plain or len(plain) > _LONGEST_NAME or not plain.isprintable():
        raise HTTPException(
            400, f"Expected a file with a name of at most {_LONGEST_NAME} letters, found {plain[:40]!r}."
        )
    if Path(plain).suffix.lower() in _PROGRAMS:
        raise HTTPException(
            400,
            f"{plain}: expected a recording or a settings file; programs and archives are not taken. Structures of "
            "your own are programs: use them with shaftprint identify.",
        )
    return plain


async def take(parts: AsyncIterator[bytes], folder: Path, name: str, *, most: int, length: int | None) -> Taken:
    """Write a file as it comes; nothing is left where it does not come to its end.

    ``parts``: its bytes. ``folder``: folder of all uploads. ``name``: its name, checked. ``most``: how many bytes it
    may have. ``length``: how many bytes are announced; None where nobody says. Raises HTTPException if it is too large,
    is cut off, or has no room.
    """
    if name.lower().endswith(SETTINGS):
        most = min(most, MOST_SETTINGS)
    expect_room(folder, most=most, length=length)
    number = secrets.token_hex(8)
    home = folder / number
    await run_in_threadpool(home.mkdir, mode=0o700)
    part = home / f"{name}.part"
    digest, size = hashlib.sha256(), 0
    try:
        # unbuffered: what comes in pieces of a network goes on as it is
        with part.open("xb", buffering=0) as file:
            async for piece in _in_time(parts, name):
                size += len(piece)
                if size > most:
                    raise HTTPException(413, f"{name}: expected at most {most} bytes, found more.")
                await run_in_threadpool(_put, file, digest, piece)
            await run_in_threadpool(os.fsync, file.fileno())
        if not size:
            raise HTTPException(400, f"{name}: expected a file, found an empty one.")
        part.replace(home / name)
    except OSError:
        shutil.rmtree(home, ignore_errors=True)
        raise HTTPException(507, f"{name}: the disk of the server does not take it.") from None
    except BaseException:
        shutil.rmtree(home, ignore_errors=True)
        raise
    return Taken(id=number, size=size, sha256=digest.hexdigest())


async def _in_time(parts: AsyncIterator[bytes], name: str) -> AsyncIterator[bytes]:
    """Give the pieces of a file, and refuse one that stands still."""
    while True:
        try:
            piece = await asyncio.wait_for(anext(parts, None), _LONGEST_STILL_S)
        except TimeoutError:
            raise HTTPException(408, f"{name}: nothing came for {_LONGEST_STILL_S:g} s; send it again.") from None
        if piece is None:
            return
        yield piece


def _put(file: object, digest: object, piece: bytes) -> None:
    file.write(piece)  # type: ignore[attr-defined]
    digest.update(piece)  # type: ignore[attr-defined]


def expect_room(folder: Path, *, most: int, length: int | None) -> None:
    """Refuse a file that is announced as too large, or has no room.

    Raises HTTPException if it is so.
    """
    if length is not None and length > most:
        raise HTTPException(413, f"Expected at most {most} bytes, found {length}.")
    if shutil.disk_usage(folder).free - (length or 0) < _LEFT_FREE:
        raise HTTPException(507, "The disk of the server is nearly full; ask whoever keeps it.")


def is_number(text: str) -> bool:
    """Return whether a text is what an upload is called in an address."""
    return _NUMBER.fullmatch(text) is not None
