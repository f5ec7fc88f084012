from ._equipped import equipped
from ._fit import DriveFit, identify_drive
from ._records import read_records

__all__ = [
    "DriveFit",
    "equipped",
    "identify_drive",
    "read_records",
]
