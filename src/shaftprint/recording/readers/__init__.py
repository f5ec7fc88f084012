"""One file a logger format; a new format is a new file here and one more entry in ``READERS``."""

from shaftprint.recording.readers import _csv, _mat_v5, _mat_v73, _native
from shaftprint.recording.readers._reader import Reader

READERS: tuple[Reader, ...] = (_native, _csv, _mat_v5, _mat_v73)
"""The formats that are tried when none are given."""

__all__ = ["READERS", "Reader"]
