"""The noun of the room: a raw logger file, untouched."""

import hashlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from types import TracebackType
from typing import Self

from shaftprint.errors import RecordingError
from shaftprint.notebook._shown import Shown
from shaftprint.notebook._summary import Summary, shortened
from shaftprint.recording._channel import Channel
from shaftprint.recording._levels import Levels, levels_of

CLOCK_MAPS = "clock_maps"
"""Name of the attribute that holds the clock maps of a recording that was merged of several."""
MOST_CHANNELS = 8
"""Channels that a summary lists one by one."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class Recording(Shown):
    """A raw logger file, open for reading; close it or use it in a ``with`` statement."""

    path: Path
    """The file."""
    sha256: str
    """SHA-256 of the whole file, hexadecimal."""
    format: str
    """Name of the file format."""
    channels: Mapping[str, Channel]
    """Every channel by its name, in the order of the file."""
    left_out: Mapping[str, str] = field(default_factory=dict)
    """Why other channels of the file cannot be used, by their names."""
    remarks: tuple[str, ...] = ()
    """What was taken from the file though it does not say it, a sentence each: the unit of its times."""
    began: datetime | None = None
    """Date and time of second 0 by the logger's own clock, where the file gives it."""
    attributes: Mapping[str, str | float] = field(default_factory=dict)
    """Facts on the whole recording by their names, such as the vessel; those of the native container."""
    release: Callable[[], None] = field(repr=False, default=lambda: None)
    """What ``close`` does."""

    def summary(self) -> Summary:
        """Return file, format, date and channels, each with its unit, rate and length."""
        channels = {
            name: f"{one.unit}, {one.rate_hz:g} Hz, {one.duration_s:,.1f} s from {one.start_s:g} s"
            for name, one in self.channels.items()
        }
        facts = {
            "file": str(self.path),
            "format": self.format,
            "began": "" if self.began is None else self.began.isoformat(sep=" ", timespec="seconds"),
            **dict(list(channels.items())[:MOST_CHANNELS]),
            "further channels": shortened(list(channels)[MOST_CHANNELS:]),
            "left out": shortened(self.left_out),
            "taken for granted": " ".join(self.remarks),
        }
        return Summary(title=f"Recording {self.path.name}", facts=facts)

    def channel(self, name: str) -> Channel:
        """Return a channel by its name.

        Raises
        ------
        RecordingError
            If there is none of that name; the message lists those that there are, or says why it was left out.
        """
        if name in self.left_out:
            raise RecordingError(f'{self.path}: channel "{name}" cannot be used: {self.left_out[name]}')
        if name not in self.channels:
            raise RecordingError(
                f'{self.path}: expected a channel "{name}", found {", ".join(self.channels) or "none"}.'
            )
        return self.channels[name]

    def levels(self, reach: Callable[[float], None] | None = None) -> dict[str, Levels]:
        """Return the levels of every channel by its name, from one reading of the file.

        Parameters
        ----------
        reach
            Is told the share that is done, 0 to 1.

        Raises
        ------
        RecordingError
            If the file cannot be read.
        """
        return dict(zip(self.channels, levels_of(list(self.channels.values()), reach=reach), strict=True))

    def close(self) -> None:
        """Release the file; channels cannot be read afterwards."""
        self.release()

    def __enter__(self) -> Self:
        """Return the recording itself."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Close the recording."""
        self.close()


def sha256_of(path: Path) -> str:
    """Return the SHA-256 of a file, hexadecimal, without holding the file in memory."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
