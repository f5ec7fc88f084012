"""One response in the likelihood: its structure, lines, weights, and where its parameters stand among all.

With the weighted residuals ``r = W (y - f(theta))`` over ``[Re, Im]`` of every used line and channel, the cost of an
experiment is ``r^T r / 2``. For maximum likelihood ``W^T W`` is the inverse of the full covariance of each line, and
where that was estimated the residuals of a line are shortened (``Tails``); unweighted (the thesis' way) ``W`` holds
output weights only.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arrays import (
    BoolArray,
    ComplexArray,
    FloatArray,
    IntArray,
    RealOrComplexArray,
    frozen_bool,
    frozen_float,
)
from shaftprint.identify.likelihood._fit_percent import fit_ceiling, fit_percent
from shaftprint.identify.likelihood._fitted_response import FittedResponse, channel_names, channels_of
from shaftprint.identify.likelihood._tails import Tails, excess_freedom
from shaftprint.identify.likelihood._term import Repeats, Term, TermTest
from shaftprint.identify.likelihood._tested_lines import tested_lines
from shaftprint.identify.likelihood._weighting import Weighting
from shaftprint.identify.likelihood._wishart import estimated_shapes
from shaftprint.notebook._shown import Shown
from shaftprint.spectra._frequency_response import FrequencyResponse


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ResponseRepeats(Repeats):
    """Other data for an experiment, one row a repeat."""

    measured: ComplexArray | None
    """Of the fitted lines, shape (repeats, channels, lines); None where they are the experiment's."""
    weights: FloatArray | None
    """``W`` of the fitted lines, shape (repeats, lines, size, size); None where they are the experiment's."""

    def chosen(self, repeats: IntArray | slice) -> "ResponseRepeats":
        """Return some of the repeats."""
        return ResponseRepeats(
            measured=None if self.measured is None else self.measured[repeats],
            weights=None if self.weights is None else self.weights[repeats],
        )


