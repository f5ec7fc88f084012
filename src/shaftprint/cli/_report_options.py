"""Options of ``identify`` for the report: what the recording does not say of itself, and what to compare it with."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

import click

from shaftprint.cli._dates import Moment
from shaftprint.cli._gathered_options import gathered_options
from shaftprint.cli.output._fingerprint_file import fingerprint_at
from shaftprint.late import late

with late():
    from shaftprint.campaign._trial_conditions import TrialConditions, load_trial_conditions
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


def _about(tested_at: datetime | None, conditions: Path | None, previous: Path | None, pdf: bool) -> ReportOptions:
    # read before anything is made: a file that cannot be used leaves no folder
    if pdf:
        expect_reportlab()
    earlier = None if previous is None else fingerprint_at(previous)
    of_trial = None if conditions is None else load_trial_conditions(conditions)
    return ReportOptions(tested_at=tested_at, conditions=of_trial, previous=earlier, pdf=pdf)


report_options = gathered_options(
    _about,
    (
        click.option(
            "--tested-at",
            type=Moment(),
            metavar="DATE",
            help="When the recording began, such as 2026-03-31T09:30+02:00; by default as its file says.",
        ),
        click.option(
            "--conditions",
            type=click.Path(path_type=Path),
            metavar="FILE",
            help="When, where and in what water the test was made; `shaftprint new conditions` writes such a file.",
        ),
        click.option(
            "--previous",
            type=click.Path(path_type=Path),
            metavar="RESULT",
            help="Result of an earlier test, a folder or a fingerprint: the report says what has changed since.",
        ),
        click.option("--pdf", is_flag=True, help="Write the first pages of the report as report.pdf too."),
    ),
    name="about",
)
"""Adds ``--tested-at``, ``--conditions``, ``--previous`` and ``--pdf``, taken as one ``about``."""
