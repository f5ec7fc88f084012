from ._both_shafts import load_trials_of_both, run_both
from ._fit_options import FitOptions
from ._fits import fit, priors_of
from ._legs import leg_tests
from ._limits import with_limits
from ._measurement import Measurement, measure
from ._of_vessel import default_structure, of_vessel
from ._read import read
from ._shipped_noise import STAN_TUG_NOISE, STAN_TUG_NOISE_AT_SPEEDS
from ._survey import Survey, run, survey_of
from ._thesis_mode import ThesisMode
from ._thesis_way import GAUGE
from ._trial import Trial, load_trial
from ._validate import validate_fingerprint

__all__ = [
    "GAUGE",
    "STAN_TUG_NOISE",
    "STAN_TUG_NOISE_AT_SPEEDS",
    "FitOptions",
    "Measurement",
    "Survey",
    "ThesisMode",
    "Trial",
    "default_structure",
    "fit",
    "leg_tests",
    "load_trial",
    "load_trials_of_both",
    "measure",
    "of_vessel",
    "priors_of",
    "read",
    "run",
    "run_both",
    "survey_of",
    "validate_fingerprint",
    "with_limits",
]
