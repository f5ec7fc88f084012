"""May the numbers of a fit be used, which of them, and why not: the verdict and the sentences that give its reasons."""

from shaftprint.identify.judgement._affected_numbers import AFFECTED, by_weight, depends_on
from shaftprint.identify.judgement._clock_drift import unseen_drift
from shaftprint.identify.judgement._data_contradictions import fails
from shaftprint.identify.judgement._line_quality import good_lines
from shaftprint.identify.judgement._misfit import explained, misfit_words, worst_lines
from shaftprint.identify.judgement._number_precision import doubts_of
from shaftprint.identify.judgement._phrases import listed, number, probability, spans
from shaftprint.identify.judgement._requirements import Requirements
from shaftprint.identify.judgement._search_report import SearchReport, report_search
from shaftprint.identify.judgement._suspects import Suspect, suspects_of
from shaftprint.identify.judgement._verdict import Verdict, assess

__all__ = [
    "AFFECTED",
    "Requirements",
    "SearchReport",
    "Suspect",
    "Verdict",
    "assess",
    "by_weight",
    "depends_on",
    "doubts_of",
    "explained",
    "fails",
    "good_lines",
    "listed",
    "misfit_words",
    "number",
    "probability",
    "report_search",
    "spans",
    "suspects_of",
    "unseen_drift",
    "worst_lines",
]
