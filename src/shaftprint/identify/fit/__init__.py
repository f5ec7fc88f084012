"""The verb and what it found: values, covariance, test of fit, other optima, the cost along a parameter."""

from shaftprint.identify.fit._covariance import estimate_covariance, known_covariance, known_variance, variance_along
from shaftprint.identify.fit._fit_of import fit_of
from shaftprint.identify.fit._fit_test import FitTest
from shaftprint.identify.fit._identification import Cluster, Estimate, Identification
from shaftprint.identify.fit._identify import identify, identify_jointly
from shaftprint.identify.fit._measured_inputs import has_measured_inputs
from shaftprint.identify.fit._optima import SAME_COST, SAME_PLACE, WITHIN, Optimum, is_passed_over, is_rival, optima_of
from shaftprint.identify.fit._part_tests import part_tests
from shaftprint.identify.fit._pseudo_inverse import LOST_SHARE, PseudoInverse
from shaftprint.identify.fit._refit import Refits, refit, refit_redrawn
from shaftprint.identify.fit._scan import Minimum, Scan, scan, scan_response
from shaftprint.identify.fit._sensor import PickUpReading, pick_up_values, with_sensor

__all__ = [
    "LOST_SHARE",
    "SAME_COST",
    "SAME_PLACE",
    "WITHIN",
    "Cluster",
    "Estimate",
    "FitTest",
    "Identification",
    "Minimum",
    "Optimum",
    "PickUpReading",
    "PseudoInverse",
    "Refits",
    "Scan",
    "estimate_covariance",
    "fit_of",
    "has_measured_inputs",
    "identify",
    "identify_jointly",
    "is_passed_over",
    "is_rival",
    "known_covariance",
    "known_variance",
    "optima_of",
    "part_tests",
    "pick_up_values",
    "refit",
    "refit_redrawn",
    "scan",
    "scan_response",
    "variance_along",
    "with_sensor",
]
