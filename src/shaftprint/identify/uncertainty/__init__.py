"""How far a number can be trusted: profile intervals, repeats, bands and the budget of every source."""

from shaftprint.identify.uncertainty._band import ResponseBand, StepBand, model_band, response_band, step_band
from shaftprint.identify.uncertainty._bootstrap import Bootstrap, BootstrapEstimate, bootstrap
from shaftprint.identify.uncertainty._budget import Budget, BudgetRow, budget
from shaftprint.identify.uncertainty._joint import JointCovariance, joint_covariance
from shaftprint.identify.uncertainty._profile import Interval, Profile, profile, profile_intervals
from shaftprint.identify.uncertainty._profile_curve import ProfileCurve, profile_curve
from shaftprint.identify.uncertainty._propagation import propagation

__all__ = [
    "Bootstrap",
    "BootstrapEstimate",
    "Budget",
    "BudgetRow",
    "Interval",
    "JointCovariance",
    "Profile",
    "ProfileCurve",
    "ResponseBand",
    "StepBand",
    "bootstrap",
    "budget",
    "joint_covariance",
    "model_band",
    "profile",
    "profile_curve",
    "profile_intervals",
    "propagation",
    "response_band",
    "step_band",
]
