from ._equipped import equipped
from ._fit import DriveFit, identify_drive
from ._named import named_drives
from ._predict import predict_files
from ._records import read_records
from ._validate import validate_drive

__all__ = [
    "DriveFit",
    "equipped",
    "identify_drive",
    "named_drives",
    "predict_files",
    "read_records",
    "validate_drive",
]
