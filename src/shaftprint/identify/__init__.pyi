from .comparison._compare import compare_fits, compare_structures
from .fit._estimate import Estimate
from .fit._identification import Identification
from .fit._identify import identify, identify_jointly
from .fit._refit import refit
from .fit._scan import scan
from .judgement._requirements import Requirements
from .judgement._verdict import Verdict, assess
from .likelihood._fit_percent import fit_percent
from .likelihood._known import priors_from_vessel
from .likelihood._prior import Prior
from .likelihood._weighting import MaximumLikelihood, StudentT, Unweighted
from .prediction._accuracy import predict_accuracy
from .prediction._identifiability import identifiability
from .prediction._noise_at_speeds import noise_at
from .prediction._noise_levels import NoiseLevels, noise_levels
from .prediction._planned_response import expected_response, planned_lines, planned_response
from .search._settings import Settings
from .search._starts import Draw, GivenStarts, Uniform
from .uncertainty._bootstrap import bootstrap
from .uncertainty._budget import Budget, BudgetRow, budget
from .uncertainty._profile import profile, profile_intervals

__all__ = [
    "Budget",
    "BudgetRow",
    "Draw",
    "Estimate",
    "GivenStarts",
    "Identification",
    "MaximumLikelihood",
    "NoiseLevels",
    "Prior",
    "Requirements",
    "Settings",
    "StudentT",
    "Uniform",
    "Unweighted",
    "Verdict",
    "assess",
    "bootstrap",
    "budget",
    "compare_fits",
    "compare_structures",
    "expected_response",
    "fit_percent",
    "identifiability",
    "identify",
    "identify_jointly",
    "noise_at",
    "noise_levels",
    "planned_lines",
    "planned_response",
    "predict_accuracy",
    "priors_from_vessel",
    "profile",
    "profile_intervals",
    "refit",
    "scan",
]
