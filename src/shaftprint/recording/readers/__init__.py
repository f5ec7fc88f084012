"""One file or folder a logger format; a new format is a new file here and one more entry in ``READERS``."""

from shaftprint.recording.readers import _hdf5, _lvm, _mdf, _native, _netcdf3, _uff, can, csv, dewesoft, matlab, tdms
from shaftprint.recording.readers._clock import Hole, clock_of_times, uniform_clock
from shaftprint.recording.readers._extra import library
from shaftprint.recording.readers._gather import told_apart
from shaftprint.recording.readers._outside import ReaderFunction, read_outside
from shaftprint.recording.readers._printed_rate import rate_of_step
from shaftprint.recording.readers._reader import Reader
from shaftprint.recording.readers._time_scale import FASTEST_HZ, SLOWEST_HZ
from shaftprint.recording.readers._unread import remedy

READERS: tuple[Reader, ...] = (_native, _mdf, tdms, can, dewesoft, *matlab.READERS, _hdf5, _netcdf3, _lvm, _uff, csv)
"""The formats that are tried when none are given."""

__all__ = [
    "FASTEST_HZ",
    "READERS",
    "SLOWEST_HZ",
    "Hole",
    "Reader",
    "ReaderFunction",
    "clock_of_times",
    "library",
    "rate_of_step",
    "read_outside",
    "remedy",
    "told_apart",
    "uniform_clock",
]
