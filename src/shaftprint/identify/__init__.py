"""Fit a structure to a measured response: search, weights, covariance.

=================== ======= ==========================================================================================
quantity            unit    meaning
=================== ======= ==========================================================================================
cost                -       half the sum of squared weighted residuals; for maximum likelihood ``2 cost`` is a
                            chi-square
``fit_percent``     %       ``100 (1 - |y - yh| / |y - mean y|)`` of one output (thesis eq. 2.41)
``fit_ceiling``     %       the same for the true model: what the noise allows
covariance          mixed   of the free parameters, each in its own unit
=================== ======= ==========================================================================================
"""

from shaftprint.identify._accuracy import Accuracy, predict_accuracy, predict_joint_accuracy
from shaftprint.identify._band import ResponseBand, StepBand, model_band, response_band, step_band
from shaftprint.identify._bootstrap import Bootstrap, BootstrapEstimate, bootstrap
from shaftprint.identify._budget import Budget, BudgetRow, budget
from shaftprint.identify._compare import compare_fits, compare_structures, expect_comparable
from shaftprint.identify._comparison import Candidate, Comparison
from shaftprint.identify._covariance import estimate_covariance
from shaftprint.identify._criteria import Criteria, criteria_of
from shaftprint.identify._directions import Direction
from shaftprint.identify._fit_percent import fit_ceiling, fit_percent
from shaftprint.identify._fit_test import FitTest
from shaftprint.identify._groups import Group
from shaftprint.identify._identifiability import Identifiability, identifiability
from shaftprint.identify._identification import Cluster, Estimate, Identification
from shaftprint.identify._identify import identify, identify_jointly
from shaftprint.identify._known import PRIOR_OF_G, priors_from_vessel
from shaftprint.identify._left_out import Foretold
from shaftprint.identify._likelihood_ratio import LikelihoodRatio
from shaftprint.identify._line_test import LineTest
from shaftprint.identify._load_factors import load_factors, with_load
from shaftprint.identify._noise_levels import NoiseLevels, noise_levels, stated_noise
from shaftprint.identify._optima import Optimum
from shaftprint.identify._part import Part
from shaftprint.identify._planned_response import expected_response, planned_lines, planned_response
from shaftprint.identify._predicted_intervals import predict_intervals
from shaftprint.identify._prior import Prior
from shaftprint.identify._profile import Interval, Profile, profile, profile_intervals
from shaftprint.identify._profile_curve import ProfileCurve, profile_curve
from shaftprint.identify._refit import Refits, refit
from shaftprint.identify._requirements import Requirements
from shaftprint.identify._scan import Minimum, Scan, scan, scan_response
from shaftprint.identify._search_report import SearchReport, report_search
from shaftprint.identify._sensor import PickedUp, with_sensor
from shaftprint.identify._settings import Settings, Stability
from shaftprint.identify._stan_tug_noise import STAN_TUG_NOISE
from shaftprint.identify._starts import Draw, LatinHypercube, Uniform
from shaftprint.identify._suspects import Suspect, suspects_of
from shaftprint.identify._term import FittedTerm, Repeats, Term, TermTest
from shaftprint.identify._verdict import Verdict, assess
from shaftprint.identify._weighting import MaximumLikelihood, StudentT, Unweighted, Weighting

__all__ = [
    "PRIOR_OF_G",
    "STAN_TUG_NOISE",
    "Accuracy",
    "Bootstrap",
    "BootstrapEstimate",
    "Budget",
    "BudgetRow",
    "Candidate",
    "Cluster",
    "Comparison",
    "Criteria",
    "Direction",
    "Draw",
    "Estimate",
    "FitTest",
    "FittedTerm",
    "Foretold",
    "Group",
    "Identifiability",
    "Identification",
    "Interval",
    "LatinHypercube",
    "LikelihoodRatio",
    "LineTest",
    "MaximumLikelihood",
    "Minimum",
    "NoiseLevels",
    "Optimum",
    "Part",
    "PickedUp",
    "Prior",
    "Profile",
    "ProfileCurve",
    "Refits",
    "Repeats",
    "Requirements",
    "ResponseBand",
    "Scan",
    "SearchReport",
    "Settings",
    "Stability",
    "StepBand",
    "StudentT",
    "Suspect",
    "Term",
    "TermTest",
    "Uniform",
    "Unweighted",
    "Verdict",
    "Weighting",
    "assess",
    "bootstrap",
    "budget",
    "compare_fits",
    "compare_structures",
    "criteria_of",
    "estimate_covariance",
    "expect_comparable",
    "expected_response",
    "fit_ceiling",
    "fit_percent",
    "identifiability",
    "identify",
    "identify_jointly",
    "load_factors",
    "model_band",
    "noise_levels",
    "planned_lines",
    "planned_response",
    "predict_accuracy",
    "predict_intervals",
    "predict_joint_accuracy",
    "priors_from_vessel",
    "profile",
    "profile_curve",
    "profile_intervals",
    "refit",
    "report_search",
    "response_band",
    "scan",
    "scan_response",
    "stated_noise",
    "step_band",
    "suspects_of",
    "with_load",
    "with_sensor",
]
