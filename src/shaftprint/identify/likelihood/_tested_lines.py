"""The squared distances of a response's lines from a model, as parts of the test of fit (see ``FitTest``)."""

from collections.abc import Sequence

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.identify.likelihood._line_test import LineTest
from shaftprint.identify.likelihood._tails import excess_freedom
from shaftprint.identify.likelihood._term import TermTest


def tested_lines(whitened: FloatArray, freedom: FloatArray, names: Sequence[str], number: int) -> TermTest:
    """Return what the lines of a response add to the test of fit.

    ``whitened``: residuals of each line over the covariance that it has as a weight, shape (lines, size). ``freedom``:
    real degrees of freedom behind that covariance, infinite for a known one, shape (lines,). ``names``: names of the
    lines. ``number``: number of the experiment.
    """
    size = whitened.shape[1]
    squares = np.sum(whitened**2, axis=1)
    excess = excess_freedom(freedom, size)
    means, variances = _moments(excess, size)
    return TermTest(
        chi_square=float(np.sum(_shares(squares, excess))),
        count=whitened.size,
        mean=float(means.sum()),
        variance=float(variances.sum()),
        lines=tuple(
            LineTest(experiment=number, name=name, distance=distance, data_count=size, excess=k)
            for name, distance, k in zip(names, squares.tolist(), excess.tolist(), strict=True)
        ),
    )


def _shares(squares: FloatArray, excess: FloatArray) -> FloatArray:
    """Return what each line adds to the sum."""
    exact = np.isinf(excess)
    finite = np.where(exact, 1.0, excess)
    return np.where(exact, squares, (finite + 2.0) * np.log1p(squares / finite))


def _moments(excess: FloatArray, size: int) -> tuple[FloatArray, FloatArray]:
    """Return mean and variance of what each line adds to the sum."""
    steps = 2.0 * np.arange(size // 2)[:, None]
    means = 2.0 / (1.0 + steps / (excess + 2.0))
    return means.sum(axis=0), (means**2).sum(axis=0)
