"""Frames of a CAN bus as arrays, and what their identifiers say under SAE J1939."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import datetime
from typing import Any

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray

EXTENDED = 1 << 31
"""Mark of a 29-bit identifier."""
FILL = 0xFF
"""What stands behind the bytes of a short frame."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Frames:
    """A block of data frames in the order of a log."""

    time_s: FloatArray
    """When they came, by the log's clock [s]."""
    bus: NDArray[Any]
    """Number of the bus of each."""
    identifier: NDArray[Any]
    """Their identifiers, with `EXTENDED` where they have 29 bits."""
    length: NDArray[Any]
    """How many bytes each holds."""
    content: NDArray[np.uint8]
    """Their bytes, shape (frames, a multiple of 8), filled up with `FILL`."""


@dataclass(kw_only=True, slots=True)
class FrameLog:
    """A log of frames, which can be gone through once."""

    blocks: Iterator[Frames]
    """The frames."""
    kind: str
    """What wrote it, for the name of the format."""
    bus_names: dict[int, str] = field(default_factory=dict)
    """What the buses are called, those that are missing CAN and their number; complete when the blocks are through."""
    began: datetime | None = None
    """Date of second zero, where the log says it."""
    others: dict[str, int] = field(default_factory=dict)
    """How many events there are that hold no values, by their kind; complete when the blocks have been gone through."""

    def name_of(self, bus: int) -> str:
        """Return what a bus is called."""
        return self.bus_names.get(bus, f"CAN{bus}")

    def count(self, kind: str, number: int = 1) -> None:
        """Count events that hold no values."""
        if number:
            self.others[kind] = self.others.get(kind, 0) + number


def pgn_of(identifier: int) -> int:
    """Return the number of the parameter group in a 29-bit identifier."""
    group = identifier >> 8 & 0x3FFFF
    return group if group >> 8 & 0xFF >= 0xF0 else group & 0x3FF00


def sender_of(identifier: int) -> int:
    """Return the source address in a 29-bit identifier."""
    return identifier & 0xFF


def is_nmea_2000(identifier: int) -> bool:
    """Return whether a 29-bit identifier is one of NMEA 2000: parameter groups from 1F000 on."""
    return pgn_of(identifier) >> 12 == 0x1F


def is_j1939(identifier: int) -> bool:
    """Return whether a 29-bit identifier is one of a parameter group that SAE J1939 or NMEA 2000 lays down.

    Control commands (0 and 256), and all that goes to everybody, except for the groups that makers may use as they
    like. Others use 29 bits in ways of their own: groups of low numbers, or the highest priority.
    """
    group, is_urgent = pgn_of(identifier), identifier >> 26 == 0
    return not is_urgent and (group in (0, 256) or 0xF000 <= group <= 0xFEFF or 0x1F000 <= group <= 0x1FEFF)
