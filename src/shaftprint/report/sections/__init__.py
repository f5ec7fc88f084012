"""The sections of the report: title, sentences, tables and pictures, made from what a survey produced."""

from shaftprint.report.sections._comparison_cover import change_in_words, comparison_cover, not_alike
from shaftprint.report.sections._cover import Cover
from shaftprint.report.sections._inertia import inertia_section
from shaftprint.report.sections._measurement import response_section, signal_section, time_section
from shaftprint.report.sections._models import (
    explanation_section,
    sensitivity_section,
    structure_section,
    thesis_section,
)
from shaftprint.report.sections._quality import quality_section
from shaftprint.report.sections._results import (
    fit_section,
    parameter_section,
    stability_section,
    summary_section,
    verdict_section,
)
from shaftprint.report.sections._search import comparison_section, search_section
from shaftprint.report.sections._sections import Inputs, Picture, Section
from shaftprint.report.sections._superintendent import cover_of
from shaftprint.report.sections._uncertainty import budget_table, uncertainty_section
from shaftprint.report.sections._validation import validation_section

__all__ = [
    "Cover",
    "Inputs",
    "Picture",
    "Section",
    "budget_table",
    "change_in_words",
    "comparison_cover",
    "comparison_section",
    "cover_of",
    "explanation_section",
    "fit_section",
    "inertia_section",
    "not_alike",
    "parameter_section",
    "quality_section",
    "response_section",
    "search_section",
    "sensitivity_section",
    "signal_section",
    "stability_section",
    "structure_section",
    "summary_section",
    "thesis_section",
    "time_section",
    "uncertainty_section",
    "validation_section",
    "verdict_section",
]
