"""Text files: columns of numbers with titles, in the layouts that loggers and spreadsheets write."""

from shaftprint.recording.readers.csv._csv import NAME, is_mine, read

__all__ = ["NAME", "is_mine", "read"]
