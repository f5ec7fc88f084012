"""MATLAB files, version 4 to 7 and 7.3."""

from shaftprint.recording.readers.matlab import _v5, _v73

READERS = (_v5, _v73)
"""The formats that MATLAB writes."""

__all__ = ["READERS"]
