"""Recordings for other tools: one file a format; values in the channel's unit instead of counts."""

from shaftprint.recording.writers._by_ending import (
    NATIVE_ENDINGS,
    WRITTEN_ENDINGS,
    WRITTEN_FORMATS,
    expect_known_ending,
    held_date,
    write_by_ending,
)
from shaftprint.recording.writers._csv import write_csv
from shaftprint.recording.writers._mat_v5 import write_mat_v5
from shaftprint.recording.writers._mat_v73 import write_mat_v73
from shaftprint.recording.writers._mdf4 import write_mdf4
from shaftprint.recording.writers._tdms import write_tdms

__all__ = [
    "NATIVE_ENDINGS",
    "WRITTEN_ENDINGS",
    "WRITTEN_FORMATS",
    "expect_known_ending",
    "held_date",
    "write_by_ending",
    "write_csv",
    "write_mat_v5",
    "write_mat_v73",
    "write_mdf4",
    "write_tdms",
]
