"""Which parameter sets of a fit are stable models, in every experiment and with exact delays."""

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray
from shaftprint.identify._levenberg_marquardt import Allowed
from shaftprint.identify._objective import Objective
from shaftprint.models import stable_rows


def stable_models(objective: Objective) -> Allowed:
    """Return a function that tells of free parameters, shape (rows, free), whether the models are stable."""

    def stable(theta: FloatArray) -> BoolArray:
        values = objective.complete(theta)
        return np.asarray(np.all([stable_rows(e.structure, e.own(values)) for e in objective.experiments], axis=0))

    return stable
