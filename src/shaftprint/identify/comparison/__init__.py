"""Which of several structures the data want: criteria, tests of one within another, lines left out."""

from shaftprint.identify.comparison._compare import compare_fits, compare_structures, expect_comparable
from shaftprint.identify.comparison._comparison import Candidate, Comparison
from shaftprint.identify.comparison._criteria import Criteria, criteria_of
from shaftprint.identify.comparison._hold_out import Foretold
from shaftprint.identify.comparison._likelihood_ratio import LikelihoodRatio

__all__ = [
    "Candidate",
    "Comparison",
    "Criteria",
    "Foretold",
    "LikelihoodRatio",
    "compare_fits",
    "compare_structures",
    "criteria_of",
    "expect_comparable",
]
