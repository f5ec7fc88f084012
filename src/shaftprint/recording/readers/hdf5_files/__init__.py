"""HDF5 files opened safely: nothing outside of them is read, a damaged one is first opened in a separate process."""
