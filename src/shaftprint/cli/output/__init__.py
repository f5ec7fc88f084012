"""Where a command writes: tables and bars on the terminal, files, and folders that appear as a whole."""

from shaftprint.cli.output._file_to_write import expect_free, expect_no_input
from shaftprint.cli.output._fingerprint_file import FINGERPRINT, REPORT, fingerprint_at, fingerprint_file
from shaftprint.cli.output._json import give, table_json
from shaftprint.cli.output._layout import table_lines
from shaftprint.cli.output._output_folder import force_option, output_folder
from shaftprint.cli.output._progress import Steps, no_progress_option, progress
from shaftprint.cli.output._tables import print_table, print_tables

__all__ = [
    "FINGERPRINT",
    "REPORT",
    "Steps",
    "expect_free",
    "expect_no_input",
    "fingerprint_at",
    "fingerprint_file",
    "force_option",
    "give",
    "no_progress_option",
    "output_folder",
    "print_table",
    "print_tables",
    "progress",
    "table_json",
    "table_lines",
]
