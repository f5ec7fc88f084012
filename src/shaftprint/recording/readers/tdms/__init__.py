"""NI TDMS files of LabVIEW and DAQmx."""

from shaftprint.recording.readers.tdms._tdms import NAME, is_mine, read

__all__ = ["NAME", "is_mine", "read"]
