"""How the lines and outputs of a response are weighted against each other."""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import IdentificationError
from shaftprint.identify.likelihood._tails import Tails, estimated_tails, student_tails
from shaftprint.spectra._frequency_response import FrequencyResponse


class Weighting(ABC):
    """How the lines and outputs of a response are weighted against each other."""

    __slots__ = ()

    @property
    @abstractmethod
    def is_likelihood(self) -> bool:
        """Whether the cost is a negative log-likelihood."""

    @abstractmethod
    def expect_outputs(self, outputs: Sequence[str]) -> None:
        """Check that what it says of outputs can be applied.

        ``outputs``: names of the outputs of all responses of a fit.
        """

    @abstractmethod
    def matrices(self, response: FrequencyResponse, covariance: FloatArray) -> FloatArray:
        """Return ``W`` of each line, shape (lines, size, size), for covariances of that shape."""

    @abstractmethod
    def tails(self, degrees_of_freedom: FloatArray, size: int) -> Tails:
        """Return how much lines far from the model count.

        ``degrees_of_freedom``: real degrees of freedom behind the covariance of each line, infinite for a known one,
        shape (lines,). ``size``: number of real data of a line.
        """


class ByCovariance(Weighting):
    """Weights from the full covariance of each line, whatever the tails are."""

    __slots__ = ()

    @property
    def is_likelihood(self) -> bool:
        """Whether the cost is a negative log-likelihood."""
        return True

    def expect_outputs(self, outputs: Sequence[str]) -> None:
        """Check nothing: all outputs are weighed by their covariance."""

    def matrices(self, response: FrequencyResponse, covariance: FloatArray) -> FloatArray:
        """Return the inverse Cholesky factors of the covariances."""
        return np.linalg.inv(np.linalg.cholesky(covariance))


@dataclass(frozen=True, slots=True)
class MaximumLikelihood(ByCovariance):
    """Weights from the full covariance of each line.

    Where it is known ``2 cost`` is a chi-square and the fit efficient. Where it was estimated the degrees of freedom
    are respected (``Tails``): a line of few of them counts less, and less still when it lies far off.
    """

    def tails(self, degrees_of_freedom: FloatArray, size: int) -> Tails:
        """Return the tails that the degrees of freedom of the covariances give."""
        return estimated_tails(degrees_of_freedom, size)


@dataclass(frozen=True, slots=True)
class Unweighted(Weighting):
    """All lines alike, as in the thesis; outputs against each other by the given weights."""

    output_weights: Mapping[str, float] = field(default_factory=dict)
    """Weight of each output's squared residuals by name; 1 where not given."""

    @property
    def is_likelihood(self) -> bool:
        """Whether the cost is a negative log-likelihood."""
        return False

    def expect_outputs(self, outputs: Sequence[str]) -> None:
        """Check the output weights.

        Raises
        ------
        IdentificationError
            If a weight names an output that no response has, or is not positive.
        """
        for name, weight in self.output_weights.items():
            if name not in outputs or not weight > 0.0:
                raise IdentificationError(
                    f"output weight {name} = {weight}: expected a positive weight of one of {', '.join(outputs)}."
                )

    def matrices(self, response: FrequencyResponse, covariance: FloatArray) -> FloatArray:
        """Return diagonal matrices of the square roots of the output weights."""
        roots = np.sqrt([self.output_weights.get(name, 1.0) for name in response.outputs])
        channels = np.repeat(roots, len(response.inputs))
        return np.broadcast_to(np.diag(np.tile(channels, 2)), covariance.shape).copy()

    def tails(self, degrees_of_freedom: FloatArray, size: int) -> Tails:
        """Return none: every line counts by its square."""
        return estimated_tails(np.full_like(degrees_of_freedom, np.inf), size)


@dataclass(frozen=True, slots=True)
class StudentT(ByCovariance):
    """Weights from the full covariance, but a line far off counts little: robust against a bad line.

    Each line of ``m`` real numbers has the multivariate t density with its covariance ``C`` as scale: up to a constant
    ``(1 + d^2 / nu)^(-(nu + m) / 2)`` with ``d^2 = (y - f)^T C^-1 (y - f)`` (Lange, Little and Taylor, Robust
    statistical modeling using the t distribution, 1989, eq. 1). The cost is its negative logarithm times a factor near
    1 that makes standard deviations and profiles right for normal noise, whose covariance ``C`` is (``Tails``).
    """

    degrees_of_freedom: float = 4.0
    """``nu``: the smaller, the less a far line counts; at 4 variances without bad lines are a tenth above the least."""

    def __post_init__(self) -> None:
        """Check the degrees of freedom.

        Raises IdentificationError if they are not positive.
        """
        if not self.degrees_of_freedom > 0.0:
            raise IdentificationError(
                f"Student-t weighting: expected positive degrees of freedom, found {self.degrees_of_freedom}."
            )

    def tails(self, degrees_of_freedom: FloatArray, size: int) -> Tails:
        """Return the tails of the t density, or those of the covariance where its degrees of freedom are fewer."""
        return student_tails(degrees_of_freedom, size, self.degrees_of_freedom)