AS_MEASURED = ResponseRepeats(measured=None, weights=None)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class Experiment(Shown, Term):
    """A structure and a response to fit it to."""

    response: FrequencyResponse
    """The data, of the structure's outputs."""
    fitted: BoolArray
    """Which lines of the response are fitted, shape (lines of the response,); of the others nothing is used."""
    s: ComplexArray
    """Laplace variable of the fitted lines [rad/s], shape (lines,), complex."""
    factors: Mapping[str, RealOrComplexArray]
    """Factor on a parameter at each fitted line, shape (lines,): the propeller load of its window acts on ``k_q``."""
    data: FloatArray
    """[Re, Im] of the fitted lines, shape (lines, size)."""
    measured: ComplexArray
    """The same as complex numbers, shape (channels, lines)."""
    covariance: FloatArray
    """Covariance of the data, shape (lines, size, size)."""
    weighting: Weighting
    """How lines and outputs are weighed."""
    weights: FloatArray
    """``W`` of each line, shape (lines, size, size)."""
    tails: Tails
    """How much lines far from the model count."""
    elements: tuple[tuple[int, int, FloatArray], ...]
    """Row, column and elements of ``-W``, shape (lines,), where they are not all zero; those of the diagonal first."""

    @property
    def name(self) -> str:
        """What messages call the data."""
        return f"response of {', '.join(self.structure.outputs)}"

    @property
    def data_count(self) -> int:
        """Number of real data: two a complex value."""
        return self.data.size

    @property
    def row_count(self) -> int:
        """Number of rows: one a datum."""
        return self.data.size

    @property
    def is_likelihood(self) -> bool:
        """Whether lines are weighted by their covariance."""
        return self.weighting.is_likelihood

    @property
    def null_cost(self) -> float:
        """Half the square sum of the weighted data."""
        return 0.5 * float(np.sum((self.weights @ self.data[:, :, None]) ** 2))

    def table(self, theta: FloatArray, repeats: Repeats | None = None) -> FloatArray:
        """Return residuals, those of one channel's real or imaginary part side by side, and their derivatives."""
        other = repeats if isinstance(repeats, ResponseRepeats) else AS_MEASURED
        elements = self.elements if other.weights is None else elements_of(other.weights)
        weighted = _weighted(self._stacked(theta, other.measured), elements)
        shaped = weighted if self.tails.normal else self.tails.shaped(weighted)
        return shaped.reshape(*shaped.shape[:2], -1)

    def evaluable(self, theta: FloatArray) -> BoolArray:
        """Return true: a frequency response is finite for all parameters."""
        return np.ones(theta.shape[0], dtype=np.bool_)

    def sensitivity(self, theta: FloatArray, *, expected: bool) -> tuple[FloatArray, FloatArray]:
        """Return the weighted derivatives, and where they are no likelihood's the same times a root of ``W C W^T``."""
        table = _weighted(self._stacked(theta[None, :], None), self.elements)
        slopes = table[0, 1:]
        if not self.tails.normal:
            shaped = np.sqrt(self.tails.information) * slopes if expected else self.tails.curvature(table)[0]
            rows = shaped.reshape(theta.size, -1)
            return rows, rows
        rows = slopes.reshape(theta.size, -1)
        if self.weighting.is_likelihood:
            return rows, rows
        roots = np.linalg.cholesky(self.weights @ self.noise_covariance @ self.weights.swapaxes(1, 2))
        return rows, np.einsum("kaf,fab->kbf", slopes, roots).reshape(theta.size, -1)

    @property
    def freedom(self) -> FloatArray:
        """Real degrees of freedom behind the covariance of each fitted line, shape (lines,)."""
        return self.response.degrees_of_freedom[self.fitted]

    @property
    def noise_covariance(self) -> FloatArray:
        """Covariance of the data without the factor that makes it right as a weight, shape (lines, size, size)."""
        size = self.data.shape[1]
        exact = np.isinf(self.freedom)
        share = np.where(exact, 1.0, excess_freedom(self.freedom, size) / np.where(exact, 1.0, self.freedom))
        return share[:, None, None] * self.covariance

    @property
    def least_deviation(self) -> float:
        """Smallest standard deviation of a datum, as a share of the value it belongs to."""
        std = np.sqrt(np.diagonal(self.covariance, axis1=1, axis2=2))
        return float(np.min(std / np.maximum(np.tile(np.abs(self.measured).T, 2), np.finfo(np.float64).tiny)))

    def model(self, values: FloatArray) -> ComplexArray:
        """Return the response of the fitted lines for all parameters of the objective, shape (channels, lines)."""
        return self.structure.response(self.structure_values(values), self.s, factors=self.factors)

    def with_floor(self, floor: float) -> "Experiment":
        """Return the experiment with a share of each value added to its covariance, as an independent deviation."""
        size = self.data.shape[1]
        least = (floor * np.tile(np.abs(self.measured).T, 2)) ** 2
        covariance = self.covariance + least[:, :, None] * np.eye(size)
        weights = self.weighting.matrices(self.response, covariance)
        return replace(self, covariance=covariance, weights=weights, elements=elements_of(weights))

    def assessed(self, values: FloatArray, number: int) -> tuple[FittedResponse, TermTest]:
        """Return FitPercent, whitened residuals, and the squared distance of each line."""
        model = self.model(values)
        gap = self.data - np.concatenate([model.real, model.imag]).T
        whitened = np.linalg.solve(np.linalg.cholesky(self.covariance), gap[:, :, None])[:, :, 0]
        count = len(self.structure.channels)
        variance = np.diagonal(self.noise_covariance, axis1=1, axis2=2).T
        names = channel_names(self.response)
        part = FittedResponse(
            structure=self.structure,
            response=self.response,
            fitted=frozen_bool(self.fitted),
            fit_percent={n: fit_percent(self.measured[i], model[i]) for i, n in enumerate(names)},
            fit_ceiling={
                n: fit_ceiling(self.measured[i], variance[i] + variance[count + i]) for i, n in enumerate(names)
            },
            whitened=frozen_float(whitened),
        )
        lines = [name for name, fitted in zip(self.response.lines, self.fitted, strict=True) if fitted]
        return part, tested_lines(whitened, self.freedom, lines, number)

    def drawn(self, values: FloatArray, count: int, rng: np.random.Generator) -> tuple[ComplexArray, FloatArray]:
        """Return responses and covariances of repeats of the test, at all lines of the response.

        Lines that are not fitted stay as they are.

        ``values``: all parameters of the objective, shape (parameters,). Returns shapes (repeats, channels, lines) and
        (repeats, lines, size, size).
        """
        lines, size = self.data.shape
        root = np.linalg.cholesky(self.noise_covariance)
        parts = np.einsum("lab,klb->kal", root, rng.standard_normal((count, lines, size)))
        responses = np.repeat(channels_of(self.response)[None], count, axis=0)
        responses[:, :, self.fitted] = self.model(values) + parts[:, : size // 2] + 1j * parts[:, size // 2 :]
        covariances = np.repeat(self.response.covariance[None], count, axis=0)
        shapes = estimated_shapes(self.freedom, size // 2, count, rng)
        factor = np.linalg.cholesky(self.covariance)
        covariances[:, self.fitted] = factor @ shapes @ factor.swapaxes(1, 2)
        return responses, covariances

    def redrawn(self, values: FloatArray, count: int, rng: np.random.Generator) -> "ResponseRepeats":
        """Return the fitted lines of repeats, each with weights from a covariance drawn anew."""
        responses, covariances = self.drawn(values, count, rng)
        return ResponseRepeats(
            measured=responses[:, :, self.fitted],
            weights=self.weighting.matrices(self.response, covariances[:, self.fitted]),
        )

    def _stacked(self, theta: FloatArray, measured: ComplexArray | None) -> ComplexArray:
        stacked = self.structure.stacked(self.complete(theta), self.s, factors=self.factors)
        stacked[:, 0] -= self.measured if measured is None else measured
        return stacked


def elements_of(weights: FloatArray) -> tuple[tuple[int, int, FloatArray], ...]:
    """Return row, column and elements of ``-W`` where they are not all zero, the diagonal first.

    ``weights``: shape (lines, size, size), or (starts, lines, size, size). Returns the elements of shape (lines,), or
    (starts, 1, lines).
    """
    size = weights.shape[-1]
    pairs = [(i, i) for i in range(size)]
    pairs += [(i, j) for i in range(size) for j in range(size) if i != j and weights[..., i, j].any()]
    elements = ((i, j, -weights[..., i, j]) for i, j in pairs)
    return tuple((i, j, w if w.ndim == 1 else w[:, None]) for i, j, w in elements)


def _weighted(stacked: ComplexArray, elements: tuple[tuple[int, int, FloatArray], ...]) -> FloatArray:
    """Return ``-W`` times [Re, Im] of stacked responses, shape (starts, stack, size, lines), element by element."""
    starts, count, channels, lines = stacked.shape
    table = np.empty((starts, count, 2 * channels, lines))
    for row, column, weight in elements:
        part = (stacked.real if column < channels else stacked.imag)[:, :, column % channels]
        if row == column:
            np.multiply(part, weight, out=table[:, :, row])
        else:
            table[:, :, row] += part * weight
    return table
