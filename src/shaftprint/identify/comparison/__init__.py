"""Which of several structures the data want: criteria, tests of one within another, lines left out."""

from shaftprint.identify.comparison._compare import compare_fits, compare_jointly, compare_structures, expect_comparable
from shaftprint.identify.comparison._comparison import Candidate, StructureComparison
from shaftprint.identify.comparison._criteria import Criteria, criteria_of
from shaftprint.identify.comparison._hold_out import HoldOut, hold_out
from shaftprint.identify.comparison._likelihood_ratio import LikelihoodRatio, likelihood_ratio
from shaftprint.identify.comparison._nesting import Nesting, nesting
from shaftprint.identify.comparison._sentences import comparison_words

__all__ = [
    "Candidate",
    "Criteria",
    "HoldOut",
    "LikelihoodRatio",
    "Nesting",
    "StructureComparison",
    "compare_fits",
    "compare_jointly",
    "compare_structures",
    "comparison_words",
    "criteria_of",
    "expect_comparable",
    "hold_out",
    "likelihood_ratio",
    "nesting",
]
