"""Options of ``identify`` for the report: what the recording does not say of itself, and what to compare it with."""

from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime
from functools import wraps
from pathlib import Path
from typing import Any

import click

from shaftprint.campaign._trial_conditions import TrialConditions, load_trial_conditions
from shaftprint.cli._dates import Moment
from shaftprint.cli.output._fingerprint_file import fingerprint_at
from shaftprint.fingerprint._fingerprint import Fingerprint
from shaftprint.report._page import expect_reportlab


@dataclass(frozen=True, kw_only=True, slots=True)
class ReportOptions:
    """What a user says of a test for its report."""

    tested_at: datetime | None
    """When the recording began; None where its file may say so."""
    conditions: TrialConditions | None
    """When, where and in what water the test was made; None where nobody says."""
    previous: Fingerprint | None
    """Fingerprint of an earlier test, with which this one is compared."""
    pdf: bool
    """Whether the first pages are written as PDF too."""


def report_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the options ``--tested-at``, ``--conditions``, ``--previous`` and ``--pdf``, handed over as ``about``."""

    @wraps(command)
    def with_options(
        *, tested_at: datetime | None, conditions: Path | None, previous: Path | None, pdf: bool, **options: Any
    ) -> Any:
        # read before anything is made: a file that cannot be used leaves no folder
        if pdf:
            expect_reportlab()
        earlier = None if previous is None else fingerprint_at(previous)
        of_trial = None if conditions is None else load_trial_conditions(conditions)
        about = ReportOptions(tested_at=tested_at, conditions=of_trial, previous=earlier, pdf=pdf)
        return command(about=about, **options)

    tested_option = click.option(
        "--tested-at",
        type=Moment(),
        metavar="DATE",
        help="When the recording began, such as 2026-03-31T09:30+02:00; by default as its file says.",
    )
    conditions_option = click.option(
        "--conditions",
        type=click.Path(path_type=Path),
        metavar="FILE",
        help="When, where and in what water the test was made; `shaftprint new conditions` writes such a file.",
    )
    previous_option = click.option(
        "--previous",
        type=click.Path(path_type=Path),
        metavar="RESULT",
        help="Result of an earlier test, a folder or a fingerprint: the report says what has changed since.",
    )
    pdf_option = click.option("--pdf", is_flag=True, help="Write the first pages of the report as report.pdf too.")
    return tested_option(conditions_option(previous_option(pdf_option(with_options))))
