"""What differs between fingerprints: numbers, errors that the tests share, and their tables."""

from shaftprint.report.comparison._cause_table import cause_table
from shaftprint.report.comparison._differences import Difference, differences
from shaftprint.report.comparison._history_tables import course_table, history_table
from shaftprint.report.comparison._sister_tables import cause_spread_table, number_spread_table, sister_table
from shaftprint.report.comparison._tables import (
    beside_table,
    condition_table,
    difference_table,
    source_table,
    stated_table,
)
from shaftprint.report.comparison._vessel_file_words import vessel_file_sentences, vessel_file_table

__all__ = [
    "Difference",
    "beside_table",
    "cause_spread_table",
    "cause_table",
    "condition_table",
    "course_table",
    "difference_table",
    "differences",
    "history_table",
    "number_spread_table",
    "sister_table",
    "source_table",
    "stated_table",
    "vessel_file_sentences",
    "vessel_file_table",
]
