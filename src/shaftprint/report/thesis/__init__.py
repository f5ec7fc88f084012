"""The thesis' way beside the identification: its models, and where its numbers come from."""

from shaftprint.report.thesis._explanation import Explanation, can_explain, explain_thesis
from shaftprint.report.thesis._families import Family, thesis_families
from shaftprint.report.thesis._thesis_mode import thesis_findings, thesis_fit_table
from shaftprint.report.thesis._words import (
    damping_table,
    explanation_sentences,
    gain_table,
    inertia_table,
    integral_table,
)

__all__ = [
    "Explanation",
    "Family",
    "can_explain",
    "damping_table",
    "explain_thesis",
    "explanation_sentences",
    "gain_table",
    "inertia_table",
    "integral_table",
    "thesis_families",
    "thesis_findings",
    "thesis_fit_table",
]
