"""A validation on the terminal."""

from __future__ import annotations

from shaftprint.cli._terminal import print_findings
from shaftprint.cli.output._json import give
from shaftprint.cli.output._tables import print_tables
from shaftprint.late import late

with late():
    from shaftprint.tables._validation import excerpt_name, misfit_table, step_number_table
    from shaftprint.validation._validation import Validation


def print_validation(validation: Validation) -> None:
    """Print the verdict, every excerpt, the numbers of every step, and how it was found."""
    give("misfits", {excerpt_name(c): c.misfits for c in validation.comparisons})
    print_findings(f"Validation: {validation.headline}", validation.sentences, is_answer=True)
    print_tables([misfit_table(validation), step_number_table(validation)])
    print_findings("How this was found", validation.findings)
