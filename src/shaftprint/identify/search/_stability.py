"""Which parameter sets of a fit are stable models, in every term and with exact delays."""

from shaftprint.arrays import BoolArray, FloatArray
from shaftprint.identify.likelihood import Objective
from shaftprint.identify.search._levenberg_marquardt import Allowed


def stable_models(objective: Objective) -> Allowed:
    """Return a function that tells of free parameters, shape (rows, free), whether the models are stable."""

    def stable(theta: FloatArray) -> BoolArray:
        return objective.stable(objective.complete(theta))

    return stable
