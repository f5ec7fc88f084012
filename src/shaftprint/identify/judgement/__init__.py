"""May the numbers of a fit be used, which of them, and why not: the verdict and the sentences that give its reasons."""

from shaftprint.identify.judgement._misfit import explained, misfit_words
from shaftprint.identify.judgement._number_precision import doubts_of
from shaftprint.identify.judgement._phrases import probability
from shaftprint.identify.judgement._requirements import Requirements
from shaftprint.identify.judgement._search_report import SearchReport, report_search
from shaftprint.identify.judgement._suspects import Suspect, suspects_of
from shaftprint.identify.judgement._verdict import Verdict, assess

__all__ = [
    "Requirements",
    "SearchReport",
    "Suspect",
    "Verdict",
    "assess",
    "doubts_of",
    "explained",
    "misfit_words",
    "probability",
    "report_search",
    "suspects_of",
]
