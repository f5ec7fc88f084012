"""How well a fit predicts lines that were left out of it.

The lines are dealt out in turn into folds, so that each fold spreads over the whole band. The structure is searched
anew without each fold, and the fold's lines are compared with what it says there, in units of their noise:
``(y - f)^T C^-1 (y - f)`` per datum. For the true structure that is 1 for the noise and, to first order,
``trace(C^-1 G P G^T)`` for the uncertainty ``P`` of the parameters with the model's slopes ``G``.
"""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.errors import IdentificationError
from shaftprint.identify.fit import Identification, identify, variance_along
from shaftprint.identify.likelihood import channels_of, load_factors


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

    Parameters
    ----------
    identification
        The fit to all lines; its settings are used for those without a part of them.
    folds
        Number of parts; as many as there are lines where it is larger.
    rng
        Source of the start values.

    Raises
    ------
    IdentificationError
        If there are fewer than two folds, or the structure cannot be fitted without one of them.
    """
    if folds < 2:
        raise IdentificationError(f"folds: expected 2 or more, found {folds}.")
    response = identification.response
    names = [name for name, fitted in zip(response.lines, identification.fitted, strict=True) if fitted]
    count = min(folds, len(names))
    square = expected = 0.0
    for fold in range(count):
        held_out = names[fold::count]
        kept = [name for name in names if name not in held_out]
        error, spread = _of_fold(identification, kept, held_out, rng)
        square, expected = square + error, expected + spread
    data = identification.data_count
    return HoldOut(square=square / data, expected=1.0 + expected / data, folds=count)


def _of_fold(
    identification: Identification, kept: list[str], held_out: list[str], rng: np.random.Generator
) -> tuple[float, float]:
    """Return the squared error of some lines, and the part of it that the fit's uncertainty is expected to add."""
    structure, response = identification.structure, identification.response
    try:
        fit = identify(structure, response, rng=rng, settings=identification.settings, lines=kept)
    except IdentificationError as reason:
        raise IdentificationError(f"structure {structure.name} without {', '.join(held_out)}: {reason}") from None
    part = response.of_lines(*held_out)
    model, slopes = fit.structure.gradient(fit.values, 1j * part.omega_rad_s, factors=load_factors(fit.structure, part))
    root = np.asarray(np.linalg.cholesky(part.covariance), dtype=np.float64)
    error = _whitened(root, channels_of(part) - model)
    directions = np.stack([_whitened(root, slope) for slope in slopes], axis=1)
    theta = fit.values[list(fit.objective.free)]
    return float(error @ error), sum(variance_along(fit.objective, theta, row) for row in directions)


def _whitened(root: FloatArray, channels: ComplexArray) -> FloatArray:
    """Return ``L^-1 [Re, Im]`` of all lines one after the other, shape (lines x size,)."""
    parts = np.concatenate([channels.real, channels.imag]).T
    return np.asarray(np.linalg.solve(root, parts[:, :, None]).ravel())
