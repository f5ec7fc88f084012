"""Dewesoft files, unpacked by Dewesoft's own library in a separate process."""

from shaftprint.recording.readers.dewesoft._dewesoft import NAME, is_mine, read

__all__ = ["NAME", "is_mine", "read"]
