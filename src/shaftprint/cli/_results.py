"""The results of ``identify`` and ``demo``: files, where they are, and which structure the data want."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

from shaftprint.cli._report_options import ReportOptions
from shaftprint.cli._terminal import echo, print_findings
from shaftprint.cli.output._fingerprint_file import FINGERPRINT, REPORT
from shaftprint.cli.output._json import give
from shaftprint.cli.output._progress import Steps
from shaftprint.cli.output._tables import print_tables
from shaftprint.late import late

with late():
    from shaftprint.fingerprint._fingerprint import Fingerprint
    from shaftprint.fingerprint._json_file import write_fingerprint
    from shaftprint.identify.comparison._comparison import StructureComparison
    from shaftprint.recording._read import read_recording
    from shaftprint.report._render import render_report
    from shaftprint.spectra._frequency_response import FrequencyResponse
    from shaftprint.survey._survey import Survey
    from shaftprint.survey._thesis_mode import ThesisMode
    from shaftprint.tables._structures import structure_tables


def write_results(
    folder: Path,
    recording: Path,
    survey: Survey,
    *,
    steps: Steps,
    thesis: ThesisMode | None = None,
    line_selection: Mapping[str, FrequencyResponse] | None = None,
    truth: Mapping[str, float] | None = None,
    pictures: bool = False,
    previous: Fingerprint | None = None,
    pdf: bool = False,
    hints: Mapping[str, Any] = MappingProxyType({}),
) -> None:
    """Write fingerprint, figures and report of a survey into a folder.

    ``folder``: where they go. ``recording``, ``survey``: the raw recording, and what was identified from it. ``steps``:
    progress of the command. ``thesis``: the same recording done the thesis' way, to compare. ``line_selection``: what
    other ways to measure a sine give, to compare. ``truth``: true values by name, where they are known. ``pictures``:
    whether the charts are written as pictures, too. ``previous``: fingerprint of an earlier test, with which the first
    page compares. ``pdf``: whether the first pages are written as PDF too. ``hints``: what the recording does not say
    itself.
    """
    write_fingerprint(survey.fingerprint, folder / FINGERPRINT)
    steps.begin("Writing the report", total=1.0)
    with read_recording(recording, **hints) as opened:
        render_report(
            folder,
            survey,
            recording=opened,
            thesis=thesis,
            truth=truth,
            line_selection=line_selection,
            sensitivity=(survey.identification.structure,),
            previous=previous,
            pictures=pictures,
            pdf=pdf,
            progress=steps.reach,
        )


@dataclass(frozen=True, kw_only=True, slots=True)
class Report:
    """What the report of ``identify`` is made with."""

    about: ReportOptions
    """What the user says of the test."""
    pictures: bool
    """Whether the charts are written as pictures, too."""

    def write(
        self,
        folder: Path,
        recording: Path,
        survey: Survey,
        *,
        hints: Mapping[str, Any],
        steps: Steps,
        truth: Mapping[str, float] | None = None,
    ) -> None:
        """Write the results of a survey into a folder."""
        write_results(
            folder,
            recording,
            survey,
            steps=steps,
            truth=truth,
            pictures=self.pictures,
            previous=self.about.previous,
            pdf=self.about.pdf,
            hints=hints,
        )


def print_paths(output: Path, *, report: bool = True) -> None:
    """Print where fingerprint and report are."""
    echo(f"Fingerprint: {output / FINGERPRINT}")
    if report:
        echo(f"Report:      {output / REPORT}")


def print_comparison(comparison: StructureComparison, *, is_answer: bool = False) -> None:
    """Print which structure the data want and why, and the criteria and tests of all."""
    print_findings(f"Which structure: {comparison.best.name}", comparison.sentences, is_answer=is_answer)
    give("criteria", {candidate.name: candidate.criteria for candidate in comparison.candidates})
    print_tables(structure_tables(comparison))
