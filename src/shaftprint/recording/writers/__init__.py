"""Recordings for other tools: one file a format; values in the channel's unit instead of counts."""

from shaftprint.recording.writers._csv import write_csv
from shaftprint.recording.writers._mat_v5 import write_mat_v5
from shaftprint.recording.writers._mat_v73 import write_mat_v73

__all__ = ["write_csv", "write_mat_v5", "write_mat_v73"]
