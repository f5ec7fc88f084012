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

Its folders, each of which imports only from those above it (``judgement`` and ``foresight`` nothing from each other):

=============== ======================================================================================================
folder          what happens there
=============== ======================================================================================================
``likelihood``  what a fit minimises: terms, weights, tails, earlier knowledge
``search``      how the lowest cost is found: settings, starts, descent within bounds
``fit``         the verb and what it found: values, covariance, test of fit, other optima, scans
``uncertainty`` how far a number can be trusted: profile intervals, repeats, bands, the budget
``judgement``   whether the numbers of a fit may be used, and the sentences that say why
``foresight``   what a test can find before it is made
``comparison``  which of several structures the data want
=============== ======================================================================================================
"""

from shaftprint.identify.comparison import (
    Candidate,
    Comparison,
    Criteria,
    Foretold,
    LikelihoodRatio,
    compare_fits,
    compare_structures,
    criteria_of,
    expect_comparable,
)
from shaftprint.identify.fit import (
    Cluster,
    Estimate,
    FitTest,
    Identification,
    Minimum,
    Optimum,
    PickedUp,
    Refits,
    Scan,
    estimate_covariance,
    has_measured_inputs,
    identify,
    identify_jointly,
    refit,
    scan,
    scan_response,
    with_sensor,
)
from shaftprint.identify.foresight import (
    STAN_TUG_NOISE,
    Accuracy,
    Direction,
    Group,
    Identifiability,
    NoiseLevels,
    expected_response,
    identifiability,
    noise_levels,
    planned_lines,
    planned_response,
    predict_accuracy,
    predict_intervals,
    predict_joint_accuracy,
    stated_noise,
)
from shaftprint.identify.judgement import (
    Requirements,
    SearchReport,
    Suspect,
    Verdict,
    assess,
    doubts_of,
    report_search,
    suspects_of,
)
from shaftprint.identify.likelihood import (
    OVER_TORQUE,
    PRIOR_OF_G,
    FittedTerm,
    LineTest,
    MaximumLikelihood,
    Part,
    Prior,
    Repeats,
    StudentT,
    Term,
    TermTest,
    Unweighted,
    Weighting,
    fit_ceiling,
    fit_percent,
    load_factors,
    priors_from_vessel,
    with_load,
)
from shaftprint.identify.search import Draw, LatinHypercube, Settings, Stability, Uniform
from shaftprint.identify.uncertainty import (
    Bootstrap,
    BootstrapEstimate,
    Budget,
    BudgetRow,
    Interval,
    Profile,
    ProfileCurve,
    ResponseBand,
    StepBand,
    bootstrap,
    budget,
    model_band,
    profile,
    profile_curve,
    profile_intervals,
    response_band,
    step_band,
)

__all__ = [
    "OVER_TORQUE",
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
    "doubts_of",
    "estimate_covariance",
    "expect_comparable",
    "expected_response",
    "fit_ceiling",
    "fit_percent",
    "has_measured_inputs",
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
