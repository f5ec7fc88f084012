"""Which parameter sets of a fit are stable models, in every term and with exact delays."""

from shaftprint.arrays import BoolArray, FloatArray
from shaftprint.identify._levenberg_marquardt import Allowed
from shaftprint.identify._objective import Objective


def stable_models(objective: Objective) -> Allowed:
    """Return a function that tells of free parameters, shape (rows, free), whether the models are stable."""

    def stable(theta: FloatArray) -> BoolArray:
        return objective.stable(objective.complete(theta))

    return stable
