"""HDF5 files opened safely: nothing outside of them is read, a damaged one is first opened in a separate process."""

from shaftprint.recording.readers.hdf5_files._open import expect_storage, is_hdf5, open_hdf5

__all__ = ["expect_storage", "is_hdf5", "open_hdf5"]
