"""Does the structure explain the data within their noise? Squared distances of the lines, and their sum."""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.identify._chi_square import chi_square_tail
from shaftprint.identify._f_distribution import f_tail
from shaftprint.identify._objective import Objective


@dataclass(frozen=True, kw_only=True, slots=True)
class LineTest:
    """How far one line lies from the model."""

    experiment: int
    """Number of the experiment, from 0."""
    name: str
    """Name of the line."""
    distance: float
    """Squared distance ``d^2 = (y - f)^T C^-1 (y - f)``: of the order of the number of real data of a line."""
    p_value: float
    """Probability that the true model is that far away or farther."""


@dataclass(frozen=True, kw_only=True, slots=True)
class FitTest:
    """Whether the structure explains the data within their noise."""

    chi_square: float
    """Sum of the squared distances of all lines, and of the squared rows of priors."""
    degrees_of_freedom: int
    """Number of data and prior rows minus the number of free parameters."""
    p_value: float | None
    """Probability of a sum that large or larger if the structure holds; None where nothing is left to test."""
    lines: tuple[LineTest, ...]
    """Each fitted line, experiment by experiment."""


def whitened(objective: Objective, values: FloatArray) -> tuple[FloatArray, ...]:
    """Return ``L^-1 (y - f)`` of every experiment's lines, each of shape (lines, 2 channels)."""
    found = []
    for experiment in objective.experiments:
        model = experiment.structure.response(experiment.own(values), experiment.s, factors=experiment.factors)
        gap = experiment.data - np.concatenate([model.real, model.imag]).T
        found.append(np.linalg.solve(np.linalg.cholesky(experiment.covariance), gap[:, :, None])[:, :, 0])
    return tuple(found)


def tested_fit(objective: Objective, values: FloatArray) -> FitTest:
    """Return the test of fit at the given parameters."""
    lines = tuple(
        line
        for number, residuals in enumerate(whitened(objective, values))
        for line in _line_tests(objective, number, residuals)
    )
    theta = values[list(objective.free)]
    index = objective.prior_rows[:, 0].astype(int)
    prior = (theta[index] - objective.prior_rows[:, 1]) * objective.prior_rows[:, 2] * objective.prior_counts
    total = sum(line.distance for line in lines) + float(prior @ prior)
    freedom = objective.data_count + int(objective.prior_counts.sum()) - theta.size
    return FitTest(
        chi_square=total,
        degrees_of_freedom=freedom,
        p_value=chi_square_tail(total, freedom) if freedom > 0 else None,
        lines=lines,
    )


def _line_tests(objective: Objective, number: int, residuals: FloatArray) -> list[LineTest]:
    experiment = objective.experiments[number]
    size = residuals.shape[1]
    names = [name for name, taken in zip(experiment.response.lines, experiment.fitted, strict=True) if taken]
    return [
        LineTest(experiment=number, name=name, distance=float(d), p_value=f_tail(float(d) / size, size, np.inf))
        for name, d in zip(names, np.sum(residuals**2, axis=1), strict=True)
    ]
