"""The thesis' way beside the identification: its models, and where its numbers come from."""

from shaftprint.report.thesis._explanation import Explanation, can_explain, explain_thesis
from shaftprint.report.thesis._integral_gain import integral_gain
from shaftprint.report.thesis._thesis_mode import calculated_inertia_time_s, thesis_findings, thesis_fit_table
from shaftprint.report.thesis._words import (
    damping_table,
    explanation_sentences,
    gain_table,
    inertia_table,
    integral_table,
)

__all__ = [
    "Explanation",
    "calculated_inertia_time_s",
    "can_explain",
    "damping_table",
    "explain_thesis",
    "explanation_sentences",
    "gain_table",
    "inertia_table",
    "integral_gain",
    "integral_table",
    "thesis_findings",
    "thesis_fit_table",
]
