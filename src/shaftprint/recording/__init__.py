"""Raw logger files, untouched: channels with their own clocks, read in chunks.

===================== ======== ====================================================================
quantity              unit     meaning
===================== ======== ====================================================================
counts                1        what the logger stored, int16 or float64
value                 ``unit`` ``counts * scale + offset``, in the unit that the file gives
time                  s        ``start_s + sample / rate_hz`` on the channel's own clock; of messages as the file has it
rate                  Hz       samples a second of one channel
===================== ======== ====================================================================

Files are opened read-only. Values that are not numbers are passed on as they are.
"""

from shaftprint.recording._channel import Channel, ClockJump
from shaftprint.recording._cut import cut
from shaftprint.recording._from_arrays import Samples, recording_from_arrays
from shaftprint.recording._level_watch import LevelWatch, watch_levels
from shaftprint.recording._levels import Levels
from shaftprint.recording._messages import Messages, judge_messages, messages_of, stamped_values
from shaftprint.recording._read import read_recording
from shaftprint.recording._recording import CLOCK_MAPS, Recording
from shaftprint.recording._write import write_recording
from shaftprint.recording._writer import RecordingWriter
from shaftprint.recording.readers import READERS, Reader, ReaderFunction
from shaftprint.recording.writers import (
    NATIVE_ENDINGS,
    WRITTEN_ENDINGS,
    WRITTEN_FORMATS,
    expect_known_ending,
    held_date,
    write_by_ending,
    write_csv,
    write_mat_v5,
    write_mat_v73,
    write_mdf4,
    write_tdms,
)

__all__ = [
    "CLOCK_MAPS",
    "NATIVE_ENDINGS",
    "READERS",
    "WRITTEN_ENDINGS",
    "WRITTEN_FORMATS",
    "Channel",
    "ClockJump",
    "LevelWatch",
    "Levels",
    "Messages",
    "Reader",
    "ReaderFunction",
    "Recording",
    "RecordingWriter",
    "Samples",
    "cut",
    "expect_known_ending",
    "held_date",
    "judge_messages",
    "messages_of",
    "read_recording",
    "recording_from_arrays",
    "stamped_values",
    "watch_levels",
    "write_by_ending",
    "write_csv",
    "write_mat_v5",
    "write_mat_v73",
    "write_mdf4",
    "write_recording",
    "write_tdms",
]
