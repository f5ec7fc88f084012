"""The report: one page with its figures in a folder, readable without a network."""

import base64
import hashlib
from collections.abc import Callable, Mapping, Sequence
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

from jinja2 import DictLoader, Environment, StrictUndefined
from markupsafe import Markup

from shaftprint.report._folder import FIGURES, PAGE, report_written_whole
from shaftprint.report._inertia_sections import inertia_section
from shaftprint.report._measurement_sections import quality_section, response_section, signal_section, time_section
from shaftprint.report._model_sections import (
    explanation_section,
    sensitivity_section,
    structure_section,
    thesis_section,
)
from shaftprint.report._result_sections import fit_section, parameter_section, stability_section, summary_section
from shaftprint.report._search_sections import comparison_section, search_section
from shaftprint.report._sections import Inputs, Picture, Section
from shaftprint.report._style import save_figure
from shaftprint.report._table import sentence_html
from shaftprint.report._uncertainty_sections import uncertainty_section
from shaftprint.report._verdict_sections import verdict_section

if TYPE_CHECKING:
    from shaftprint.campaign import Campaign
    from shaftprint.fingerprint import Fingerprint
    from shaftprint.identify import Comparison, Identification
    from shaftprint.models import Structure
    from shaftprint.recording import Recording
    from shaftprint.report._thesis_mode import ThesisMode
    from shaftprint.signals import Signals
    from shaftprint.spectra import FrequencyResponse, Spectra
    from shaftprint.vessel import Vessel

LARGEST_SVG_BYTES = 500_000
TEMPLATE = "report.html.j2"
STYLE = "report.css"


def render_report(
    directory: str | Path,
    *,
    fingerprint: "Fingerprint",
    identification: "Identification",
    signals: "Signals",
    spectra: "Spectra",
    vessel: "Vessel",
    campaign: "Campaign",
    recording: "Recording | None" = None,
    fits: "Mapping[str, Identification] | None" = None,
    thesis: "ThesisMode | None" = None,
    truth: Mapping[str, float] | None = None,
    line_selection: "Mapping[str, FrequencyResponse] | None" = None,
    comparisons: "Sequence[Comparison]" = (),
    sensitivity: "Sequence[Structure]" = (),
    overwrite: bool = False,
    progress: Callable[[float], None] | None = None,
) -> Path:
    """Write a report, ``index.html`` and a folder ``figures``, whole or not at all; return the path of the page.

    The page asks for nothing outside its folder and runs no script.

    Parameters
    ----------
    directory
        Where the report goes; made if it does not exist. Other files there are left alone.
    fingerprint, identification, signals, spectra, vessel, campaign
        The fingerprint and what it was made from.
    recording
        Raw recording, open; without it the figures of raw channels are left out.
    fits
        Structures of the thesis fitted to the same responses, by name.
    thesis
        The same recording treated the thesis' way.
    truth
        True values by parameter name, in the parameters' units, where they are known.
    line_selection
        Responses by other ways to measure the sines, by name of the way, the spectra's own among them.
    comparisons
        Which of several structures the data want.
    sensitivity
        Structures whose Bode families are shown.
    overwrite
        Whether an earlier report there may be replaced.
    progress
        Is told the finished share, from 0 to 1.

    Raises
    ------
    FileExistsError
        If there is a report already and ``overwrite`` is false.
    """
    inputs = Inputs(
        fingerprint=fingerprint,
        identification=identification,
        signals=signals,
        spectra=spectra,
        vessel=vessel,
        campaign=campaign,
        recording=recording,
        fits=fits or {},
        thesis=thesis,
        truth=truth or {},
        line_selection=line_selection or {},
        comparisons=comparisons,
        sensitivity=sensitivity,
    )
    sections = _sections(inputs)
    place = Path(directory)
    with report_written_whole(place, overwrite=overwrite) as part:
        pictures = [picture for section in sections for picture in section.pictures]
        sources = {}
        for number, picture in enumerate(pictures, start=1):
            sources[picture.name] = _drawn(picture, part)
            if progress is not None:
                progress(number / len(pictures))
        (part / PAGE).write_text(_page(inputs, sections, sources), encoding="utf-8")
    return place / PAGE


def _sections(inputs: Inputs) -> list[Section]:
    return [
        verdict_section(inputs),
        summary_section(inputs),
        parameter_section(inputs),
        *uncertainty_section(inputs),
        *inertia_section(inputs),
        fit_section(inputs),
        *stability_section(inputs),
        search_section(inputs),
        *comparison_section(inputs),
        quality_section(inputs),
        response_section(inputs),
        signal_section(inputs),
        *time_section(inputs),
        *structure_section(inputs),
        *thesis_section(inputs),
        *explanation_section(inputs),
        *sensitivity_section(inputs),
    ]


def _drawn(picture: Picture, part: Path) -> str:
    """Draw and save a picture, as PNG where an SVG would be large; return its address on the page."""
    figure = picture.draw()
    path = part / FIGURES / f"{picture.name}.svg"
    save_figure(figure, path)
    if path.stat().st_size > LARGEST_SVG_BYTES:
        path.unlink()
        path = path.with_suffix(".png")
        save_figure(figure, path)
    return f"{FIGURES}/{path.name}"


def _page(inputs: Inputs, sections: Sequence[Section], sources: Mapping[str, str]) -> str:
    folder = files(__package__) / "templates"
    style = (folder / STYLE).read_text(encoding="utf-8")
    digest = base64.b64encode(hashlib.sha256(style.encode()).digest()).decode()
    environment = Environment(
        loader=DictLoader({TEMPLATE: (folder / TEMPLATE).read_text(encoding="utf-8")}),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["symbols"] = sentence_html
    return environment.get_template(TEMPLATE).render(
        fingerprint=inputs.fingerprint,
        sections=sections,
        sources=sources,
        # The style sheet is ours and holds nothing of the user's.
        style=Markup(style),  # noqa: S704
        style_digest=digest,
    )
