"""HDF5 files opened safely: nothing outside of them is read, a damaged one is first opened in a separate process."""

from shaftprint.recording.readers.hdf5_files._open import CANNOT_BE_OPENED, expect_storage, is_hdf5, open_hdf5

__all__ = ["CANNOT_BE_OPENED", "expect_storage", "is_hdf5", "open_hdf5"]
