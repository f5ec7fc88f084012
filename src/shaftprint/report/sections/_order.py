"""The sections of a report in the order of the page: a new one is a function and a line here."""

from shaftprint.report.sections._black_box import black_box_section
from shaftprint.report.sections._changes import change_section
from shaftprint.report.sections._engineer import budget_section, folded, number_section, verdict_section
from shaftprint.report.sections._inertia import inertia_section
from shaftprint.report.sections._legs import leg_section
from shaftprint.report.sections._meanings import explained, meanings_of
from shaftprint.report.sections._measurement import response_section, signal_section, time_section
from shaftprint.report.sections._models import (
    explanation_section,
    sensitivity_section,
    structure_section,
    thesis_section,
)
from shaftprint.report.sections._quality import quality_section
from shaftprint.report.sections._results import fit_section, parameter_section, stability_section, summary_section
from shaftprint.report.sections._search import comparison_section, search_section
from shaftprint.report.sections._sections import Inputs, Section
from shaftprint.report.sections._uncertainty import uncertainty_section
from shaftprint.report.sections._validation import validation_section


def page_sections(inputs: Inputs) -> list[Section]:
    """Return the sections that a survey fills: the engineer's summary, then the appendix, which is folded."""
    return _explained(inputs, [*_engineer_sections(inputs), *map(folded, _appendix_sections(inputs))])


def thesis_sections(inputs: Inputs) -> list[Section]:
    """Return the sections of the page on the thesis' way; nothing where it was not tried."""
    if inputs.thesis is None:
        return []
    return _explained(inputs, [*thesis_section(inputs), *explanation_section(inputs), *structure_section(inputs)])


def _explained(inputs: Inputs, sections: list[Section]) -> list[Section]:
    meanings = meanings_of(inputs)
    return [explained(section, meanings) for section in sections]


def _engineer_sections(inputs: Inputs) -> list[Section]:
    refused = black_box_section(inputs)
    return [verdict_section(inputs), number_section(inputs), fit_section(inputs), *refused, *budget_section(inputs)]


def _appendix_sections(inputs: Inputs) -> list[Section]:
    return [
        *change_section(inputs),
        summary_section(inputs),
        parameter_section(inputs),
        *uncertainty_section(inputs),
        *inertia_section(inputs),
        *stability_section(inputs),
        *validation_section(inputs),
        search_section(inputs),
        *comparison_section(inputs),
        quality_section(inputs),
        response_section(inputs),
        *leg_section(inputs),
        signal_section(inputs),
        *time_section(inputs),
        *(structure_section(inputs) if inputs.thesis is None else []),
        *sensitivity_section(inputs),
    ]
