"""Hold an identified model against records that it was not identified from, in numbers instead of by eye.

=================== ======= ==========================================================================================
quantity            unit    meaning
=================== ======= ==========================================================================================
``fit_percent``     %       ``100 (1 - |y - yh| / |y - mean y|)`` of one output (thesis eq. 2.41)
``fit_ceiling``     %       the same for the true model: what the noise allows
error               -       root mean square of what the model misses beyond noise, over that of the motion
delay               s       of the data behind the model; positive where the data come later
overshoot           %       of the height of a step
deviation           -       ``(x - x_0) / x_0`` from the working point
=================== ======= ==========================================================================================
"""

from shaftprint.validation._foreign import ForeignModel
from shaftprint.validation._model import Model, identified_model, model_of
from shaftprint.validation._prediction import Predict, linear_prediction, simulated_prediction
from shaftprint.validation._settings import ValidationSettings
from shaftprint.validation._step_comparison import StepNumber
from shaftprint.validation._thesis_models import thesis_models
from shaftprint.validation._validate import joined, validate
from shaftprint.validation._validation import ExcerptComparison, ExcerptTraces, Validation
from shaftprint.validation._validation_records import Excerpt, default_records, excerpts_of
from shaftprint.validation.measures import Misfit, Outcome, RemainingDelay

__all__ = [
    "Excerpt",
    "ExcerptComparison",
    "ExcerptTraces",
    "ForeignModel",
    "Misfit",
    "Model",
    "Outcome",
    "Predict",
    "RemainingDelay",
    "StepNumber",
    "Validation",
    "ValidationSettings",
    "default_records",
    "excerpts_of",
    "identified_model",
    "joined",
    "linear_prediction",
    "model_of",
    "simulated_prediction",
    "thesis_models",
    "validate",
]
