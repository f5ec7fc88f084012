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

from shaftprint.identify._covariance import estimate_covariance
from shaftprint.identify._fit_percent import fit_ceiling, fit_percent
from shaftprint.identify._identification import Cluster, Estimate, Identification, Settings
from shaftprint.identify._identify import identify
from shaftprint.identify._known import PRIOR_OF_G, priors_from_vessel
from shaftprint.identify._objective import MaximumLikelihood, Unweighted, Weighting
from shaftprint.identify._prior import Prior
from shaftprint.identify._profile import Interval, Profile, profile, profile_intervals
from shaftprint.identify._refit import Refits, refit
from shaftprint.identify._starts import Draw, LatinHypercube, Uniform

__all__ = [
    "PRIOR_OF_G",
    "Cluster",
    "Draw",
    "Estimate",
    "Identification",
    "Interval",
    "LatinHypercube",
    "MaximumLikelihood",
    "Prior",
    "Profile",
    "Refits",
    "Settings",
    "Uniform",
    "Unweighted",
    "Weighting",
    "estimate_covariance",
    "fit_ceiling",
    "fit_percent",
    "identify",
    "priors_from_vessel",
    "profile",
    "profile_intervals",
    "refit",
]
