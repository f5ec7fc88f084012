"""Frames of a CAN bus from any log, taken apart as a DBC or ARXML file, SAE J1939 or NMEA 2000 says what they hold."""

from shaftprint.recording.readers.can._channels import Decoded, decoded
from shaftprint.recording.readers.can._database import Database
from shaftprint.recording.readers.can._frames import EXTENDED, FILL, FrameLog, Frames
from shaftprint.recording.readers.can._log import (
    NAME,
    add_signals,
    begins_as_log,
    database_of,
    expect_known,
    is_mine,
    read,
)

__all__ = [
    "EXTENDED",
    "FILL",
    "NAME",
    "Database",
    "Decoded",
    "FrameLog",
    "Frames",
    "add_signals",
    "begins_as_log",
    "database_of",
    "decoded",
    "expect_known",
    "is_mine",
    "read",
]
