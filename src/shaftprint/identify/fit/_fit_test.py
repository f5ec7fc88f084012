"""Does the structure explain the data within their noise? Squared distances of the lines, and their sum.

Where the covariance of a line of ``m`` real numbers is known, its squared distance ``d^2`` from the true model is a
chi-square of ``m`` degrees of freedom. Where it was estimated from ``nu`` of them, ``d^2`` is a scaled F variable: in
the complex form of Hotelling's (Giri, On the complex analogues of T^2- and R^2-tests, 1965), with weights that are
right on average, ``m (nu - m) / (nu - m + 2) F(m, nu - m + 2)``. Its share of the sum is then
``(nu - m + 2) log(1 + d^2 / (nu - m))``, which is nearly a chi-square again: the sum of ``m / 2`` independent
exponential variables of means ``2``, ``2 (nu - m + 2) / (nu - m + 4)``, ...

Of records in time, of which thousands of data say nothing, the share is what remains of the input in the residuals.

A parameter that a bound stopped took nothing of the sum away: given which ones did, the rest is as if they had been
held (Gourieroux, Holly and Monfort, Likelihood ratio test, Wald test, and Kuhn-Tucker test in linear models with
inequality constraints on the regression parameters, 1982).
"""

from collections.abc import Sequence
from dataclasses import dataclass

from shaftprint.arrays import FloatArray
from shaftprint.distributions import chi_square_tail
from shaftprint.identify.likelihood._line_test import LineTest
from shaftprint.identify.likelihood._objective import Objective
from shaftprint.identify.likelihood._term import TermTest


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
    """Each fitted line and record, term by term."""

    @property
    def p_value(self) -> float | None:
        """Probability of a sum that large or larger if the structure holds; None where nothing is left to test.

        From the multiple of a chi-square that has its mean and variance.
        """
        if self.degrees_of_freedom <= 0 or not (self.mean > 0.0 and self.variance > 0.0):
            return None
        scale = 0.5 * self.variance / self.mean
        return chi_square_tail(self.chi_square / scale, self.mean / scale)


def tested_fit(objective: Objective, values: FloatArray, tests: Sequence[TermTest]) -> FitTest:
    """Return the test of fit at the given parameters.

    ``tests``: what each term adds there.
    """
    theta = values[list(objective.free)]
    index = objective.prior_rows[:, 0].astype(int)
    prior = (theta[index] - objective.prior_rows[:, 1]) * objective.prior_rows[:, 2] * objective.prior_counts
    fitted = (theta > objective.lower) & (theta < objective.upper)
    spare = int(objective.prior_counts.sum()) - int(fitted.sum())
    return FitTest(
        chi_square=float(prior @ prior) + sum(test.chi_square for test in tests),
        degrees_of_freedom=sum(test.count for test in tests) + spare,
        mean=float(spare) + sum(test.mean for test in tests),
        variance=2.0 * spare + sum(test.variance for test in tests),
        lines=tuple(line for test in tests for line in test.lines),
    )
