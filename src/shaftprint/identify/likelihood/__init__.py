"""What a fit minimises: lines, records and priors as terms of one likelihood, with their weights."""

from shaftprint.identify.likelihood._build_objective import Source, build_joint_objective, build_objective
from shaftprint.identify.likelihood._experiment import Experiment, ResponseRepeats
from shaftprint.identify.likelihood._fit_percent import fit_ceiling, fit_percent
from shaftprint.identify.likelihood._fitted_response import FittedResponse, channel_names, channels_of
from shaftprint.identify.likelihood._known import (
    PRIOR_OF_G,
    SHARE_ROUNDING,
    expected_from_vessel,
    priors_from_vessel,
    stated_by_vessel,
)
from shaftprint.identify.likelihood._line_test import LineTest
from shaftprint.identify.likelihood._load_factors import load_factors, with_load
from shaftprint.identify.likelihood._objective import Objective, Redrawn
from shaftprint.identify.likelihood._prior import PRIOR_OF, Prior
from shaftprint.identify.likelihood._tails import estimated_tails, excess_freedom, student_tails
from shaftprint.identify.likelihood._term import FittedTerm, Repeats, Term, TermTest, WhitenedTerm
from shaftprint.identify.likelihood._term_check import CheckKind, TermCheck
from shaftprint.identify.likelihood._united_parameters import united_parameters
from shaftprint.identify.likelihood._weighting import MaximumLikelihood, StudentT, Unweighted, Weighting
from shaftprint.identify.likelihood._wishart import estimated_shapes

__all__ = [
    "PRIOR_OF",
    "PRIOR_OF_G",
    "SHARE_ROUNDING",
    "CheckKind",
    "Experiment",
    "FittedResponse",
    "FittedTerm",
    "LineTest",
    "MaximumLikelihood",
    "Objective",
    "Prior",
    "Redrawn",
    "Repeats",
    "ResponseRepeats",
    "Source",
    "StudentT",
    "Term",
    "TermCheck",
    "TermTest",
    "Unweighted",
    "Weighting",
    "WhitenedTerm",
    "build_joint_objective",
    "build_objective",
    "channel_names",
    "channels_of",
    "estimated_shapes",
    "estimated_tails",
    "excess_freedom",
    "expected_from_vessel",
    "fit_ceiling",
    "fit_percent",
    "load_factors",
    "priors_from_vessel",
    "stated_by_vessel",
    "student_tails",
    "united_parameters",
    "with_load",
]
