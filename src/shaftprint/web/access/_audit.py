"""Who did what: a line of JSON for each deed, put on the disk before the answer goes out."""

import json
import os
import threading
from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from typing import Any, Final

_LONGEST: Final = 300
_READ_BYTES: Final = 2**20


@dataclass(slots=True)
class Audit:
    """The file of deeds."""

    path: Path
    """The file; each line is an object."""
    _lock: threading.Lock = field(default_factory=threading.Lock)

    def note(self, deed: str, *, person: str, address: str, now: datetime, **about: Any) -> None:
        """Write down a deed.

        Parameters
        ----------
        deed
            What was done, such as ``signed in``.
        person, address
            Who did it, and from where.
        now
            When.
        about
            What it is about: ship, line, file, job.
        """
        entry = {"at": now.isoformat(timespec="seconds"), "deed": deed, "person": person, "address": address}
        entry |= {name: one[:_LONGEST] if isinstance(one, str) else one for name, one in about.items()}
        line = json.dumps(entry, ensure_ascii=True).encode() + b"\n"
        with self._lock, self.path.open("ab") as file:
            file.write(line)
            file.flush()
            os.fsync(file.fileno())

    def newest(self) -> Iterator[dict[str, Any]]:
        """Give the newest deeds, the last one first; a line that was cut off is left out."""
        try:
            with self.path.open("rb") as file:
                file.seek(max(0, file.seek(0, os.SEEK_END) - _READ_BYTES))
                lines = file.read(_READ_BYTES).splitlines()
        except FileNotFoundError:
            return
        for line in reversed(lines):
            try:
                entry = json.loads(line)
            except ValueError:
                continue
            if isinstance(entry, dict):
                yield entry
