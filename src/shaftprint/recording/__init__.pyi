from ._channel import Channel, ClockJump
from ._cut import cut
from ._from_arrays import Samples, recording_from_arrays
from ._read import read_recording
from ._recording import Recording
from ._write import write_recording
from ._writer import RecordingWriter
from .writers._by_ending import write_by_ending
from .writers._csv import write_csv
from .writers._mat_v73 import write_mat_v73

__all__ = [
    "Channel",
    "ClockJump",
    "Recording",
    "RecordingWriter",
    "Samples",
    "cut",
    "read_recording",
    "recording_from_arrays",
    "write_by_ending",
    "write_csv",
    "write_mat_v73",
    "write_recording",
]
