"""Text files: columns of numbers with titles, in the layouts that loggers and spreadsheets write."""

from shaftprint.recording.readers.csv._csv import NAME, is_mine, read
from shaftprint.recording.readers.csv._header import Header
from shaftprint.recording.readers.csv._rows import LONGEST_LINE, Unpacked, unpack

__all__ = ["LONGEST_LINE", "NAME", "Header", "Unpacked", "is_mine", "read", "unpack"]
