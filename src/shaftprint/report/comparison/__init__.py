"""What differs between fingerprints: numbers, errors that the tests share, and their tables."""

from shaftprint.report.comparison._differences import LOAD_REPEATABILITY, Difference, differences
from shaftprint.report.comparison._shared_errors import shared_errors
from shaftprint.report.comparison._tables import beside_table, condition_table, difference_table, stated_table
from shaftprint.report.comparison._vessel_file_words import vessel_file_sentences, vessel_file_table

__all__ = [
    "LOAD_REPEATABILITY",
    "Difference",
    "beside_table",
    "condition_table",
    "difference_table",
    "differences",
    "shared_errors",
    "stated_table",
    "vessel_file_sentences",
    "vessel_file_table",
]
