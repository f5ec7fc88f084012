"""How the lines and outputs of a response are weighted against each other."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import IdentificationError
from shaftprint.spectra import FrequencyResponse

# Below this squared distance over the degrees of freedom the logarithm is taken from its series.
NEAR = 1e-3


class Weighting(ABC):
    """How the lines and outputs of a response are weighted against each other."""

    __slots__ = ()

    @property
    @abstractmethod
    def is_likelihood(self) -> bool:
        """Whether the cost is a negative log-likelihood."""

    @abstractmethod
    def matrices(self, response: FrequencyResponse, covariance: FloatArray) -> FloatArray:
        """Return ``W`` of each line, shape (lines, size, size), for covariances of that shape."""

    @abstractmethod
    def shaped(self, table: FloatArray) -> FloatArray:
        """Return residuals whose half square sum is the cost, from the weighted ones.

        Parameters
        ----------
        table
            Weighted residuals and below them their derivatives, shape (starts, 1 + free, size, lines).
        """


@dataclass(frozen=True, slots=True)
class MaximumLikelihood(Weighting):
    """Weights from the full covariance of each line: efficient, and ``2 cost`` is a chi-square."""

    @property
    def is_likelihood(self) -> bool:
        """Whether the cost is a negative log-likelihood."""
        return True

    def matrices(self, response: FrequencyResponse, covariance: FloatArray) -> FloatArray:
        """Return the inverse Cholesky factors of the covariances."""
        return np.linalg.inv(np.linalg.cholesky(covariance))

    def shaped(self, table: FloatArray) -> FloatArray:
        """Return the weighted residuals as they are."""
        return table


@dataclass(frozen=True, slots=True)
class Unweighted(Weighting):
    """All lines alike, as in the thesis; outputs against each other by the given weights."""

    output_weights: Mapping[str, float] = field(default_factory=dict)
    """Weight of each output's squared residuals by name; 1 where not given."""

    @property
    def is_likelihood(self) -> bool:
        """Whether the cost is a negative log-likelihood."""
        return False

    def matrices(self, response: FrequencyResponse, covariance: FloatArray) -> FloatArray:
        """Return diagonal matrices of the square roots of the output weights.

        Raises
        ------
        IdentificationError
            If a weight names an output that the response does not have, or is not positive.
        """
        for name, weight in self.output_weights.items():
            if name not in response.outputs or not weight > 0.0:
                raise IdentificationError(
                    f"output weight {name} = {weight}: expected a positive weight of one of "
                    f"{', '.join(response.outputs)}."
                )
        roots = np.sqrt([self.output_weights.get(name, 1.0) for name in response.outputs])
        channels = np.repeat(roots, len(response.inputs))
        return np.broadcast_to(np.diag(np.tile(channels, 2)), covariance.shape).copy()

    def shaped(self, table: FloatArray) -> FloatArray:
        """Return the weighted residuals as they are."""
        return table


@dataclass(frozen=True, slots=True)
class StudentT(Weighting):
    """Weights from the full covariance, but a line far off counts little: robust against a bad line.

    Each line of ``m`` real numbers has the multivariate t density with its covariance ``C`` as scale: up to a constant
    ``(1 + d^2 / nu)^(-(nu + m) / 2)`` with ``d^2 = (y - f)^T C^-1 (y - f)`` (Lange, Little and Taylor, Robust
    statistical modeling using the t distribution, 1989, eq. 1). Its negative logarithm is half the square of the
    weighted residuals ``W (y - f)`` times ``sqrt((nu + m) log(1 + d^2 / nu)) / d``.
    """

    degrees_of_freedom: float = 4.0
    """``nu``: the smaller, the less a far line counts; 4 is what Lange, Little and Taylor recommend for few data."""

    def __post_init__(self) -> None:
        """Check the degrees of freedom.

        Raises
        ------
        IdentificationError
            If they are not positive.
        """
        if not self.degrees_of_freedom > 0.0:
            raise IdentificationError(
                f"Student-t weighting: expected positive degrees of freedom, found {self.degrees_of_freedom}."
            )

    @property
    def is_likelihood(self) -> bool:
        """Whether the cost is a negative log-likelihood."""
        return True

    def matrices(self, response: FrequencyResponse, covariance: FloatArray) -> FloatArray:
        """Return the inverse Cholesky factors of the covariances."""
        return np.linalg.inv(np.linalg.cholesky(covariance))

    def shaped(self, table: FloatArray) -> FloatArray:
        """Return residuals whose half square sum is the negative logarithm of the t density."""
        residuals = table[:, 0]
        gain, slope = self._gain(np.einsum("smf,smf->sf", residuals, residuals), residuals.shape[1])
        along = np.einsum("smf,skmf->skf", residuals, table)
        shaped = gain[:, None, None, :] * table
        shaped[:, 1:] += (2.0 * slope[:, None, :] * along[:, 1:])[:, :, None, :] * residuals[:, None]
        return np.asarray(shaped)

    def _gain(self, squares: FloatArray, size: int) -> tuple[FloatArray, FloatArray]:
        """Return the factor on the residuals of each line, and its derivative to the squared distance."""
        nu = self.degrees_of_freedom
        x = squares / nu
        far = np.maximum(x, NEAR)
        near = np.minimum(x, NEAR)
        log = np.where(x < NEAR, 1.0 - near / 2.0 + near**2 / 3.0 - near**3 / 4.0, np.log1p(far) / far)
        fall = np.where(
            x < NEAR,
            -0.5 + 2.0 * near / 3.0 - 0.75 * near**2,
            (1.0 / (1.0 + far) - np.log1p(far) / far) / far,
        )
        scale = (nu + size) / nu
        gain = np.sqrt(scale * log)
        return gain, scale * fall / (2.0 * nu * gain)
