"""Samples of the parameters from their covariance, for an FMU that holds many of them."""

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.errors import ExportError
from shaftprint.export._model import ExportedModel

MOST_TRIES = 1000


def posterior_deviations(model: ExportedModel, samples: int, rng: np.random.Generator) -> FloatArray:
    """Return what samples of the parameters differ by from the estimate, the estimate first: zeros.

    ``samples``: how many. ``rng``: where they are drawn from: a normal distribution, cut off at the bounds of the
    parameters. Returns shape (1 + samples, parameters). Raises ExportError if the covariance is not known, or hardly a
    sample keeps to the bounds.
    """
    deviations = np.zeros((1 + samples, len(model.structure.parameters)))
    if not samples:
        return frozen_float(deviations)
    if not model.uncertain:
        raise ExportError("FMU of posterior samples: expected parameters with a covariance, found none.")
    places = [model.structure.names.index(name) for name in model.uncertain]
    chosen = [model.structure.parameters[index] for index in places]
    estimate = model.values[places]
    lower = np.minimum([p.lower for p in chosen], estimate)
    upper = np.maximum([p.upper for p in chosen], estimate)
    root = _root(model.covariance_matrix)
    row = 0
    for _ in range(MOST_TRIES * samples):
        step = root @ rng.standard_normal(len(places))
        if np.all((estimate + step >= lower) & (estimate + step <= upper)):
            row += 1
            deviations[row, places] = step
            if row == samples:
                return frozen_float(deviations)
    raise ExportError(
        f"FMU of posterior samples: expected {samples} samples within the bounds of {', '.join(model.uncertain)}, "
        f"found {row} in {MOST_TRIES * samples}: the parameters are too uncertain for samples."
    )


def _root(covariance: FloatArray) -> FloatArray:
    """Return a matrix whose product with its transpose is the covariance, which may be singular."""
    scale = np.sqrt(np.diag(covariance))
    values, vectors = np.linalg.eigh(covariance / np.outer(scale, scale))
    return np.asarray(scale[:, None] * vectors * np.sqrt(np.maximum(values, 0.0)))
