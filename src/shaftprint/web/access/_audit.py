"""Who did what: a line of JSON for each deed, put on the disk before the answer goes out.

What was refused to somebody who is not known is counted, a line a minute and address, in a file of its own: nobody can
push out what others did. Files that are long enough are put aside, and the oldest goes.
"""

import json
import os
import threading
from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from pathlib import Path
from typing import Any, Final

from shaftprint.files import private_file
from shaftprint.web.access._throttle import network_of

MOST_BYTES: Final = 8 * 2**20
"""A file that is longer is put aside."""
MOST_ASIDE: Final = 9
"""So many of them are kept."""
WINDOW: Final = timedelta(minutes=1)
"""Refusals of one address within it are one line."""
_LONGEST: Final = 300
_MOST_COUNTED: Final = 1000
_PIECE: Final = 2**16


@dataclass(slots=True)
class _Counted:
    """Refusals of one kind and address since one that was written down."""

    since: datetime
    more: int = 0


@dataclass(slots=True)
class Audit:
    """The file of deeds."""

    path: Path
    """The file; each line is an object."""
    _lock: threading.Lock = field(default_factory=threading.Lock)
    _counted: dict[tuple[str, str], _Counted] = field(default_factory=dict)

    def note(self, deed: str, *, person: str, address: str, now: datetime, **about: Any) -> None:
        """Write down a deed.

        ``deed``: what was done, such as ``signed in``. ``person``, ``address``: who did it, and from where. ``now``:
        when. ``about``: what it is about: ship, line, file, job.
        """
        with self._lock:
            _put(self.path, _entry(deed, person, address, now, about), aside=MOST_ASIDE, sync=True)

    def refused(self, deed: str, *, address: str, now: datetime, **about: Any) -> None:
        """Count a refusal; the first one of an address is written down, those after it a minute later in one line."""
        with self._lock:
            self._write_counts(now)
            place = network_of(address)
            key = (deed, place if len(self._counted) < _MOST_COUNTED or (deed, place) in self._counted else "elsewhere")
            counted = self._counted.get(key)
            if counted is not None:
                counted.more += 1
                return
            self._counted[key] = _Counted(since=now)
            _put(self._refusals, _entry(deed, "", address, now, about), aside=1, sync=False)

    def newest(self, *, refusals: bool = False) -> Iterator[dict[str, Any]]:
        """Give the newest deeds, or what was refused, the last one first; a line that was cut off is left out."""
        path = self._refusals if refusals else self.path
        for one in (path, *(_aside(path, place) for place in range(1, MOST_ASIDE + 1))):
            for line in _lines_backwards(one):
                try:
                    entry = json.loads(line)
                except ValueError:
                    continue
                if isinstance(entry, dict):
                    yield entry

    @property
    def _refusals(self) -> Path:
        return self.path.with_name("refused.jsonl")

    def _write_counts(self, now: datetime) -> None:
        for (deed, address), counted in list(self._counted.items()):
            if now - counted.since >= WINDOW:
                del self._counted[deed, address]
                if counted.more:
                    about = {"times": counted.more, "since": counted.since.isoformat(timespec="seconds")}
                    _put(self._refusals, _entry(deed, "", address, now, about), aside=1, sync=False)


def _entry(deed: str, person: str, address: str, now: datetime, about: dict[str, Any]) -> bytes:
    entry = {"at": now.isoformat(timespec="seconds"), "deed": deed, "person": person, "address": address}
    entry |= {name: one[:_LONGEST] if isinstance(one, str) else one for name, one in about.items()}
    return json.dumps(entry, ensure_ascii=True).encode() + b"\n"


def _put(path: Path, line: bytes, *, aside: int, sync: bool) -> None:
    with private_file(path).open("ab") as file:
        file.write(line)
        file.flush()
        if sync:
            os.fsync(file.fileno())
        length = file.tell()
    if length > MOST_BYTES:
        _aside(path, aside).unlink(missing_ok=True)
        for place in range(aside - 1, 0, -1):
            if _aside(path, place).exists():
                _aside(path, place).replace(_aside(path, place + 1))
        path.replace(_aside(path, 1))


def _aside(path: Path, place: int) -> Path:
    return path.with_name(f"{path.stem}.{place}{path.suffix}")


def _lines_backwards(path: Path) -> Iterator[bytes]:
    """Give the lines of a file, the last one first, as far as somebody wants to read."""
    try:
        file = path.open("rb")
    except FileNotFoundError:
        return
    with file:
        end, rest = file.seek(0, os.SEEK_END), b""
        while end:
            begin = max(0, end - _PIECE)
            file.seek(begin)
            first, *lines = (file.read(end - begin) + rest).split(b"\n")
            yield from (line for line in reversed(lines) if line)
            end, rest = begin, first
        if rest:
            yield rest
