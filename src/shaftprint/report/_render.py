"""The report of one fingerprint: one page with its figures in a folder, readable without a network."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from shaftprint.arguments import refusing_none
from shaftprint.clocks._logger_clock import logger_clocks
from shaftprint.errors import ReportError
from shaftprint.files import written_whole
from shaftprint.fingerprint._json_file import fingerprint_sha256
from shaftprint.plain_table import Table, texts
from shaftprint.report._folder import PAGE, THESIS
from shaftprint.report._page import Page, expect_reportlab, page_as_pdf, write_page
from shaftprint.report.sections._order import page_sections, thesis_sections
from shaftprint.report.sections._sections import Inputs, Section
from shaftprint.report.sections.first_page._cover_of import cover_of

if TYPE_CHECKING:
    from shaftprint.fingerprint._fingerprint import Fingerprint
    from shaftprint.models._structure import Structure
    from shaftprint.recording._recording import Recording
    from shaftprint.spectra._frequency_response import FrequencyResponse
    from shaftprint.survey._survey import Survey
    from shaftprint.survey._thesis_mode import ThesisMode

THESIS_TITLE = "The thesis' way on the same recording"


@refusing_none(ReportError)
def render_report(
    directory: str | Path,
    survey: "Survey",
    *,
    recording: "Recording | None" = None,
    thesis: "ThesisMode | None" = None,
    truth: Mapping[str, float] | None = None,
    line_selection: "Mapping[str, FrequencyResponse] | None" = None,
    sensitivity: "Sequence[Structure]" = (),
    previous: "Fingerprint | None" = None,
    pdf: bool = False,
    pictures: bool = False,
    overwrite: bool = False,
    progress: Callable[[float], None] | None = None,
) -> Path:
    """Write a report, ``index.html`` with its figures and plots, whole or not at all; return the path of the page.

    The page opens from a disk and asks for nothing outside its folder.

    Parameters
    ----------
    directory
        Where the report goes; made if it does not exist. Other files there are left alone.
    survey
        The fingerprint and what it was made from, such as ``survey.run`` gives it.
    recording
        Raw recording, open; without it the figures of raw channels are left out, and the clocks of loggers that were
        merged into it.
    thesis
        The same recording treated the thesis' way.
    truth
        True values by parameter name, in the parameters' units, where they are known.
    line_selection
        Responses by other ways to measure the sines, by name of the way, the spectra's own among them.
    sensitivity
        Structures whose Bode families are shown.
    previous
        Fingerprint of an earlier test of the line; the first page says what has changed since.
    pdf
        Whether page one and the engineer's summary are written as ``report.pdf`` too.
    pictures
        Whether every chart is written as SVG, PDF and PNG too, into the folder ``figures``.
    overwrite
        Whether an earlier report there may be replaced.
    progress
        Is told the finished share, from 0 to 1.

    Raises
    ------
    FileExistsError
        If there is a report already and ``overwrite`` is false.
    RecordingError
        If the clock maps of the recording cannot be understood.
    ReportError
        If plotly is not installed, or ReportLab is not and a PDF is asked for.
    """
    inputs = _inputs(
        survey,
        previous=previous,
        recording=recording,
        thesis=thesis,
        truth=truth or {},
        line_selection=line_selection or {},
        sensitivity=sensitivity,
        clocks=() if recording is None else logger_clocks(recording),
    )
    beside = thesis_sections(inputs)
    page = _page(inputs, page_sections(inputs), neighbours=[(THESIS, THESIS_TITLE)] if beside else [])
    further = {THESIS: _thesis_page(page, beside)} if beside else {}
    return write_page(
        directory, page, pictures=pictures, overwrite=overwrite, progress=progress, further=further, pdf=pdf
    )


@refusing_none(ReportError)
def render_pdf(path: str | Path, survey: "Survey", *, previous: "Fingerprint | None" = None) -> Path:
    """Write page one and the engineer's summary of a report as PDF of A4, whole or not at all; return its path.

    Parameters
    ----------
    path
        The file; one that is there already is replaced.
    survey
        The fingerprint and what it was made from, such as ``survey.run`` gives it.
    previous
        Fingerprint of an earlier test of the line; the first page says what has changed since.

    Raises
    ------
    ReportError
        If ReportLab is not installed.
    """
    expect_reportlab()
    inputs = _inputs(survey, previous=previous)
    page = _page(inputs, page_sections(inputs), neighbours=[])
    with written_whole(Path(path), overwrite=True) as part:
        page_as_pdf(page, part)
    return Path(path)


def _inputs(survey: "Survey", **further: Any) -> Inputs:
    """Return what a report may show of a survey, and what was given beside it."""
    nothing: dict[str, Any] = {"recording": None, "thesis": None, "truth": {}, "line_selection": {}, "sensitivity": ()}
    return Inputs(
        fingerprint=survey.fingerprint,
        identification=survey.identification,
        signals=survey.signals,
        spectra=survey.spectra,
        vessel=survey.vessel,
        campaign=survey.campaign,
        fits={one.structure.name: one for one in survey.fits[1:]},
        comparisons=survey.comparisons,
        validations=survey.validations,
        levels=survey.measurement.levels,
        legs=survey.measurement.legs,
        leg_tests=survey.leg_tests,
        black_boxes=survey.black_boxes,
        **(nothing | further),
    )


def _thesis_page(page: Page, sections: Sequence[Section]) -> Page:
    """Return the page on the thesis' way, which goes with the report."""
    return replace(
        page,
        title=THESIS_TITLE,
        subtitle=page.title,
        cover=None,
        sections=sections,
        neighbours=[(PAGE, "Report")],
        fingerprint_sha256=None,
    )


def _logs(inputs: Inputs) -> list[tuple[str, str, str]]:
    """Return the loggers' own files of a merged recording: those that had the clock, then those that were moved."""
    clocks = {
        clock.reference: (clock.reference, "logger, had the clock", clock.reference_sha256) for clock in inputs.clocks
    }
    return [*clocks.values(), *((clock.logger, "logger, merged", clock.sha256) for clock in inputs.clocks)]


def _page(inputs: Inputs, sections: Sequence[Section], *, neighbours: Sequence[tuple[str, str]]) -> Page:
    fingerprint = inputs.fingerprint
    conditions = fingerprint.conditions
    sha256 = fingerprint_sha256(fingerprint)
    files = Table(
        title="Files that went into this report",
        columns=texts("file", "what it is", "SHA-256"),
        rows=(
            *((source.name, source.role, source.sha256) for source in fingerprint.sources),
            *_logs(inputs),
            ("fingerprint.json", "what this page shows", sha256),
        ),
    )
    ending = (
        f"shaftprint {fingerprint.shaftprint_version}, fingerprint schema {fingerprint.schema_version}, signals "
        f"prepared in {conditions.mode} mode, speed channel {conditions.speed_channel}. ± is one standard deviation "
        "throughout; bands, intervals and error bars hold 95 %."
    )
    return Page(
        title=f"Fingerprint of {conditions.vessel}",
        subtitle=f"Test “{conditions.campaign}”",
        created=fingerprint.created,
        version=fingerprint.shaftprint_version,
        cover=cover_of(fingerprint, inputs.validations, vessel=inputs.vessel, previous=inputs.previous),
        neighbours=neighbours,
        sections=sections,
        files=files,
        ending=ending,
        fingerprint_sha256=sha256,
    )
