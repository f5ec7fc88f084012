"""Drives on the bench: records of a drive and its file to parameters, verdict and fingerprint, in time.

=================== ========= ========================================================================================
quantity            unit      meaning
=================== ========= ========================================================================================
input, output       structure whole values, not deviations
time                s         of the recording
parameter           stated    in its own unit, with one standard deviation
=================== ========= ========================================================================================
"""

from shaftprint.bench._composed import composed
from shaftprint.bench._equipped import EquippedDrive, equipped
from shaftprint.bench._fingerprint import drive_fingerprint, identified_drive
from shaftprint.bench._fit import STARTS, DriveFit, drive_settings, drive_time_settings, identify_drive
from shaftprint.bench._records import read_records

__all__ = [
    "STARTS",
    "DriveFit",
    "EquippedDrive",
    "composed",
    "drive_fingerprint",
    "drive_settings",
    "drive_time_settings",
    "equipped",
    "identified_drive",
    "identify_drive",
    "read_records",
]
