"""The sections of the report: title, sentences, tables and pictures, made from what a survey produced."""

from shaftprint.report.sections._clocks import clock_sentences
from shaftprint.report.sections._comparison_cover import change_in_words, comparison_cover, not_alike
from shaftprint.report.sections._cover import Card, Cover, State
from shaftprint.report.sections._engineer import budget_section, number_section, verdict_section
from shaftprint.report.sections._inertia import inertia_section
from shaftprint.report.sections._measurement import time_section
from shaftprint.report.sections._order import page_sections, thesis_sections
from shaftprint.report.sections._quality import quality_section
from shaftprint.report.sections._results import fit_section, stability_section, summary_section
from shaftprint.report.sections._search import comparison_section, search_section
from shaftprint.report.sections._sections import Inputs, Picture, Section, picture_name
from shaftprint.report.sections._sketch import Sketch
from shaftprint.report.sections._uncertainty import uncertainty_section
from shaftprint.report.sections._validation import validation_section
from shaftprint.report.sections.first_page import cover_of

__all__ = [
    "Card",
    "Cover",
    "Inputs",
    "Picture",
    "Section",
    "Sketch",
    "State",
    "budget_section",
    "change_in_words",
    "clock_sentences",
    "comparison_cover",
    "comparison_section",
    "cover_of",
    "fit_section",
    "inertia_section",
    "not_alike",
    "number_section",
    "page_sections",
    "picture_name",
    "quality_section",
    "search_section",
    "stability_section",
    "summary_section",
    "thesis_sections",
    "time_section",
    "uncertainty_section",
    "validation_section",
    "verdict_section",
]
