"""Drives on the bench: records of a drive and its file to parameters, verdict and fingerprint, in time.

=================== ========= ========================================================================================
quantity            unit      meaning
=================== ========= ========================================================================================
input, output       structure whole values, not deviations
time                s         of the recording
parameter           stated    in its own unit, with one standard deviation
=================== ========= ========================================================================================
"""

from shaftprint.bench._compare import DriveDifference, drive_differences
from shaftprint.bench._composed import composed
from shaftprint.bench._equipped import EquippedDrive, equipped
from shaftprint.bench._fingerprint import drive_fingerprint, identified_drive
from shaftprint.bench._fit import STARTS, DriveFit, drive_settings, drive_time_settings, identify_drive
from shaftprint.bench._kept import kept_drive
from shaftprint.bench._per_record import all_parameters, free_parameters, with_structures
from shaftprint.bench._predict import noise_words, planned_noise, predict_drive, predicted_at
from shaftprint.bench._records import read_records
from shaftprint.bench._responses import RESPONSE_STARTS, ResponseFile, identify_responses, read_responses
from shaftprint.bench._structures import TimeCandidate, TimeComparison, TimeRatio, compare_in_time, without
from shaftprint.bench._validate import ValidatedRecord, identified_from, validate_drive

__all__ = [
    "RESPONSE_STARTS",
    "STARTS",
    "DriveDifference",
    "DriveFit",
    "EquippedDrive",
    "ResponseFile",
    "TimeCandidate",
    "TimeComparison",
    "TimeRatio",
    "ValidatedRecord",
    "all_parameters",
    "compare_in_time",
    "composed",
    "drive_differences",
    "drive_fingerprint",
    "drive_settings",
    "drive_time_settings",
    "equipped",
    "free_parameters",
    "identified_drive",
    "identified_from",
    "identify_drive",
    "identify_responses",
    "kept_drive",
    "noise_words",
    "planned_noise",
    "predict_drive",
    "predicted_at",
    "read_records",
    "read_responses",
    "validate_drive",
    "with_structures",
    "without",
]
