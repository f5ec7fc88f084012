"""Criteria that weigh how well a structure explains the data against how many parameters it took.

=========== ===========================================================================================================
deviance    ``-2 ln L`` up to a constant that all structures share: twice the cost; without weights
            ``N ln(2 cost / N)``, for noise of one unknown variance
AIC         deviance + 2 k (Akaike, A new look at the statistical model identification, 1974)
AICc        AIC + 2 k (k + 1) / (N - k - 1) (Hurvich and Tsai, Regression and time series model selection in small
            samples, 1989)
BIC         deviance + k ln N (Schwarz, Estimating the dimension of a model, 1978)
FPE         V (N + k) / (N - k) with V the mean squared residual (Akaike, Fitting autoregressive models for prediction,
            1969): what V would be on new data
=========== ===========================================================================================================

N counts two data for a complex value. A parameter with a prior counts in k as far as the data had to find it:
``k = free - trace(A_known A^-1)`` with ``A_known`` the part of the information ``A`` that the priors give.
"""

from dataclasses import dataclass

import numpy as np

from shaftprint.identify.fit._identification import Identification

# Directions below this share of the largest scaled information have none.
RANK_TOLERANCE = 1e-12


@dataclass(frozen=True, kw_only=True, slots=True)
class Criteria:
    """What a fit cost in parameters for what it explains; the smaller the better, nan where there are too few data."""

    data: int
    """Number of data N: two a complex value."""
    parameters: float
    """Number of parameters k that the data had to find."""
    deviance: float
    """``-2 ln L`` up to a constant."""
    mean_square: float
    """Mean squared weighted residual V."""

    @property
    def aic(self) -> float:
        """Akaike's criterion."""
        return self.deviance + 2.0 * self.parameters

    @property
    def aicc(self) -> float:
        """Akaike's criterion for few data."""
        k, spare = self.parameters, self.data - self.parameters - 1.0
        return self.aic + 2.0 * k * (k + 1.0) / spare if spare > 0.0 else float(np.nan)

    @property
    def bic(self) -> float:
        """Schwarz' criterion."""
        return self.deviance + self.parameters * float(np.log(self.data))

    @property
    def fpe(self) -> float:
        """Akaike's final prediction error."""
        n, k = self.data, self.parameters
        return self.mean_square * (n + k) / (n - k) if n > k else float(np.nan)


def criteria_of(identification: Identification) -> Criteria:
    """Return the criteria of a fit; only those of fits to the same data can be compared."""
    count, square = identification.data_count, 2.0 * identification.cost
    likely = identification.is_likelihood
    with np.errstate(divide="ignore"):
        deviance = square if likely else float(count * np.log(square / count))
    return Criteria(
        data=count,
        parameters=_parameters(identification),
        deviance=deviance,
        mean_square=square / count,
    )


def _parameters(identification: Identification) -> float:
    """Return the number of free parameters less what priors and regularisation knew of them."""
    objective = identification.objective
    theta = identification.values[list(objective.free)]
    rows = objective.prior_rows.shape[0]
    if rows == 0:
        return float(theta.size)
    _, slopes = objective.residuals(theta[None, :])
    prior_slopes = slopes[0, :, -rows:]
    information = slopes[0] @ slopes[0].T
    scale = np.sqrt(np.diag(information))
    scale[scale == 0.0] = 1.0
    values, vectors = np.linalg.eigh(information / np.outer(scale, scale))
    kept = values > RANK_TOLERANCE * values[-1]
    inner = (vectors[:, kept] / np.sqrt(values[kept])).T @ (prior_slopes / scale[:, None])
    return theta.size - float(np.sum(inner**2))
