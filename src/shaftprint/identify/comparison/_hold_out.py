"""How well a fit predicts lines that were left out of it.

The lines are dealt out in turn into folds, those of several responses one after the other, so that each fold spreads
over the whole band. The structure is searched anew without each fold, and the fold's lines are compared with what it
says there, in units of their noise:
``(y - f)^T C^-1 (y - f)`` per datum. For the true structure that is 1 for the noise and, to first order,
``trace(C^-1 G P G^T)`` for the uncertainty ``P`` of the parameters with the model's slopes ``G``.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arrays import BoolArray, ComplexArray, FloatArray
from shaftprint.errors import IdentificationError
from shaftprint.identify.fit._covariance import variance_along
from shaftprint.identify.fit._fit_of import fit_of
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.likelihood._experiment import Experiment
from shaftprint.identify.likelihood._fitted_response import channels_of
from shaftprint.identify.likelihood._load_factors import load_factors
from shaftprint.spectra._frequency_response import FrequencyResponse


@dataclass(frozen=True, kw_only=True, slots=True)
class HoldOut:
    """How well left-out lines were predicted."""

    square: float
    """Mean squared error of a left-out datum, in units of its noise."""
    expected: float
    """What that would be on average if the structure holds; infinite where the other lines cannot predict one."""
    folds: int
    """How many times a part of the lines was left out."""


def hold_out(identification: Identification, *, folds: int, rng: np.random.Generator) -> HoldOut:
    """Return how well the structure predicts each part of the lines from the others.

    ``identification``: the fit to all lines; its settings are used for those without a part of them. ``folds``: number
    of parts; as many as there are lines where it is larger. ``rng``: source of the start values. Raises
    IdentificationError if there are fewer than two folds, or the structure cannot be fitted without one of them.
    """
    if folds < 2:
        raise IdentificationError(f"folds: expected 2 or more, found {folds}.")
    fitted = [experiment.fitted for experiment in identification.objective.experiments]
    lines = np.flatnonzero(np.concatenate(fitted))
    count = min(folds, lines.size)
    square = expected = 0.0
    for fold in range(count):
        held_out = np.zeros(sum(one.size for one in fitted), dtype=np.bool_)
        held_out[lines[fold::count]] = True
        parts = np.split(held_out, np.cumsum([one.size for one in fitted])[:-1])
        error, spread = _of_fold(identification, parts, rng)
        square, expected = square + error, expected + spread
    data = identification.data_count
    return HoldOut(square=square / data, expected=1.0 + expected / data, folds=count)


def _of_fold(
    identification: Identification, held_out: Sequence[BoolArray], rng: np.random.Generator
) -> tuple[float, float]:
    """Return the squared error of some lines, and the part of it that the fit's uncertainty is expected to add.

    ``held_out``: which lines of each response are left out.
    """
    parts = list(zip(identification.experiments, held_out, strict=True))
    kept = [(one.structure, replace(one.response, used=one.fitted & ~out)) for one, out in parts]
    try:
        fit = fit_of(kept, rng=rng, settings=identification.settings)
    except IdentificationError as reason:
        names = [name for one, out in parts for name, is_out in zip(one.response.lines, out, strict=True) if is_out]
        raise IdentificationError(
            f"structure {identification.structure.name} without {', '.join(names)}: {reason}"
        ) from None
    error = spread = 0.0
    for experiment, (one, out) in zip(fit.objective.experiments, parts, strict=True):
        if out.any():
            residuals, slopes = _at_lines(experiment, fit.values, _lines_of(one.response, out))
            rows = np.zeros((residuals.size, len(fit.objective.free)))
            rows[:, experiment.columns] = slopes
            theta = fit.values[list(fit.objective.free)]
            error += float(residuals @ residuals)
            spread += sum(variance_along(fit.objective, theta, row) for row in rows)
    return error, spread


def _lines_of(response: FrequencyResponse, chosen: BoolArray) -> FrequencyResponse:
    return response.of_lines(*(name for name, is_chosen in zip(response.lines, chosen, strict=True) if is_chosen))


def _at_lines(experiment: Experiment, values: FloatArray, part: FrequencyResponse) -> tuple[FloatArray, FloatArray]:
    """Return what a model misses of some lines over their noise, and its slopes to the structure's free parameters.

    Shapes (lines x size,) and (lines x size, free).
    """
    structure = experiment.structure
    model, slopes = structure.gradient(
        experiment.structure_values(values), 1j * part.omega_rad_s, factors=load_factors(structure, part)
    )
    root = np.asarray(np.linalg.cholesky(part.covariance), dtype=np.float64)
    return _whitened(root, channels_of(part) - model), np.stack([_whitened(root, slope) for slope in slopes], axis=1)


def _whitened(root: FloatArray, channels: ComplexArray) -> FloatArray:
    """Return ``L^-1 [Re, Im]`` of all lines one after the other, shape (lines x size,)."""
    parts = np.concatenate([channels.real, channels.imag]).T
    return np.asarray(np.linalg.solve(root, parts[:, :, None]).ravel())
