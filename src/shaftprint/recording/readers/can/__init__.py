"""Frames of a CAN bus from any log, taken apart as a DBC or ARXML file, SAE J1939 or NMEA 2000 says what they hold."""

from shaftprint.recording.readers.can._channels import Decoded, decoded
from shaftprint.recording.readers.can._database import Database
from shaftprint.recording.readers.can._frames import EXTENDED, FILL, FrameLog, Frames, pgn_of
from shaftprint.recording.readers.can._known import KNOWN
from shaftprint.recording.readers.can._log import (
    NAME,
    add_signals,
    begins_as_log,
    database_of,
    dbc_path,
    expect_known,
    is_mine,
    read,
)
from shaftprint.recording.readers.can._messages import Message as BusMessage
from shaftprint.recording.readers.can._messages import Signal as BusSignal

__all__ = [
    "EXTENDED",
    "FILL",
    "KNOWN",
    "NAME",
    "BusMessage",
    "BusSignal",
    "Database",
    "Decoded",
    "FrameLog",
    "Frames",
    "add_signals",
    "begins_as_log",
    "database_of",
    "dbc_path",
    "decoded",
    "expect_known",
    "is_mine",
    "pgn_of",
    "read",
]
