"""The formats that are read, in the order in which they are tried; a new one is a new file and one more entry."""

from shaftprint.recording.readers import _catman, _hdf5, _journal, _lvm, _mdf, _native, _netcdf3, _uff
from shaftprint.recording.readers._reader import Reader
from shaftprint.recording.readers.can import _log
from shaftprint.recording.readers.csv import _csv
from shaftprint.recording.readers.dewesoft import _dewesoft
from shaftprint.recording.readers.imc import _imc
from shaftprint.recording.readers.matlab import _v5, _v73
from shaftprint.recording.readers.tdms import _tdms

READERS: tuple[Reader, ...] = (
    _native,
    _journal,
    _mdf,
    _tdms,
    _log,
    _dewesoft,
    _imc,
    _catman,
    _v5,
    _v73,
    _hdf5,
    _netcdf3,
    _lvm,
    _uff,
    _csv,
)
"""The formats that are tried when none are given."""
