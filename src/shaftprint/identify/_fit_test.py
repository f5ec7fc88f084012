"""Does the structure explain the data within their noise? Squared distances of the lines, and their sum.

Where the covariance of a line of ``m`` real numbers is known, its squared distance ``d^2`` from the true model is a
chi-square of ``m`` degrees of freedom. Where it was estimated from ``nu`` of them, ``d^2`` is a scaled F variable: in
the complex form of Hotelling's (Giri, On the complex analogues of T^2- and R^2-tests, 1965), with weights that are
right on average, ``m (nu - m) / (nu - m + 2) F(m, nu - m + 2)``. Its share of the sum is then
``(nu - m + 2) log(1 + d^2 / (nu - m))``, which is nearly a chi-square again: the sum of ``m / 2`` independent
exponential variables of means ``2``, ``2 (nu - m + 2) / (nu - m + 4)``, ...

A parameter that a bound stopped took nothing of the sum away: given which ones did, the rest is as if they had been
held (Gourieroux, Holly and Monfort, Likelihood ratio test, Wald test, and Kuhn-Tucker test in linear models with
inequality constraints on the regression parameters, 1982).
"""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.identify._chi_square import chi_square_tail
from shaftprint.identify._f_distribution import f_tail
from shaftprint.identify._objective import Objective
from shaftprint.identify._tails import excess_freedom


@dataclass(frozen=True, kw_only=True, slots=True)
class LineTest:
    """How far one line lies from the model."""

    experiment: int
    """Number of the experiment, from 0."""
    name: str
    """Name of the line."""
    distance: float
    """Squared distance ``d^2 = (y - f)^T C^-1 (y - f)``: of the order of the number of data."""
    data_count: int
    """Number of real data of the line."""
    excess: float
    """Degrees of freedom of its covariance beyond the number of data; infinite for a known one."""

    @property
    def p_value(self) -> float:
        """Probability that the true model is that far away or farther; the fitted one is a little nearer."""
        return f_tail(self.distance * (1.0 + 2.0 / self.excess) / self.data_count, self.data_count, self.excess + 2.0)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class FitTest:
    """Whether the structure explains the data within their noise."""

    chi_square: float
    """Sum over all lines, and of the squared rows of priors."""
    degrees_of_freedom: int
    """Number of data and prior rows minus the number of fitted parameters; one that a bound stopped is not fitted."""
    mean: float
    """What the sum is on average if the structure holds; the degrees of freedom where all covariances are known."""
    variance: float
    """Variance of the sum; twice the degrees of freedom where all covariances are known."""
    lines: tuple[LineTest, ...]
    """Each fitted line, experiment by experiment."""

    @property
    def p_value(self) -> float | None:
        """Probability of a sum that large or larger if the structure holds; None where nothing is left to test.

        From the multiple of a chi-square that has its mean and variance.
        """
        if self.degrees_of_freedom <= 0 or not (self.mean > 0.0 and self.variance > 0.0):
            return None
        scale = 0.5 * self.variance / self.mean
        return chi_square_tail(self.chi_square / scale, self.mean / scale)


def whitened_residuals(objective: Objective, values: FloatArray) -> tuple[FloatArray, ...]:
    """Return ``L^-1 (y - f)`` of every experiment's lines, each of shape (lines, 2 channels)."""
    found = []
    for experiment in objective.experiments:
        model = experiment.structure.response(experiment.own(values), experiment.s, factors=experiment.factors)
        gap = experiment.data - np.concatenate([model.real, model.imag]).T
        found.append(np.linalg.solve(np.linalg.cholesky(experiment.covariance), gap[:, :, None])[:, :, 0])
    return tuple(found)


def tested_fit(objective: Objective, values: FloatArray, whitened: tuple[FloatArray, ...]) -> FitTest:
    """Return the test of fit at the given parameters.

    Parameters
    ----------
    whitened
        The residuals there.
    """
    theta = values[list(objective.free)]
    index = objective.prior_rows[:, 0].astype(int)
    prior = (theta[index] - objective.prior_rows[:, 1]) * objective.prior_rows[:, 2] * objective.prior_counts
    fitted = (theta > objective.lower) & (theta < objective.upper)
    total, spare = float(prior @ prior), int(objective.prior_counts.sum()) - int(fitted.sum())
    mean, variance = float(spare), 2.0 * spare
    lines: list[LineTest] = []
    for number, residuals in enumerate(whitened):
        squares = np.sum(residuals**2, axis=1)
        excess = excess_freedom(objective.experiments[number].freedom, residuals.shape[1])
        total += float(np.sum(_shares(squares, excess)))
        means, variances = _moments(excess, residuals.shape[1])
        mean, variance = mean + float(means.sum()), variance + float(variances.sum())
        lines += _line_tests(objective, number, squares, excess)
    return FitTest(
        chi_square=total,
        degrees_of_freedom=objective.data_count + spare,
        mean=mean,
        variance=variance,
        lines=tuple(lines),
    )


def _shares(squares: FloatArray, excess: FloatArray) -> FloatArray:
    """Return what each line adds to the sum."""
    known = np.isinf(excess)
    finite = np.where(known, 1.0, excess)
    return np.where(known, squares, (finite + 2.0) * np.log1p(squares / finite))


def _moments(excess: FloatArray, size: int) -> tuple[FloatArray, FloatArray]:
    """Return mean and variance of what each line adds to the sum."""
    steps = 2.0 * np.arange(size // 2)[:, None]
    means = 2.0 / (1.0 + steps / (excess + 2.0))
    return means.sum(axis=0), (means**2).sum(axis=0)


def _line_tests(objective: Objective, number: int, squares: FloatArray, excess: FloatArray) -> list[LineTest]:
    experiment = objective.experiments[number]
    size = experiment.data.shape[1]
    names = [name for name, taken in zip(experiment.response.lines, experiment.fitted, strict=True) if taken]
    return [
        LineTest(experiment=number, name=name, distance=distance, data_count=size, excess=k)
        for name, distance, k in zip(names, squares.tolist(), excess.tolist(), strict=True)
    ]
