"""Raw logger files, untouched: channels with their own clocks, read in chunks.

===================== ======== ====================================================================
quantity              unit     meaning
===================== ======== ====================================================================
counts                1        what the logger stored, int16 or float64
value                 ``unit`` ``counts * scale + offset``, in the unit that the file gives
time                  s        ``start_s + sample / rate_hz`` on the channel's own clock
rate                  Hz       samples a second of one channel
===================== ======== ====================================================================

Files are opened read-only. Values that are not numbers are passed on as they are.
"""

from shaftprint.recording._read import read_recording
from shaftprint.recording._recording import Channel, Recording
from shaftprint.recording._write import write_recording
from shaftprint.recording._writer import RecordingWriter
from shaftprint.recording.readers import READERS, Reader
from shaftprint.recording.writers import write_csv, write_mat_v5, write_mat_v73

__all__ = [
    "READERS",
    "Channel",
    "Reader",
    "Recording",
    "RecordingWriter",
    "read_recording",
    "write_csv",
    "write_mat_v5",
    "write_mat_v73",
    "write_recording",
]
